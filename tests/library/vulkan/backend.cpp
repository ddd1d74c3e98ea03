#include "backend.h"

#include <utility>

#include "point_host.h"

namespace vitrail::tests::vulkan {

namespace {

const Registered<VulkanBackend> registered;

} // namespace

std::unique_ptr<PointHost> VulkanBackend::makeHost(const HostDesc& desc) {
  return std::make_unique<VulkanHost>(*this, desc);
}

VitrailTileLimits VulkanBackend::tileLimits(VitrailNodeFormat format, std::uint32_t samples) {
  VitrailTileLimits limits{};
  check(context(0).tileLimits(format, static_cast<VkSampleCountFlagBits>(samples), limits), "vitrailVkTileLimits");
  return limits;
}

std::vector<std::string> VulkanBackend::takeErrors() {
  std::vector<std::string> errors = device_ ? device_->takeErrors() : std::exchange(lastErrors_, {});
  for (const LogLine& line : takeLog()) errors.push_back("the library's log: " + line.text);
  return errors;
}

void VulkanBackend::close() {
  walkers_.clear();
  pipelines_.clear();
  contexts_.clear();
  if (!device_) return;
  device_->close();
  lastErrors_ = device_->takeErrors();
  device_.reset();
}

Device& VulkanBackend::device() {
  if (!device_) device_ = std::make_unique<Device>();
  return *device_;
}

VitrailVkContextDesc VulkanBackend::contextDesc() {
  VitrailVkContextDesc desc{};
  desc.instance = device().instance();
  desc.physicalDevice = device().physicalDevice();
  desc.device = device().get();
  desc.getInstanceProcAddr = vkGetInstanceProcAddr;
  desc.log = [](VitrailLogSeverity severity, const char* message, void* self) {
    static_cast<VulkanBackend*>(self)->log_.push_back({severity, message});
  };
  desc.logUser = this;
  return desc;
}

std::vector<LogLine> VulkanBackend::takeLog() { return std::exchange(log_, {}); }

Context& VulkanBackend::context(std::uint32_t features) {
  Context& context = contexts_[features];
  if (context) return context;
  VitrailVkContextDesc desc = contextDesc();
  desc.features = features;
  check(Context::create(desc, context), "vitrailVkCreateContext");
  return context;
}

std::uint32_t VulkanBackend::allFeatures() {
  std::uint32_t bits = 0;
  if (features().dualSourceBlending) bits |= VITRAIL_VK_FEATURE_DUAL_SRC_BLEND;
  if (features().sampleRateShading) bits |= VITRAIL_VK_FEATURE_SAMPLE_RATE_SHADING;
  return bits;
}

PointPipelines& VulkanBackend::pipelines(const PointPipelinesInfo& info) {
  return pipelines_.try_emplace(info, device(), info).first->second;
}

ListWalker& VulkanBackend::walker(const Context& context, const WalkKind& kind) {
  const VkDescriptorSetLayout set = context.descriptorSetLayout();
  return walkers_.try_emplace({set, kind}, device(), set, kind).first->second;
}

VulkanBackend& backend() { return Registered<VulkanBackend>::get(); }

void VulkanTest::TearDown() {
  for (const std::string& error : backend().takeErrors()) ADD_FAILURE() << error;
}

} // namespace vitrail::tests::vulkan
