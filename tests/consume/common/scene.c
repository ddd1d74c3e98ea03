#include "scene.h"

#include <math.h>
#include <string.h>

/* A rectangle: edges in eighths of the picture, colour as 8-bit codes (r, g, b on the sRGB curve, linear alpha), which
 * is what a node stores, so that nothing is rounded on the way. The depth runs from the left edge to the right one. */
typedef struct Quad {
  int left, top, right, bottom;
  double depthLeft, depthRight;
  uint8_t color[4];
} Quad;

static const Quad opaqueQuad = {0, 4, 4, 8, 0.5, 0.5, {200, 120, 40, 255}};

enum { QUADS = 3 };
static const Quad quads[QUADS] = {
    {1, 1, 6, 5, 0.25, 0.25, {220, 40, 40, 128}}, /* the nearest first: */
    {0, 3, 8, 6, 0.1, 0.85, {50, 70, 230, 160}},  /* wrong for every way of blending that does not sort */
    {2, 2, 7, 7, 0.7, 0.7, {40, 200, 60, 100}},
};

const float sceneBackground[4] = {0.1F, 0.2F, 0.3F, 1.0F};

/* The IEC 61966-2-1 (sRGB) curve. */
static double toLinear(uint8_t code) {
  const double c = code / 255.0;
  return c <= 0.04045 ? c / 12.92 : pow((c + 0.055) / 1.055, 2.4);
}

/* ---- Drawing ------------------------------------------------------------------------------------------------------
 */

static const uint32_t vertexCode[] = {
#include "quad.vert.inc"
};
static const uint32_t opaqueCode[] = {
#include "opaque.frag.inc"
};
static const uint32_t collectCode[] = {
#include "collect.frag.inc"
};

/* What the shaders take as push constants. */
typedef struct QuadConstants {
  float edges[4];
  float color[4];
  float depths[2];
} QuadConstants;

static VkPipelineShaderStageCreateInfo shaderStage(const Host* host, VkShaderStageFlagBits stage, const uint32_t* code,
                                                   size_t size) {
  const VkShaderModuleCreateInfo info = {
      .sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO, .codeSize = size, .pCode = code};
  VkPipelineShaderStageCreateInfo result = {
      .sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO, .stage = stage, .pName = "main"};
  hostCheck(host, vkCreateShaderModule(host->device, &info, NULL, &result.module), "vkCreateShaderModule");
  return result;
}

/* The state that differs between the two pipelines. */
typedef struct Pass {
  VkPipelineShaderStageCreateInfo stages[2];
  VkBool32 depthWrite;
  VkColorComponentFlags colorWrite;
  VkBool32 stencilTest;
  VkStencilOpState stencil;
} Pass;

static VkPipeline createPipeline(const Host* host, const PainterDesc* desc, VkPipelineLayout layout, const Pass* pass) {
  const VkPipelineVertexInputStateCreateInfo input = {.sType =
                                                          VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO};
  const VkPipelineInputAssemblyStateCreateInfo assembly = {
      .sType = VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO,
      .topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP};
  const VkViewport viewport = {0.0F, 0.0F, (float)desc->extent.width, (float)desc->extent.height, 0.0F, 1.0F};
  const VkRect2D scissor = {{0, 0}, desc->extent};
  const VkPipelineViewportStateCreateInfo viewports = {.sType = VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO,
                                                       .viewportCount = 1,
                                                       .pViewports = &viewport,
                                                       .scissorCount = 1,
                                                       .pScissors = &scissor};
  const VkPipelineRasterizationStateCreateInfo raster = {
      .sType = VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO,
      .cullMode = VK_CULL_MODE_NONE,
      .lineWidth = 1.0F};
  const VkPipelineMultisampleStateCreateInfo samples = {
      .sType = VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO, .rasterizationSamples = VK_SAMPLE_COUNT_1_BIT};
  const VkPipelineDepthStencilStateCreateInfo depth = {
      .sType = VK_STRUCTURE_TYPE_PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO,
      .depthTestEnable = VK_TRUE,
      .depthWriteEnable = pass->depthWrite,
      .depthCompareOp = VK_COMPARE_OP_LESS,
      .stencilTestEnable = pass->stencilTest,
      .front = pass->stencil,
      .back = pass->stencil};
  const VkPipelineColorBlendAttachmentState attachment = {.colorWriteMask = pass->colorWrite};
  const VkPipelineColorBlendStateCreateInfo blend = {.sType = VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO,
                                                     .attachmentCount = 1,
                                                     .pAttachments = &attachment};
  const bool hasStencil = desc->depthFormat != VK_FORMAT_D32_SFLOAT;
  const VkPipelineRenderingCreateInfo rendering = {
      .sType = VK_STRUCTURE_TYPE_PIPELINE_RENDERING_CREATE_INFO,
      .colorAttachmentCount = 1,
      .pColorAttachmentFormats = &desc->colorFormat,
      .depthAttachmentFormat = desc->depthFormat,
      .stencilAttachmentFormat = hasStencil ? desc->depthFormat : VK_FORMAT_UNDEFINED};
  const VkGraphicsPipelineCreateInfo info = {.sType = VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO,
                                             .pNext = desc->renderPass == VK_NULL_HANDLE ? &rendering : NULL,
                                             .stageCount = 2,
                                             .pStages = pass->stages,
                                             .pVertexInputState = &input,
                                             .pInputAssemblyState = &assembly,
                                             .pViewportState = &viewports,
                                             .pRasterizationState = &raster,
                                             .pMultisampleState = &samples,
                                             .pDepthStencilState = &depth,
                                             .pColorBlendState = &blend,
                                             .layout = layout,
                                             .renderPass = desc->renderPass};
  VkPipeline pipeline;
  hostCheck(host, vkCreateGraphicsPipelines(host->device, VK_NULL_HANDLE, 1, &info, NULL, &pipeline),
            "vkCreateGraphicsPipelines");
  return pipeline;
}

Painter sceneCreatePainter(const Host* host, const PainterDesc* desc) {
  Painter painter = {.extent = desc->extent};
  const VkPushConstantRange constants = {VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT, 0,
                                         sizeof(QuadConstants)};
  const VkPipelineLayoutCreateInfo layoutInfo = {.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
                                                 .setLayoutCount = 1,
                                                 .pSetLayouts = &desc->lists,
                                                 .pushConstantRangeCount = 1,
                                                 .pPushConstantRanges = &constants};
  hostCheck(host, vkCreatePipelineLayout(host->device, &layoutInfo, NULL, &painter.layout), "vkCreatePipelineLayout");

  const VkPipelineShaderStageCreateInfo vertex =
      shaderStage(host, VK_SHADER_STAGE_VERTEX_BIT, vertexCode, sizeof vertexCode);
  const VkPipelineShaderStageCreateInfo opaque =
      shaderStage(host, VK_SHADER_STAGE_FRAGMENT_BIT, opaqueCode, sizeof opaqueCode);
  VkPipelineShaderStageCreateInfo collect =
      shaderStage(host, VK_SHADER_STAGE_FRAGMENT_BIT, collectCode, sizeof collectCode);
  collect.pSpecializationInfo = desc->specialization;
  const VkColorComponentFlags all =
      VK_COLOR_COMPONENT_R_BIT | VK_COLOR_COMPONENT_G_BIT | VK_COLOR_COMPONENT_B_BIT | VK_COLOR_COMPONENT_A_BIT;

  const Pass opaquePass = {.stages = {vertex, opaque}, .depthWrite = VK_TRUE, .colorWrite = all};
  painter.opaque = createPipeline(host, desc, painter.layout, &opaquePass);
  Pass transparentPass = {.stages = {vertex, collect}, .stencilTest = desc->stencilMark};
  vitrailVkStencilMark(&transparentPass.stencil);
  painter.transparent = createPipeline(host, desc, painter.layout, &transparentPass);

  vkDestroyShaderModule(host->device, vertex.module, NULL);
  vkDestroyShaderModule(host->device, opaque.module, NULL);
  vkDestroyShaderModule(host->device, collect.module, NULL);
  return painter;
}

void sceneDestroyPainter(const Host* host, Painter* painter) {
  vkDestroyPipeline(host->device, painter->opaque, NULL);
  vkDestroyPipeline(host->device, painter->transparent, NULL);
  vkDestroyPipelineLayout(host->device, painter->layout, NULL);
}

static void drawQuad(VkCommandBuffer commands, const Painter* painter, const Quad* quad) {
  const int edges[4] = {quad->left, quad->top, quad->right, quad->bottom};
  QuadConstants constants;
  for (int i = 0; i < 4; ++i) {
    constants.edges[i] = (float)(edges[i] / 4.0 - 1.0);
    constants.color[i] = (float)(i < 3 ? toLinear(quad->color[i]) : quad->color[i] / 255.0);
  }
  constants.depths[0] = (float)quad->depthLeft;
  constants.depths[1] = (float)quad->depthRight;
  vkCmdPushConstants(commands, painter->layout, VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT, 0,
                     sizeof constants, &constants);
  vkCmdDraw(commands, 4, 1, 0, 0);
}

void sceneDrawOpaque(VkCommandBuffer commands, const Painter* painter) {
  vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, painter->opaque);
  drawQuad(commands, painter, &opaqueQuad);
}

void sceneDrawTransparent(VkCommandBuffer commands, const Painter* painter, VkDescriptorSet lists) {
  vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, painter->transparent);
  vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, painter->layout, 0, 1, &lists, 0, NULL);
  for (int i = 0; i < QUADS; ++i) drawQuad(commands, painter, &quads[i]);
}

void scenePrepareImages(VkCommandBuffer commands, const Image* color, const Image* depth) {
  const VkPipelineStageFlags tests =
      VK_PIPELINE_STAGE_EARLY_FRAGMENT_TESTS_BIT | VK_PIPELINE_STAGE_LATE_FRAGMENT_TESTS_BIT;
  /* Writer: nobody. Writer after: the clear of the scope. */
  hostImageBarrier(
      commands, color,
      &(ImageBarrier){VK_IMAGE_LAYOUT_UNDEFINED, VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT, 0,
                      VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT,
                      VK_ACCESS_COLOR_ATTACHMENT_READ_BIT | VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT});
  hostImageBarrier(
      commands, depth,
      &(ImageBarrier){VK_IMAGE_LAYOUT_UNDEFINED, tests, 0, VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL, tests,
                      VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_READ_BIT | VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT});
}

void sceneRender(VkCommandBuffer commands, const Painter* painter, const Image* color, const Image* depth,
                 VkDescriptorSet lists) {
  VkRenderingAttachmentInfo colorInfo = {.sType = VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO,
                                         .imageView = color->view,
                                         .imageLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                                         .loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR,
                                         .storeOp = VK_ATTACHMENT_STORE_OP_STORE};
  memcpy(colorInfo.clearValue.color.float32, sceneBackground, sizeof sceneBackground);
  VkRenderingAttachmentInfo depthInfo = colorInfo;
  depthInfo.imageView = depth->view;
  depthInfo.imageLayout = VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL;
  depthInfo.clearValue.depthStencil = (VkClearDepthStencilValue){1.0F, 0};
  const bool hasStencil = (depth->aspects & VK_IMAGE_ASPECT_STENCIL_BIT) != 0;
  const VkRenderingInfo info = {.sType = VK_STRUCTURE_TYPE_RENDERING_INFO,
                                .renderArea = {{0, 0}, painter->extent},
                                .layerCount = 1,
                                .colorAttachmentCount = 1,
                                .pColorAttachments = &colorInfo,
                                .pDepthAttachment = &depthInfo,
                                .pStencilAttachment = hasStencil ? &depthInfo : NULL};
  vkCmdBeginRendering(commands, &info);
  sceneDrawOpaque(commands, painter);
  sceneDrawTransparent(commands, painter, lists);
  vkCmdEndRendering(commands);
}

/* ---- What is right ------------------------------------------------------------------------------------------------
 */

/* Whether the quad covers the pixel's centre, and at what depth. */
static bool hit(const Quad* quad, VkExtent2D extent, uint32_t x, uint32_t y, double* depth) {
  const double column = (x + 0.5) * 8.0 / extent.width;
  const double row = (y + 0.5) * 8.0 / extent.height;
  const double along = (column - quad->left) / (quad->right - quad->left);
  *depth = quad->depthLeft + along * (quad->depthRight - quad->depthLeft);
  return column > quad->left && column < quad->right && row > quad->top && row < quad->bottom;
}

/* The fragments of a pixel, the farthest first. */
typedef struct Layers {
  int count;
  const Quad* quads[QUADS];
  double depths[QUADS];
} Layers;

static Layers layersAt(VkExtent2D extent, uint32_t x, uint32_t y) {
  Layers layers = {0};
  double opaqueDepth;
  if (!hit(&opaqueQuad, extent, x, y, &opaqueDepth)) opaqueDepth = 1.0;
  for (int i = 0; i < QUADS; ++i) {
    double depth;
    if (!hit(&quads[i], extent, x, y, &depth) || depth > opaqueDepth) continue;
    int place = layers.count++;
    for (; place > 0 && layers.depths[place - 1] < depth; --place) {
      layers.quads[place] = layers.quads[place - 1];
      layers.depths[place] = layers.depths[place - 1];
    }
    layers.quads[place] = &quads[i];
    layers.depths[place] = depth;
  }
  return layers;
}

static void rightColor(VkExtent2D extent, uint32_t x, uint32_t y, double color[4]) {
  double depth;
  const bool opaque = hit(&opaqueQuad, extent, x, y, &depth);
  for (int i = 0; i < 3; ++i) color[i] = opaque ? toLinear(opaqueQuad.color[i]) : (double)sceneBackground[i];
  color[3] = 1.0;
  const Layers layers = layersAt(extent, x, y);
  for (int k = 0; k < layers.count; ++k) {
    const double alpha = layers.quads[k]->color[3] / 255.0;
    for (int i = 0; i < 3; ++i) color[i] = alpha * toLinear(layers.quads[k]->color[i]) + (1.0 - alpha) * color[i];
  }
}

void sceneCheckPicture(const Host* host, VkExtent2D extent, const double* pixels, double tolerance) {
  for (uint32_t y = 0; y < extent.height; ++y) {
    for (uint32_t x = 0; x < extent.width; ++x) {
      const double* is = pixels + 4 * ((size_t)y * extent.width + x);
      double right[4];
      rightColor(extent, x, y, right);
      for (int i = 0; i < 4; ++i) {
        if (fabs(is[i] - right[i]) <= tolerance) continue;
        hostFail(host, "pixel (%u, %u) is (%.4f, %.4f, %.4f, %.4f) and should be (%.4f, %.4f, %.4f, %.4f)", x, y, is[0],
                 is[1], is[2], is[3], right[0], right[1], right[2], right[3]);
      }
    }
  }
}

void sceneCheckStats(const Host* host, VkExtent2D extent, const VitrailStats* stats) {
  VitrailStats right = {.complete = 1};
  for (uint32_t y = 0; y < extent.height; ++y) {
    for (uint32_t x = 0; x < extent.width; ++x) {
      const uint32_t count = (uint32_t)layersAt(extent, x, y).count;
      right.fragmentsRequested += count;
      right.coveredPixels += count > 0;
      if (count > right.layersMax) right.layersMax = count;
    }
  }
  if (stats->complete != right.complete || stats->fragmentsRequested != right.fragmentsRequested ||
      stats->fragmentsStored != right.fragmentsRequested || stats->fragmentsMissing != 0 ||
      stats->layersMax != right.layersMax || stats->coveredPixels != right.coveredPixels) {
    hostFail(
        host,
        "the frame's statistics are wrong: complete %u, requested %llu, stored %llu, missing %llu, deepest %u, covered "
        "%u; right are %llu fragments, %u deep, on %u pixels",
        stats->complete, (unsigned long long)stats->fragmentsRequested, (unsigned long long)stats->fragmentsStored,
        (unsigned long long)stats->fragmentsMissing, stats->layersMax, stats->coveredPixels,
        (unsigned long long)right.fragmentsRequested, right.layersMax, right.coveredPixels);
  }
}
