/* A host in C11 of the rasteriser for CPUs: a surface of each blend mode over an opaque one, the nearest drawn first
 * and last, one pixel's fragments taken by the list hook, and every pixel compared with its closed form. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <vitrail/cpu.h>
#include <vitrail/tiles.h>

#define WIDTH 70 /* tiles are cut off at both sides */
#define HEIGHT 41

static float color[HEIGHT][WIDTH][4];
static float depth[HEIGHT][WIDTH];

static void fail(const char* what) {
  fprintf(stderr, "cpu_c: %s\n", what);
  exit(1);
}

static void printReason(VitrailLogSeverity severity, const char* message, void* user) {
  (void)severity;
  (void)user;
  fprintf(stderr, "cpu_c: %s\n", message);
}

/* The whole picture at one depth, as two triangles. */
static void square(float z, float* corners) {
  const float places[6][2] = {{-1, -1}, {1, -1}, {-1, 1}, {-1, 1}, {1, -1}, {1, 1}};
  for (int i = 0; i < 6; ++i) {
    corners[4 * i] = places[i][0];
    corners[4 * i + 1] = places[i][1];
    corners[4 * i + 2] = z;
    corners[4 * i + 3] = 1;
  }
}

/* From the left to the right of the picture, 0 to 1: the second weight of triangles whose second corner is at the
 * right. Of the second triangle of the square the third corner is there, too. */
static void shadeRamp(void* user, VitrailCpuFragments* f) {
  (void)user;
  for (int i = 0; i < VITRAIL_CPU_LANES; ++i) {
    const float across = f->triangle[i] == 0 ? f->second[i] : f->second[i] + f->third[i];
    f->color[0][i] = across;
    f->color[1][i] = 0.5F;
    f->color[2][i] = 0;
    f->color[3][i] = 0.5F;
  }
}

static int listPixel(void* user, uint32_t x, uint32_t y, const VitrailLayer* layers, uint32_t count, float* pixel) {
  const uint32_t words[3] = {4, 3, 2}; /* the nearest first */
  if (x != 3 || y != 5) return 0;
  for (uint32_t i = 0; i < count && i < 3; ++i) {
    if (layers[i].word == words[i]) ++*(uint32_t*)user;
  }
  pixel[0] = pixel[1] = pixel[2] = 7;
  return 1;
}

static void clear(void) {
  for (int y = 0; y < HEIGHT; ++y) {
    for (int x = 0; x < WIDTH; ++x) {
      for (int c = 0; c < 4; ++c) color[y][x][c] = c == 3 ? 1.0F : 0.25F;
      depth[y][x] = 1;
    }
  }
}

static void check(int hasHook) {
  for (int y = 0; y < HEIGHT; ++y) {
    for (int x = 0; x < WIDTH; ++x) {
      const double opaque[3] = {0.8, 0.6, 0.4}, filter[3] = {0.5, 1, 1}, glow[3] = {0, 0.2, 0.1};
      const double ramp[3] = {(x + 0.5) / WIDTH, 0.5, 0};
      for (int c = 0; c < 3; ++c) {
        double right = 0.5 * ramp[c] + 0.5 * (glow[c] + filter[c] * opaque[c]);
        if (hasHook && x == 3 && y == 5) right = 7;
        if (!(fabs(color[y][x][c] - right) < 1e-5)) {
          fprintf(stderr, "cpu_c: channel %d of pixel (%d, %d) is %g and should be %g\n", c, x, y,
                  (double)color[y][x][c], right);
          exit(1);
        }
      }
      if (!(fabs((double)depth[y][x] - 0.75) < 1e-6)) fail("the opaque depth was not written");
    }
  }
}

int main(void) {
  if (vitrailVersion() != VITRAIL_VERSION) fail("the library has not the version of its headers");
  if (!(vitrailNodeErrorBound(VITRAIL_NODE_HDR, 1, 4) < 1)) fail("vitrailNodeErrorBound() is wrong");
  vitrailDestroyTilePlan(NULL); /* what needs no graphics API is in this library, too */

  float corners[5][24];
  const float depths[5] = {0.75F, 0.9F, 0.5F, 0.25F, 0.125F}; /* the second is hidden */
  VitrailCpuDraw draws[5];
  memset(draws, 0, sizeof draws);
  for (uint32_t i = 0; i < 5; ++i) {
    square(depths[i], corners[i]);
    draws[i].positions = corners[i];
    draws[i].vertexCount = 6;
    draws[i].word = i;
  }
  draws[0].surface = VITRAIL_CPU_OPAQUE;
  memcpy(draws[0].color, (const float[4]){0.8F, 0.6F, 0.4F, 1}, sizeof draws[0].color);
  memcpy(draws[1].color, (const float[4]){1, 1, 1, 1}, sizeof draws[1].color);
  draws[2].blend = VITRAIL_BLEND_MULTIPLY;
  memcpy(draws[2].color, (const float[4]){0.5F, 1, 1, 1}, sizeof draws[2].color);
  draws[3].blend = VITRAIL_BLEND_ADDITIVE;
  memcpy(draws[3].color, (const float[4]){0, 0.4F, 0.2F, 0.5F}, sizeof draws[3].color);
  draws[4].shade = shadeRamp;
  draws[4].brightest = 1;

  const VitrailCpuContextDesc desc = {.threads = 2, .log = printReason};
  VitrailCpuContext context = NULL;
  if (vitrailCpuCreateContext(&desc, &context) != VITRAIL_SUCCESS) fail("there is no context");
  VitrailCpuFrame frame = {.width = WIDTH, .height = HEIGHT, .color = color, .depth = &depth[0][0]};
  for (int hasHook = 0; hasHook < 2; ++hasHook) {
    uint32_t found = 0;
    frame.list = hasHook ? listPixel : NULL;
    frame.listUser = &found;
    VitrailStats stats = {0};
    clear();
    if (vitrailCpuRender(context, &frame, draws, 5, &stats) != VITRAIL_SUCCESS) fail("the frame was not drawn");
    if (!stats.exact || stats.fragmentsRequested != 3 * WIDTH * HEIGHT) fail("the statistics are wrong");
    if (hasHook && found != 3) fail("the hook did not get the three fragments in their order");
    check(hasHook);
    const VitrailCpuDraw first = draws[1]; /* another order, the same picture */
    draws[1] = draws[4];
    draws[4] = first;
  }
  vitrailCpuDestroyContext(context);
  printf("cpu_c: every pixel is right\n");
  return 0;
}
