/* Two views of one device, of different extents, node formats and colour formats, in one command buffer. */
#include <stdio.h>

#include "view.h"

int main(void) {
  Host host;
  hostOpen(&host, "two_targets", vkGetInstanceProcAddr, VK_API_VERSION_1_3);
  VitrailVkContext context = hostCreateContext(&host);
  const VitrailVkTargetDesc descs[2] = {
      {.extent = {64, 48}, .colorFormat = VK_FORMAT_R16G16B16A16_SFLOAT, .nodeCapacity = 3 * 64 * 48},
      {.extent = {40, 56},
       .colorFormat = VK_FORMAT_R32G32B32A32_SFLOAT,
       .nodeFormat = VITRAIL_NODE_HDR,
       .nodeCapacity = 3 * 40 * 56}};
  View views[2];
  for (int i = 0; i < 2; ++i) views[i] = viewCreate(&host, context, &descs[i]);

  VkCommandBuffer commands = hostBegin(&host);
  for (int i = 0; i < 2; ++i) viewRecord(commands, &views[i]);
  hostSubmit(&host, commands);
  for (int i = 0; i < 2; ++i) viewCheck(&host, &views[i]);
  printf("two_targets: every pixel of both is right\n");

  for (int i = 0; i < 2; ++i) viewDestroy(&host, &views[i]);
  vitrailVkDestroyContext(context);
  return hostClose(&host);
}
