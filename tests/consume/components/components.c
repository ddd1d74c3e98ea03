/* A host that links all libraries. */
#include <stdio.h>

#include <vitrail/cpu.h>
#ifdef WITH_VULKAN
#include <vitrail/gl.h>
#include <vitrail/vulkan.h>
#include <vitrail/vulkan_raster.h>
#include <vitrail/vulkan_trial.h>
#endif

int main(void) {
  VitrailCpuContext context = NULL;
  if (vitrailVersion() != VITRAIL_VERSION) return 1;
  if (vitrailCpuCreateContext(NULL, &context) != VITRAIL_SUCCESS) return 1;
  vitrailCpuDestroyContext(context);
#ifdef WITH_VULKAN
  vitrailVkDestroyContext(VK_NULL_HANDLE);
  vitrailVkDestroyTarget(VK_NULL_HANDLE);
  vitrailVkDestroyRaster(VK_NULL_HANDLE);
  vitrailVkDestroyTrial(VK_NULL_HANDLE);
  vitrailGlDestroyContext(NULL);
#endif
  printf("components: linked\n");
  return 0;
}
