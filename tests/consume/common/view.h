/* One view of the scene, drawn with dynamic rendering and resolved by compute: the shortest way through the library. */
#ifndef VIEW_H
#define VIEW_H

#include "scene.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct View {
  Image color; /* what the opaque scene is drawn into and the resolve writes */
  Image depth;
  VitrailVkTarget target;
  Painter painter;
} View;

/* `desc` as for vitrailVkCreateTarget(), with the extent, the colour format and the memory; the rest is filled in. */
View viewCreate(const Host* host, VitrailVkContext context, const VitrailVkTargetDesc* desc);
void viewDestroy(const Host* host, View* view);

/* Records frame 0. */
void viewRecord(VkCommandBuffer commands, const View* view);

/* Fails where the picture or the statistics of frame 0, which has finished, are wrong. */
void viewCheck(const Host* host, const View* view);

#ifdef __cplusplus
}
#endif

#endif
