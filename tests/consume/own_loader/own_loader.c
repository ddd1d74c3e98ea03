/* A host that opens Vulkan by itself (loader.c): it compiles without prototypes and links no libvulkan. */
#include <stdio.h>

#include "view.h"

int main(void) {
  Host host = {.name = "own_loader"};
  PFN_vkGetInstanceProcAddr getInstanceProcAddr = openLoader();
  if (getInstanceProcAddr == NULL) hostFail(&host, "libvulkan.so.1 is missing, or something has linked it");
  hostOpen(&host, host.name, getInstanceProcAddr, VK_API_VERSION_1_3);
  VitrailVkContext context = hostCreateContext(&host);
  const VitrailVkTargetDesc desc = {
      .extent = {64, 48}, .colorFormat = VK_FORMAT_R16G16B16A16_SFLOAT, .nodeCapacity = 3 * 64 * 48};
  View view = viewCreate(&host, context, &desc);

  VkCommandBuffer commands = hostBegin(&host);
  viewRecord(commands, &view);
  hostSubmit(&host, commands);
  viewCheck(&host, &view);
  printf("own_loader: every pixel is right\n");

  viewDestroy(&host, &view);
  vitrailVkDestroyContext(context);
  return hostClose(&host);
}
