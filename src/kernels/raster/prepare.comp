// Reads the frame's draws: how many work groups set up their triangles and ask for their vertices' positions, and where
// each draw's begin. One work group.
#version 460
#extension GL_GOOGLE_include_directive : require
#define VITRAIL_SET 0
#include "vitrail/raster/frame.glsl"

layout(local_size_x = VITRAIL_RASTER_TABLE) in;

layout(VITRAIL_RASTER_BOUND(20), std430) readonly buffer DrawBlock { VitrailRasterDraw draws[]; };
// Where the GPU has counted them.
layout(VITRAIL_RASTER_BOUND(29), std430) readonly buffer CountBlock { uint drawCount; };

shared uvec4 sums[VITRAIL_RASTER_TABLE];
shared vec4 wholes[VITRAIL_RASTER_TABLE];
shared uint wrongIndices; // as in VitrailRasterStart
shared uint wrongBlend;

// The product, or where it is more than may be the most.
uint bounded(uint a, uint b) {
  uint high, low;
  umulExtended(a, b, high, low);
  return high != 0u ? 0xffffffffu : low;
}

// Whether the index buffer has all indices of a draw, without those that are left over of its last triangle or line.
bool hasIndices(VitrailRasterDraw draw, uint corners) {
  if (VITRAIL_RASTER_INDEX_BYTES == 0u) return true;
  uint has = uint(vitrailIndices.length()) * (4u / VITRAIL_RASTER_INDEX_BYTES);
  return draw.firstIndex <= has && draw.count / corners * corners <= has - draw.firstIndex;
}

bool hasBlend(VitrailRasterDraw draw) {
  if (vitrailRaster.drawBlends == 0xffffffffu) return true; // nobody looks at it
  return draw.blend < 32u && (vitrailRaster.drawBlends >> draw.blend & 1u) != 0u;
}

VitrailRasterDispatch dispatchOf(uint groups, uint wanted) {
  return VitrailRasterDispatch(min(groups, VITRAIL_RASTER_ROW), (groups + VITRAIL_RASTER_ROW - 1u) / VITRAIL_RASTER_ROW,
                               1u, wanted);
}

void main() {
  const uint most = 1u << 30; // of what a draw has, for its work groups' threads to have numbers
  uint thread = gl_LocalInvocationIndex;
  uint count = vitrailRaster.countsDraws != 0u ? min(drawCount, vitrailRaster.draws) : vitrailRaster.draws;
  uvec4 before = uvec4(0u); // work groups of triangles, items, work groups of vertices, vertices
  vec4 whole = vec4(0.0);   // the same, as far as floats hold it: numbers that come round are seen
  if (thread == 0u) wrongIndices = wrongBlend = 0u;
  barrier();
  for (uint first = 0u; first < count; first += VITRAIL_RASTER_TABLE) {
    uvec4 mine = uvec4(0u);
    VitrailRasterPlace place;
    if (first + thread < count) {
      VitrailRasterDraw draw = draws[first + thread];
      uint corners = vitrailCornersOf(draw.flags);
      place.size.x = corners == 3u ? draw.count / 3u : draw.count / corners * 2u;
      place.size.y = draw.instances;
      uint triangles = bounded(place.size.x, draw.instances);
      uint vertices = VITRAIL_RASTER_POSITIONS ? bounded(draw.vertices, draw.instances) : 0u;
      if (triangles > most || vertices > most || (corners == 1u && draw.count > most)) {
        whole = vec4(4294967296.0); // said below
        triangles = vertices = place.size.x = place.size.y = 0u;
      }
      if (triangles > 0u && !hasIndices(draw, corners)) {
        atomicMax(wrongIndices, first + thread + 1u);
        triangles = vertices = place.size.x = place.size.y = 0u;
      }
      if (triangles > 0u && !hasBlend(draw)) {
        atomicMax(wrongBlend, first + thread + 1u);
        triangles = vertices = place.size.x = place.size.y = 0u;
      }
      const uint taken = VITRAIL_RASTER_SET_UP * VITRAIL_RASTER_TURNS; // triangles by a work group
      const uint asked = VITRAIL_RASTER_GROUP * VITRAIL_RASTER_VERTICES;
      mine = uvec4((triangles + taken - 1u) / taken, triangles > 0u ? draw.instances : 0u,
                   (vertices + asked - 1u) / asked, vertices);
      if (triangles == 0u) mine.zw = uvec2(0u);
      place.lookup = uvec4(draw.firstIndex, draw.vertices, 0u, draw.firstInstance);
      place.rest = uvec4(uint(draw.vertexOffset), draw.flags, draw.blend, draw.word);
    }
    whole += vec4(mine);
    barrier(); // all have read the last turn's sums
    sums[thread] = mine;
    barrier();
    for (uint step = 1u; step < VITRAIL_RASTER_TABLE; step *= 2u) { // as set_up_large.glsl
      uvec4 other = thread >= step ? sums[thread - step] : uvec4(0u);
      barrier();
      sums[thread] += other;
      barrier();
    }
    uvec4 start = before + sums[thread] - mine;
    before += sums[VITRAIL_RASTER_TABLE - 1u];
    if (first + thread < min(count, vitrailRaster.drawCapacity)) {
      place.lookup.z = start.w - start.y * place.lookup.y; // numbers come round, and back
      place.lookup.w -= start.y;
      place.size.zw = start.xy;
      place.start = uvec4(start.zw, 0u, 0u);
      vitrailDrawPlaces[first + thread] = place;
    }
  }
  wholes[thread] = whole;
  barrier();
  for (uint step = VITRAIL_RASTER_TABLE / 2u; step > 0u; step /= 2u) {
    if (thread < step) wholes[thread] += wholes[thread + step];
    barrier();
  }
  if (thread > 0u) return;
  bool tooMany = any(greaterThan(wholes[0], vec4(2147483648.0)));
  bool fits = !tooMany && count <= vitrailRaster.drawCapacity && before.x <= vitrailRaster.groupCapacity &&
              before.y <= vitrailRaster.itemCapacity && before.z <= vitrailRaster.vertexGroupCapacity &&
              before.w <= vitrailRaster.vertexCapacity;
  uvec4 drawn = fits ? before : uvec4(0u);
  uint rows = max(max(drawn.x, drawn.y), drawn.z);
  vitrailRasterStart.tables = dispatchOf((rows + VITRAIL_RASTER_TABLE - 1u) / VITRAIL_RASTER_TABLE, count);
  vitrailRasterStart.vertices = dispatchOf(drawn.z, before.z);
  vitrailRasterStart.groups = dispatchOf(drawn.x, before.x);
  vitrailRasterStart.items = before.y;
  vitrailRasterStart.vertexCount = before.w;
  vitrailRasterStart.tooMany = tooMany ? 1u : 0u;
  vitrailRasterStart.fits = fits ? 1u : 0u;
  vitrailRasterStart.wrongIndices = wrongIndices;
  vitrailRasterStart.wrongBlend = wrongBlend;
}
