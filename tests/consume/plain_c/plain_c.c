/* A host in C11. */
#include <stdio.h>

#include "view.h"

int main(void) {
  Host host;
  hostOpen(&host, "plain_c", vkGetInstanceProcAddr, VK_API_VERSION_1_3);
  if (vitrailVersion() != VITRAIL_VERSION) hostFail(&host, "the library has not the version of its headers");
  VitrailVkContext context = hostCreateContext(&host);
  const VitrailVkTargetDesc desc = {
      .extent = {64, 48}, .colorFormat = VK_FORMAT_R16G16B16A16_SFLOAT, .nodeCapacity = 3 * 64 * 48};
  View view = viewCreate(&host, context, &desc);

  VkCommandBuffer commands = hostBegin(&host);
  viewRecord(commands, &view);
  hostSubmit(&host, commands);
  viewCheck(&host, &view);
  printf("plain_c: every pixel is right\n");

  viewDestroy(&host, &view);
  vitrailVkDestroyContext(context);
  return hostClose(&host);
}
