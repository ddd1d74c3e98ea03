// Where a tile's records are: on pages, the first of 2 to the power of vitrailRaster.pageBits, each next one twice as
// large as the one before. The first pages of all tiles are there from the start.
//
// Where memory is too short for that, triangles are set up twice: the first turn only counts the records of each tile,
// place.comp gives it as many places, and the second turn makes them (VITRAIL_RASTER_COUNTED).
#ifndef VITRAIL_RASTER_PAGES_GLSL
#define VITRAIL_RASTER_PAGES_GLSL

#include "frame.glsl"

uint vitrailPageOf(uint number) { return uint(findMSB((number >> vitrailRaster.pageBits) + 1u)); }
uint vitrailFirstOfPage(uint page) { return ((1u << page) - 1u) << vitrailRaster.pageBits; }

uint vitrailCountIn(uint tile) { return vitrailTiles[tile * VITRAIL_RASTER_TILE_WORDS]; }

// Where a page begins, but of the first ones.
uint vitrailWordOfPage(uint tile, uint page) {
  return tile * VITRAIL_RASTER_TILE_WORDS + VITRAIL_RASTER_FIRST_PAGE + page - 1u;
}

// The first place of a tile. Of those that are counted 0 while it has none.
uint vitrailFirstPlace(uint tile) {
  return vitrailIsCounted() ? vitrailTiles[tile * VITRAIL_RASTER_TILE_WORDS + VITRAIL_RASTER_FIRST_PAGE]
                            : tile << vitrailRaster.pageBits;
}

// The place of a tile's record, when all are there.
uint vitrailRecordOf(uint tile, uint number) {
  if (number < 1u << vitrailRaster.pageBits) return vitrailFirstPlace(tile) + number; // as most do
  uint page = vitrailPageOf(number);
  return vitrailTiles[vitrailWordOfPage(tile, page)] + number - vitrailFirstOfPage(page);
}

#ifdef VITRAIL_MAKES_RECORDS // which frame.glsl defines
// Takes a place for one more record of a tile. Who takes the last quarter of a page gets the next one, so that it is
// there in time, for most. Who comes too early takes some other place; plan.comp brings the record to its own. So
// nobody waits for another, and how much room a frame wants is hardly a matter of chance. The place may be beyond what
// there is room for: then the frame is drawn again.
uint vitrailTakePlace(uint tile) {
  uint number = atomicAdd(vitrailTiles[tile * VITRAIL_RASTER_TILE_WORDS], 1u);
  if (vitrailIsCounted()) {
    uint first = vitrailFirstPlace(tile);
    return first != 0u ? first + number : 0xffffffffu; // this turn counts
  }
  uint page = vitrailPageOf(number);
  uint inPage = number - vitrailFirstOfPage(page);
  uint size = 1u << min(vitrailRaster.pageBits + page, 30u);
  if (inPage == size - size / 4u) {
    uint next;
    VITRAIL_TAKE_PLACES(vitrailRasterControl.records, vitrailRasterControl.recordsHigh, 2u * size, next)
    atomicExchange(vitrailTiles[vitrailWordOfPage(tile, page + 1u)], next);
  }
  if (page == 0u) return (tile << vitrailRaster.pageBits) + inPage;
  uint start = vitrailTiles[vitrailWordOfPage(tile, page)];
  if (start != 0u) return start + inPage;
  uint place;
  VITRAIL_TAKE_PLACES(vitrailRasterControl.records, vitrailRasterControl.recordsHigh, 1u, place)
  uint astray = atomicAdd(vitrailRasterControl.astray, 1u);
  if (astray < vitrailRaster.recordCapacity / VITRAIL_RASTER_ASTRAY_SHARE) {
    vitrailAstray[3u * astray] = tile;
    vitrailAstray[3u * astray + 1u] = number;
    vitrailAstray[3u * astray + 2u] = place;
  }
  return place;
}

#endif

#endif
