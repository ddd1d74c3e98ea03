// A host in C++ with vitrail.hpp: the resolve is drawn in the host's own rendering scope, first the whole picture in
// one frame, then the same picture in tiles through 64 KiB. Both must be right, and equal to the last bit.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <utility>
#include <vector>

#include <vitrail/vitrail.hpp>

#include "scene.h"

namespace {

constexpr VkExtent2D kExtent = {256, 192};
constexpr VkFormat kColorFormat = VK_FORMAT_R8G8B8A8_UNORM;
// 8 bits, rounded after the opaque scene and after the resolve.
constexpr double kTolerance = 1.01 / 255;
constexpr VkDeviceSize kTileBudget = 64 * 1024;

class Renderer {
 public:
  Renderer(Host& host, vitrail::vulkan::Context& context) : host_(host), context_(context) {
    color_ = hostCreateImage(&host, kExtent, kColorFormat,
                             VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT);
    depth_ = hostCreateImage(&host, kExtent, VK_FORMAT_D32_SFLOAT, VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT);
    PainterDesc desc{};
    desc.extent = kExtent;
    desc.colorFormat = kColorFormat;
    desc.depthFormat = depth_.format;
    desc.lists = context.descriptorSetLayout();
    painter_ = sceneCreatePainter(&host, &desc);
  }
  Renderer(const Renderer&) = delete;
  Renderer& operator=(const Renderer&) = delete;
  ~Renderer() {
    sceneDestroyPainter(&host_, &painter_);
    hostDestroyImage(&host_, &color_);
    hostDestroyImage(&host_, &depth_);
  }

  std::vector<double> drawWhole() {
    VitrailVkTargetDesc desc = targetDesc();
    desc.nodeCapacity = 3 * kExtent.width * kExtent.height;
    const vitrail::vulkan::Target target = createTarget(desc);
    drawOpaque();
    VitrailStats stats = drawTransparent(target, 0, {});
    sceneCheckStats(&host_, kExtent, &stats);
    return read();
  }

  // `tiles`: how many there were.
  std::vector<double> drawTiled(unsigned& tiles) {
    VitrailTilePlanDesc planDesc{};
    planDesc.width = kExtent.width;
    planDesc.height = kExtent.height;
    planDesc.memoryBudget = kTileBudget;
    hostCheck(&host_, context_.tileLimits(VITRAIL_NODE_STANDARD, VK_SAMPLE_COUNT_1_BIT, planDesc.limits),
              "vitrailVkTileLimits");
    vitrail::TilePlan plan;
    checkPlan(vitrail::TilePlan::create(planDesc, plan), "vitrailCreateTilePlan");
    VitrailVkTargetDesc desc = targetDesc();
    vitrailVkTilePlanTarget(plan.handle(), &desc);
    const vitrail::vulkan::Target target = createTarget(desc);

    drawOpaque();
    VitrailRect tile{};
    for (tiles = 0; plan.next(tile); ++tiles) {
      const VkOffset2D corner{static_cast<int32_t>(tile.x), static_cast<int32_t>(tile.y)};
      const VitrailStats stats = drawTransparent(target, tiles, {corner, {tile.width, tile.height}});
      checkPlan(plan.finish(stats), "vitrailFinishTile");
    }
    return read();
  }

 private:
  static void checkPlan(VitrailResult result, const char* call) {
    if (result == VITRAIL_SUCCESS) return;
    std::fprintf(stderr, "cpp: %s: %d\n", call, static_cast<int>(result));
    std::exit(1);
  }

  static VitrailVkTargetDesc targetDesc() {
    VitrailVkTargetDesc desc{};
    desc.extent = kExtent;
    desc.resolve = VITRAIL_RESOLVE_FRAGMENT;
    desc.colorFormat = kColorFormat;
    desc.debugName = "cpp";
    return desc;
  }

  vitrail::vulkan::Target createTarget(const VitrailVkTargetDesc& desc) {
    vitrail::vulkan::Target target;
    hostCheck(&host_, vitrail::vulkan::Target::create(context_, desc, target), "vitrailVkCreateTarget");
    return target;
  }

  // A rendering scope over both images, or over the colour alone.
  void beginScope(VkCommandBuffer commands, VkAttachmentLoadOp load, bool withDepth) const {
    VkRenderingAttachmentInfo color{};
    color.sType = VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO;
    color.imageView = color_.view;
    color.imageLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
    color.loadOp = load;
    color.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
    VkRenderingAttachmentInfo depth = color;
    depth.imageView = depth_.view;
    depth.imageLayout = VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL;
    std::copy_n(sceneBackground, 4, color.clearValue.color.float32);
    depth.clearValue.depthStencil.depth = 1.0F;
    VkRenderingInfo info{};
    info.sType = VK_STRUCTURE_TYPE_RENDERING_INFO;
    info.renderArea.extent = kExtent;
    info.layerCount = 1;
    info.colorAttachmentCount = 1;
    info.pColorAttachments = &color;
    info.pDepthAttachment = withDepth ? &depth : nullptr;
    vkCmdBeginRendering(commands, &info);
  }

  void drawOpaque() {
    VkCommandBuffer commands = hostBegin(&host_);
    scenePrepareImages(commands, &color_, &depth_);
    beginScope(commands, VK_ATTACHMENT_LOAD_OP_CLEAR, true);
    sceneDrawOpaque(commands, &painter_);
    vkCmdEndRendering(commands);
    hostSubmit(&host_, commands);
  }

  // Collects and resolves one area over what the colour image holds, and waits for it.
  VitrailStats drawTransparent(const vitrail::vulkan::Target& target, uint64_t frame, const VkRect2D& area) {
    VkCommandBuffer commands = hostBegin(&host_);
    VitrailVkBeginInfo info{};
    info.frame = frame;
    info.area = area;
    target.begin(commands, info);
    // The scope is the host's, so are the barriers between its scopes. Writers and readers: attachments.
    hostMemoryBarrier(commands, kAttachmentStages, kAttachmentWrites, kAttachmentStages,
                      kAttachmentReads | kAttachmentWrites);
    beginScope(commands, VK_ATTACHMENT_LOAD_OP_LOAD, true);
    sceneDrawTransparent(commands, &painter_, target.descriptorSet());
    vkCmdEndRendering(commands);
    target.collected(commands);
    hostMemoryBarrier(commands, kAttachmentStages, kAttachmentWrites, kAttachmentStages,
                      kAttachmentReads | kAttachmentWrites);
    beginScope(commands, VK_ATTACHMENT_LOAD_OP_LOAD, false);
    target.resolve(commands);
    vkCmdEndRendering(commands);
    target.end(commands);
    hostSubmit(&host_, commands);
    VitrailStats stats{};
    hostCheck(&host_, target.readStats(frame, stats), "vitrailVkReadStats");
    return stats;
  }

  std::vector<double> read() const {
    const std::unique_ptr<double, decltype(&std::free)> pixels(
        hostReadPixels(&host_, &color_, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL), std::free);
    return {pixels.get(), pixels.get() + std::size_t{4} * kExtent.width * kExtent.height};
  }

  static constexpr VkPipelineStageFlags kAttachmentStages = VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT |
                                                            VK_PIPELINE_STAGE_EARLY_FRAGMENT_TESTS_BIT |
                                                            VK_PIPELINE_STAGE_LATE_FRAGMENT_TESTS_BIT;
  static constexpr VkAccessFlags kAttachmentReads =
      VK_ACCESS_COLOR_ATTACHMENT_READ_BIT | VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_READ_BIT;
  static constexpr VkAccessFlags kAttachmentWrites =
      VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT | VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT;

  Host& host_;
  vitrail::vulkan::Context& context_;
  Image color_{};
  Image depth_{};
  Painter painter_{};
};

vitrail::vulkan::Context createContext(Host& host) {
  VitrailVkContextDesc desc{};
  desc.instance = host.instance;
  desc.physicalDevice = host.physicalDevice;
  desc.device = host.device;
  desc.getInstanceProcAddr = host.getInstanceProcAddr;
  vitrail::vulkan::Context context;
  hostCheck(&host, vitrail::vulkan::Context::create(desc, context), "vitrailVkCreateContext");
  return context;
}

void drawAndCheck(Host& host) {
  vitrail::vulkan::Context context = createContext(host);
  Renderer renderer(host, context);
  const std::vector<double> whole = renderer.drawWhole();
  sceneCheckPicture(&host, kExtent, whole.data(), kTolerance);
  unsigned tiles = 0;
  if (renderer.drawTiled(tiles) != whole) hostFail(&host, "the picture in %u tiles is another", tiles);
  if (tiles < 2) hostFail(&host, "the picture was not drawn in tiles");
  std::printf("cpp: every pixel is right, also in %u tiles\n", tiles);
}

} // namespace

int main() {
  Host host;
  hostOpen(&host, "cpp", vkGetInstanceProcAddr, VK_API_VERSION_1_3);
  drawAndCheck(host);
  return hostClose(&host);
}
