/* What the blocks of code in docs/cpu.md take as given: the host's own variables and functions. */
#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include <vitrail/cpu.h>

typedef struct Vertex {
  float position[3];
  float normal[3];
} Vertex;

extern VitrailResult result;
extern VitrailCpuContext context;
extern VitrailCpuFrame frame;
extern VitrailStats stats;
extern const VitrailCpuDraw* draws;
extern uint32_t drawCount;
extern const VitrailCpuDraw* transparentDraws;
extern uint32_t transparentCount;

extern uint32_t threadCount;
extern void* pool;
extern uint32_t width;
extern uint32_t height;
extern float* picture;
extern void* windowPixels;
extern uint32_t windowStride;
extern float* opaqueColor;
extern float* opaqueDepth;
extern uint32_t pictureWidth;
extern uint32_t pictureHeight;
extern uint32_t rows;
extern float* stripPixels;

extern const Vertex vertices[];
extern uint32_t vertexCount;
extern const uint32_t* indices;
extern uint32_t indexCount;
extern const float modelViewProjection[16];

extern const VitrailLayer* layers;
extern uint32_t layerCount;
extern float* pixelColor;

void printReason(VitrailLogSeverity severity, const char* message, void* user);
void runOnPool(void* user, uint32_t count, void (*task)(void* data, uint32_t i), void* data);
int drawThickness(void* user, uint32_t x, uint32_t y, const VitrailLayer* pixelLayers, uint32_t count, float* color);
int showProgress(void* user, uint32_t tilesDone, uint32_t tiles);
void useSmallerScene(void);
void writeRows(const float* pixels, uint32_t count);
