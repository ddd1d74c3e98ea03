// What of the descriptors only Vulkan knows: their translation for the core's rules, formats, null handles.
#pragma once

#include "context.h"
#include "core/structures.h"
#include "core/target_rules.h"
#include "vitrail/vulkan.h"

namespace vitrail {

// Refuses, with a log line, a descriptor whose `next` is not null.
VkResult checkNext(const Log& log, const void* next, const char* structure);

// For a call whose argument is null.
VkResult nullArgument(const VitrailVkContext_T* context, const char* call);

// The colour format with its default.
VkFormat colorFormatOf(const VitrailVkTargetDesc& desc);

// The descriptor for the core's rules, without its defaults.
TargetInfo targetInfo(const VitrailVkContext_T& context, const VitrailVkTargetDesc& desc);

// Formats of the colour and of the scope. Logs the reason where it fails.
VkResult checkFormats(const VitrailVkContext_T& context, const VitrailVkTargetDesc& desc, const TargetInfo& info);

} // namespace vitrail
