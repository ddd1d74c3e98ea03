// pool.glsl for HLSL: reaches a target's node pool, in any format, as bytes. Before the include, define
//
//   vitrailPool                  its buffer, RWByteAddressBuffer, or with VITRAIL_READ_ONLY ByteAddressBuffer
//   uint vitrailPoolCapacity()   its nodes
//
// A node is handled as four words, as in node.hlsl: `w` is the word that holds `next`.
#ifndef VITRAIL_POOL_HLSL
#define VITRAIL_POOL_HLSL

#include "node.hlsl"

// Where a node of `standard` has its link: behind 8 bytes a node.
uint vitrailLinkAddress(uint index) { return 8u * vitrailPoolCapacity() + 4u * index; }

// The words of a node, in however many arrays they lie.
uint vitrailNodeWords(VitrailLayout nodes) {
  return VITRAIL_IS_FORMAT(nodes, VITRAIL_FORMAT_STANDARD)  ? 3u
         : VITRAIL_IS_FORMAT(nodes, VITRAIL_FORMAT_COMPACT) ? 2u
                                                            : 4u;
}

// Where the host's word of a node lies: behind all nodes.
uint vitrailWordAddress(uint index, VitrailLayout nodes) {
  return 4u * (vitrailNodeWords(nodes) * vitrailPoolCapacity() + index);
}

#ifndef VITRAIL_READ_ONLY
void vitrailStoreNode(uint index, uint4 node, VitrailLayout nodes) {
  if (VITRAIL_IS_FORMAT(nodes, VITRAIL_FORMAT_STANDARD)) {
    vitrailPool.Store2(8u * index, node.xy);
    vitrailPool.Store(vitrailLinkAddress(index), node.w);
  } else if (VITRAIL_IS_FORMAT(nodes, VITRAIL_FORMAT_COMPACT)) {
    vitrailPool.Store2(8u * index, node.xw);
  } else {
    vitrailPool.Store4(16u * index, node);
  }
}

void vitrailStoreWord(uint index, uint word, VitrailLayout nodes) {
  vitrailPool.Store(vitrailWordAddress(index, nodes), word);
}
#endif

uint4 vitrailLoadNode(uint index, VitrailLayout nodes) {
  uint4 node;
  if (VITRAIL_IS_FORMAT(nodes, VITRAIL_FORMAT_STANDARD)) {
    uint link = vitrailPool.Load(vitrailLinkAddress(index)); // first: the next node waits for it
    node = uint4(vitrailPool.Load2(8u * index), 0u, link);
  } else if (VITRAIL_IS_FORMAT(nodes, VITRAIL_FORMAT_COMPACT)) {
    uint2 words = vitrailPool.Load2(8u * index);
    node = uint4(words.x, 0u, 0u, words.y);
  } else {
    node = vitrailPool.Load4(16u * index);
  }
  return node;
}

// Only the word that holds the index of the next node, and what shares it.
uint vitrailLoadNext(uint index, VitrailLayout nodes) {
  uint address = 16u * index + 12u;
  if (VITRAIL_IS_FORMAT(nodes, VITRAIL_FORMAT_STANDARD)) address = vitrailLinkAddress(index);
  if (VITRAIL_IS_FORMAT(nodes, VITRAIL_FORMAT_COMPACT)) address = 8u * index + 4u;
  return vitrailPool.Load(address);
}

// The host's word of a node, of targets whose nodes carry one.
uint vitrailLoadWord(uint index, VitrailLayout nodes) { return vitrailPool.Load(vitrailWordAddress(index, nodes)); }

#endif
