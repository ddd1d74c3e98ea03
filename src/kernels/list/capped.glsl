// Lists of which only the nearest fragments are sorted (maxLayers, at most 16): one invocation, any length. Between a
// producer (list/walk.glsl) and a sink (sink/blend.glsl), which the shader includes before.
#ifndef VITRAIL_CAPPED_GLSL
#define VITRAIL_CAPPED_GLSL

// A list of any length, of which the nearest maxLayers (at most 16) fragments are handed over in order and the others
// as the rest. The nearest stand at the end of the registers, so that what falls out is always the farthest.
VitrailSink vitrailCapped(uint head, uint nodeCount) {
  VitrailWalk walk = VitrailWalk(head, 0u, nodeCount);
  VitrailEntry e[16] = VitrailEntry[16](VITRAIL_LAST_16);
  VitrailEntry first = VitrailEntry(uvec4(0u), 0xffffffffu); // before every fragment: none has an empty key
  for (uint i = vitrailMaxLayers(); i < 16u; ++i) vitrailInsert(e, first);
  VitrailSink sink = vitrailBegin();
  while (vitrailMore(walk)) {
    VitrailEntry farthest = vitrailInsert(e, vitrailTake(walk));
    if (farthest.key.x != 0xffffffffu) vitrailPutRest(sink, farthest);
  }
  for (int i = 0; i < 16; ++i) {
    if (e[0].key != uvec4(0u) && e[0].key.x != 0xffffffffu) vitrailPut(sink, e[0], uint(i) + vitrailMaxLayers() - 16u);
    vitrailShift(e);
  }
  vitrailEnd(sink);
  sink.layers = walk.count;
  return sink;
}

#endif
