#include <vitrail/cpu.h>
VitrailResult vitrailCpuCreateContext(const VitrailCpuContextDesc*, VitrailCpuContext* context) {
  *context = nullptr;
  return VITRAIL_SUCCESS;
}
void vitrailCpuDestroyContext(VitrailCpuContext) {}
VitrailCpuInstructions vitrailCpuContextInstructions(VitrailCpuContext) { return VITRAIL_CPU_AVX2; }
uint32_t vitrailCpuContextThreads(VitrailCpuContext) { return 2; }
VitrailResult vitrailCpuRender(VitrailCpuContext, const VitrailCpuFrame*, const VitrailCpuDraw*, uint32_t,
                               VitrailStats* s) {
  s->complete = 1;
  return VITRAIL_SUCCESS;
}
