/* A scene whose picture is known: an opaque rectangle and three translucent ones, which overlap, are drawn in an order
 * that is wrong almost everywhere, and of which one is slanted and cuts through all the others. Every pixel of it is
 * worked out in double precision and compared. */
#ifndef SCENE_H
#define SCENE_H

#include "host.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The pipelines that draw the scene. */
typedef struct Painter {
  VkPipelineLayout layout;
  VkPipeline opaque;
  VkPipeline transparent; /* collects: depth test on, depth writes off, no culling, no colour written */
  VkExtent2D extent;      /* multiples of 8 */
} Painter;

typedef struct PainterDesc {
  VkExtent2D extent;
  VkFormat colorFormat;                       /* of the scope that both passes are drawn in */
  VkFormat depthFormat;                       /* with or without stencil */
  VkRenderPass renderPass;                    /* null: dynamic rendering */
  VkDescriptorSetLayout lists;                /* vitrailVkDescriptorSetLayout() */
  bool stencilMark;                           /* vitrailVkStencilMark() */
  const VkSpecializationInfo* specialization; /* of the collecting shader; may be null */
} PainterDesc;

Painter sceneCreatePainter(const Host* host, const PainterDesc* desc);
void sceneDestroyPainter(const Host* host, Painter* painter);

/* The colour to clear with. */
extern const float sceneBackground[4];

void sceneDrawOpaque(VkCommandBuffer commands, const Painter* painter);

/* `lists`: vitrailVkTargetDescriptorSet(). */
void sceneDrawTransparent(VkCommandBuffer commands, const Painter* painter, VkDescriptorSet lists);

/* Draws everything with dynamic rendering, as one scope that begins with a clear. Both images are in their attachment
 * layouts. */
void sceneRender(VkCommandBuffer commands, const Painter* painter, const Image* color, const Image* depth,
                 VkDescriptorSet lists);

/* Puts freshly made images into their attachment layouts. */
void scenePrepareImages(VkCommandBuffer commands, const Image* color, const Image* depth);

/* Fails where a pixel's channel is off by more than `tolerance`. */
void sceneCheckPicture(const Host* host, VkExtent2D extent, const double* pixels, double tolerance);

/* Fails where the statistics of a frame of the whole scene are not those of the scene. */
void sceneCheckStats(const Host* host, VkExtent2D extent, const VitrailStats* stats);

#ifdef __cplusplus
}
#endif

#endif
