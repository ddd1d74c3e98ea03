#include "view.h"

#include <stdlib.h>

View viewCreate(const Host* host, VitrailVkContext context, const VitrailVkTargetDesc* desc) {
  View view = {0};
  view.color = hostCreateImage(
      host, desc->extent, desc->colorFormat,
      VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT);
  view.depth = hostCreateImage(host, desc->extent, VK_FORMAT_D32_SFLOAT, VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT);
  VitrailVkTargetDesc complete = *desc;
  complete.resolve = VITRAIL_RESOLVE_COMPUTE;
  complete.views = (VitrailVkViews){.count = 1, .color = &view.color.view};
  complete.debugName = host->name;
  hostCheck(host, vitrailVkCreateTarget(context, &complete, &view.target), "vitrailVkCreateTarget");

  VitrailVkSpecialization constants;
  vitrailVkCollectSpecialization(context, &complete, &constants);
  const VkSpecializationInfo specialization = {constants.count, constants.entries, sizeof constants.data,
                                               constants.data};
  view.painter = sceneCreatePainter(host, &(PainterDesc){.extent = desc->extent,
                                                         .colorFormat = view.color.format,
                                                         .depthFormat = view.depth.format,
                                                         .lists = vitrailVkDescriptorSetLayout(context),
                                                         .specialization = &specialization});
  return view;
}

void viewDestroy(const Host* host, View* view) {
  sceneDestroyPainter(host, &view->painter);
  vitrailVkDestroyTarget(view->target);
  hostDestroyImage(host, &view->color);
  hostDestroyImage(host, &view->depth);
}

void viewRecord(VkCommandBuffer commands, const View* view) {
  scenePrepareImages(commands, &view->color, &view->depth);
  vitrailVkCmdBegin(commands, view->target, NULL);
  sceneRender(commands, &view->painter, &view->color, &view->depth, vitrailVkTargetDescriptorSet(view->target));
  vitrailVkCmdCollected(commands, view->target);
  /* Writer: the opaque scene. Reader and writer: the resolve. */
  hostImageBarrier(
      commands, &view->color,
      &(ImageBarrier){VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT,
                      VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT, VK_IMAGE_LAYOUT_GENERAL,
                      VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_SHADER_WRITE_BIT});
  vitrailVkCmdResolve(commands, view->target, NULL);
  vitrailVkCmdEnd(commands, view->target);
}

void viewCheck(const Host* host, const View* view) {
  VitrailStats stats = {0};
  hostCheck(host, vitrailVkReadStats(view->target, 0, &stats), "vitrailVkReadStats");
  sceneCheckStats(host, view->color.extent, &stats);
  double* pixels = hostReadPixels(host, &view->color, VK_IMAGE_LAYOUT_GENERAL);
  const double tolerance = 1.0 / 1024; /* 16-bit floats */
  sceneCheckPicture(host, view->color.extent, pixels, tolerance);
  free(pixels);
}
