// Lists as demos of Direct3D 11 keep them: structures that the buffer's hidden counter hands out, a head a pixel.
struct StoredFragment {
  uint2 color; // halves
  float depth;
  uint coverage;
  uint next;
};
static const uint kEndOfList = 0xffffffffu;
#ifdef FIGURES_BUFFER
FIGURES_BUFFER storedFragments : register(u1);
RWTexture2D<uint> storedHeads : register(u2);
#else
StructuredBuffer<StoredFragment> storedFragments : register(t0);
Texture2D<uint> storedHeads : register(t1);
#endif
