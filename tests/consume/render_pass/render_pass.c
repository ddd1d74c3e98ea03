/* A host of Vulkan 1.2 with render pass and framebuffer objects: one pass draws the scene and collects, a second one
 * resolves, and rejects by stencil the pixels that nothing transparent has touched. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "scene.h"

/* What the two passes are drawn into. */
typedef struct Frame {
  Image color;
  Image depth; /* and stencil */
  VkRenderPass scenePass;
  VkRenderPass resolvePass;
  VkFramebuffer sceneBuffer;
  VkFramebuffer resolveBuffer;
} Frame;

/* A pass over both images with one subpass. `clear`: the first one; else the pictures are kept and the depth and
 * stencil are only read. */
static VkRenderPass createPass(const Host* host, const Frame* frame, bool clear) {
  const VkImageLayout colorLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
  const VkImageLayout depthLayout =
      clear ? VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL : VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL;
  const VkAttachmentLoadOp load = clear ? VK_ATTACHMENT_LOAD_OP_CLEAR : VK_ATTACHMENT_LOAD_OP_LOAD;
  const VkAttachmentDescription attachments[2] = {
      {.format = frame->color.format,
       .samples = VK_SAMPLE_COUNT_1_BIT,
       .loadOp = load,
       .storeOp = VK_ATTACHMENT_STORE_OP_STORE,
       .stencilLoadOp = VK_ATTACHMENT_LOAD_OP_DONT_CARE,
       .stencilStoreOp = VK_ATTACHMENT_STORE_OP_DONT_CARE,
       .initialLayout = clear ? VK_IMAGE_LAYOUT_UNDEFINED : colorLayout,
       .finalLayout = colorLayout},
      {.format = frame->depth.format,
       .samples = VK_SAMPLE_COUNT_1_BIT,
       .loadOp = load,
       .storeOp = VK_ATTACHMENT_STORE_OP_STORE,
       .stencilLoadOp = load,
       .stencilStoreOp = VK_ATTACHMENT_STORE_OP_STORE,
       .initialLayout = clear ? VK_IMAGE_LAYOUT_UNDEFINED : VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL,
       .finalLayout = depthLayout}};
  const VkAttachmentReference colorReference = {0, colorLayout};
  const VkAttachmentReference depthReference = {1, depthLayout};
  const VkSubpassDescription subpass = {.pipelineBindPoint = VK_PIPELINE_BIND_POINT_GRAPHICS,
                                        .colorAttachmentCount = 1,
                                        .pColorAttachments = &colorReference,
                                        .pDepthStencilAttachment = &depthReference};
  const VkPipelineStageFlags stages = VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT |
                                      VK_PIPELINE_STAGE_EARLY_FRAGMENT_TESTS_BIT |
                                      VK_PIPELINE_STAGE_LATE_FRAGMENT_TESTS_BIT;
  const VkAccessFlags writes = VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT | VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT;
  const VkAccessFlags reads = VK_ACCESS_COLOR_ATTACHMENT_READ_BIT | VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_READ_BIT;
  /* Writer: the pass before. Reader and writer: this one. */
  const VkSubpassDependency before = {.srcSubpass = VK_SUBPASS_EXTERNAL,
                                      .srcStageMask = stages,
                                      .dstStageMask = stages,
                                      .srcAccessMask = clear ? 0 : writes,
                                      .dstAccessMask = reads | writes};
  const VkRenderPassCreateInfo info = {.sType = VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO,
                                       .attachmentCount = 2,
                                       .pAttachments = attachments,
                                       .subpassCount = 1,
                                       .pSubpasses = &subpass,
                                       .dependencyCount = 1,
                                       .pDependencies = &before};
  VkRenderPass pass;
  hostCheck(host, vkCreateRenderPass(host->device, &info, NULL, &pass), "vkCreateRenderPass");
  return pass;
}

static VkFramebuffer createFramebuffer(const Host* host, const Frame* frame, VkRenderPass pass) {
  const VkImageView views[2] = {frame->color.view, frame->depth.view};
  const VkFramebufferCreateInfo info = {.sType = VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO,
                                        .renderPass = pass,
                                        .attachmentCount = 2,
                                        .pAttachments = views,
                                        .width = frame->color.extent.width,
                                        .height = frame->color.extent.height,
                                        .layers = 1};
  VkFramebuffer framebuffer;
  hostCheck(host, vkCreateFramebuffer(host->device, &info, NULL, &framebuffer), "vkCreateFramebuffer");
  return framebuffer;
}

static Frame createFrame(const Host* host, VkExtent2D extent) {
  Frame frame = {0};
  frame.color = hostCreateImage(host, extent, VK_FORMAT_R16G16B16A16_SFLOAT,
                                VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT);
  frame.depth =
      hostCreateImage(host, extent, hostDepthStencilFormat(host), VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT);
  frame.scenePass = createPass(host, &frame, true);
  frame.resolvePass = createPass(host, &frame, false);
  frame.sceneBuffer = createFramebuffer(host, &frame, frame.scenePass);
  frame.resolveBuffer = createFramebuffer(host, &frame, frame.resolvePass);
  return frame;
}

static void destroyFrame(const Host* host, Frame* frame) {
  vkDestroyFramebuffer(host->device, frame->sceneBuffer, NULL);
  vkDestroyFramebuffer(host->device, frame->resolveBuffer, NULL);
  vkDestroyRenderPass(host->device, frame->scenePass, NULL);
  vkDestroyRenderPass(host->device, frame->resolvePass, NULL);
  hostDestroyImage(host, &frame->color);
  hostDestroyImage(host, &frame->depth);
}

static VitrailVkTarget createTarget(const Host* host, VitrailVkContext context, const Frame* frame) {
  const VkExtent2D extent = frame->color.extent;
  const VitrailVkTargetDesc desc = {.extent = extent,
                                    .nodeCapacity = 3 * extent.width * extent.height,
                                    .resolve = VITRAIL_RESOLVE_FRAGMENT,
                                    .colorFormat = frame->color.format,
                                    .scope = {.depthFormat = frame->depth.format,
                                              .stencilFormat = frame->depth.format,
                                              .renderPass = frame->resolvePass,
                                              .stencilMark = VK_TRUE},
                                    .debugName = "render_pass"};
  VitrailVkTarget target;
  hostCheck(host, vitrailVkCreateTarget(context, &desc, &target), "vitrailVkCreateTarget");
  return target;
}

static void beginPass(VkCommandBuffer commands, const Frame* frame, VkRenderPass pass, VkFramebuffer framebuffer) {
  VkClearValue clears[2] = {{.depthStencil = {0}}, {.depthStencil = {1.0F, 0}}};
  memcpy(clears[0].color.float32, sceneBackground, sizeof sceneBackground);
  const VkRenderPassBeginInfo info = {.sType = VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO,
                                      .renderPass = pass,
                                      .framebuffer = framebuffer,
                                      .renderArea = {{0, 0}, frame->color.extent},
                                      .clearValueCount = 2,
                                      .pClearValues = clears};
  vkCmdBeginRenderPass(commands, &info, VK_SUBPASS_CONTENTS_INLINE);
}

static void record(VkCommandBuffer commands, const Frame* frame, const Painter* painter, VitrailVkTarget target) {
  vitrailVkCmdBegin(commands, target, NULL);
  beginPass(commands, frame, frame->scenePass, frame->sceneBuffer);
  sceneDrawOpaque(commands, painter);
  sceneDrawTransparent(commands, painter, vitrailVkTargetDescriptorSet(target));
  vkCmdEndRenderPass(commands);
  vitrailVkCmdCollected(commands, target);
  beginPass(commands, frame, frame->resolvePass, frame->resolveBuffer);
  vitrailVkCmdResolve(commands, target, NULL);
  vkCmdEndRenderPass(commands);
  vitrailVkCmdEnd(commands, target);
}

int main(void) {
  Host host;
  hostOpen(&host, "render_pass", vkGetInstanceProcAddr, VK_API_VERSION_1_2);
  VitrailVkContext context = hostCreateContext(&host);
  const VkExtent2D extent = {64, 48};
  Frame frame = createFrame(&host, extent);
  VitrailVkTarget target = createTarget(&host, context, &frame);
  Painter painter = sceneCreatePainter(&host, &(PainterDesc){.extent = extent,
                                                             .colorFormat = frame.color.format,
                                                             .depthFormat = frame.depth.format,
                                                             .renderPass = frame.scenePass,
                                                             .lists = vitrailVkDescriptorSetLayout(context),
                                                             .stencilMark = true});

  VkCommandBuffer commands = hostBegin(&host);
  record(commands, &frame, &painter, target);
  hostSubmit(&host, commands);

  VitrailStats stats = {0};
  hostCheck(&host, vitrailVkReadStats(target, 0, &stats), "vitrailVkReadStats");
  sceneCheckStats(&host, extent, &stats);
  double* pixels = hostReadPixels(&host, &frame.color, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL);
  const double tolerance = 1.0 / 1024; /* 16-bit floats */
  sceneCheckPicture(&host, extent, pixels, tolerance);
  printf("render_pass: every pixel is right\n");
  free(pixels);

  sceneDestroyPainter(&host, &painter);
  vitrailVkDestroyTarget(target);
  vitrailVkDestroyContext(context);
  destroyFrame(&host, &frame);
  return hostClose(&host);
}
