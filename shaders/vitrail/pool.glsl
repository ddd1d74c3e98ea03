// Reaches a target's node pool, in any format, through a binding or, where the including shader defines
// VITRAIL_BUFFER_REFERENCE, through its address, which has no limit of size. Before the include, define
//
//   VITRAIL_SET                  the set of the target, where the pool is bound
//   uint vitrailPoolCapacity()   its nodes
//   uvec2 vitrailPoolAddress()   its address (VITRAIL_BUFFER_REFERENCE only)
//
// A node is handled as four words, as in node.glsl: `w` is the word that holds `next`.
#ifndef VITRAIL_POOL_GLSL
#define VITRAIL_POOL_GLSL

#include "bindings.h"
#include "node.glsl"

#ifdef VITRAIL_BUFFER_REFERENCE
layout(buffer_reference, std430, buffer_reference_align = 16) buffer VitrailStandardNodes {
  VitrailNodeStandard nodes[];
};
layout(buffer_reference, std430, buffer_reference_align = 8) buffer VitrailLinks { uint links[]; };
layout(buffer_reference, std430, buffer_reference_align = 4) buffer VitrailWords { uint words[]; };
layout(buffer_reference, std430, buffer_reference_align = 16) buffer VitrailCompactNodes {
  VitrailNodeCompact nodes[];
};
layout(buffer_reference, std430, buffer_reference_align = 16) buffer VitrailHdrNodes { VitrailNodeHdr nodes[]; };

// Behind 8 bytes a node.
uvec2 vitrailLinksAddress() {
  uvec2 pool = vitrailPoolAddress();
  uint carry;
  uint low = uaddCarry(pool.x, vitrailPoolCapacity() << 3, carry);
  return uvec2(low, pool.y + (vitrailPoolCapacity() >> 29) + carry);
}
// Behind so many nodes of `perNode` words each.
uvec2 vitrailWordsAddress(uint count, uint perNode) {
  uvec2 pool = vitrailPoolAddress();
  uint high;
  uint bytes;
  umulExtended(count, 4u * perNode, high, bytes);
  uint carry;
  uint low = uaddCarry(pool.x, bytes, carry);
  return uvec2(low, pool.y + high + carry);
}
#define VITRAIL_STANDARD(index) VitrailStandardNodes(vitrailPoolAddress()).nodes[index].words
#define VITRAIL_LINK(index) VitrailLinks(vitrailLinksAddress()).links[index]
#define VITRAIL_WORD(index, perNode) VitrailWords(vitrailWordsAddress(vitrailPoolCapacity(), perNode)).words[index]
#define VITRAIL_COMPACT(index) VitrailCompactNodes(vitrailPoolAddress()).nodes[index].words
#define VITRAIL_HDR(index) VitrailHdrNodes(vitrailPoolAddress()).nodes[index].words
#else
layout(VITRAIL_BOUND(VITRAIL_SET, VITRAIL_BINDING_NODES), std430) buffer VitrailStandardBlock {
  VitrailNodeStandard vitrailStandardNodes[];
};
layout(VITRAIL_BOUND(VITRAIL_SET, VITRAIL_BINDING_NODES), std430) buffer VitrailLinkBlock { uint vitrailLinks[]; };
layout(VITRAIL_BOUND(VITRAIL_SET, VITRAIL_BINDING_NODES), std430) buffer VitrailCompactBlock {
  VitrailNodeCompact vitrailCompactNodes[];
};
layout(VITRAIL_BOUND(VITRAIL_SET, VITRAIL_BINDING_NODES), std430) buffer VitrailHdrBlock {
  VitrailNodeHdr vitrailHdrNodes[];
};
#define VITRAIL_STANDARD(index) vitrailStandardNodes[index].words
#define VITRAIL_LINK(index) vitrailLinks[2u * vitrailPoolCapacity() + index]
#define VITRAIL_WORD(index, perNode) vitrailLinks[(perNode) * vitrailPoolCapacity() + (index)]
#define VITRAIL_COMPACT(index) vitrailCompactNodes[index].words
#define VITRAIL_HDR(index) vitrailHdrNodes[index].words
#endif

void vitrailStoreStandard(uint index, uvec4 node) {
  VITRAIL_STANDARD(index) = node.xy;
  VITRAIL_LINK(index) = node.w;
}
void vitrailStoreCompact(uint index, uvec4 node) { VITRAIL_COMPACT(index) = node.xw; }
void vitrailStoreHdr(uint index, uvec4 node) { VITRAIL_HDR(index) = node; }

void vitrailStoreNode(uint index, uvec4 node, VitrailLayout nodes) {
#ifdef VITRAIL_ONLY_FORMAT
#if VITRAIL_MAY_BE(0)
  vitrailStoreStandard(index, node);
#elif VITRAIL_MAY_BE(1)
  vitrailStoreCompact(index, node);
#else
  vitrailStoreHdr(index, node);
#endif
#else
  if (nodes.format == VITRAIL_FORMAT_STANDARD) {
    vitrailStoreStandard(index, node);
  } else if (nodes.format == VITRAIL_FORMAT_COMPACT) {
    vitrailStoreCompact(index, node);
  } else {
    vitrailStoreHdr(index, node);
  }
#endif
}

uvec4 vitrailLoadStandard(uint index) {
  uint link = VITRAIL_LINK(index); // first: the next node waits for it
  return uvec4(VITRAIL_STANDARD(index), 0u, link);
}
uvec4 vitrailLoadCompact(uint index) {
  uvec2 words = VITRAIL_COMPACT(index);
  return uvec4(words.x, 0u, 0u, words.y);
}

uvec4 vitrailLoadNode(uint index, VitrailLayout nodes) {
  return VITRAIL_CHOOSE(nodes, vitrailLoadStandard(index), vitrailLoadCompact(index), VITRAIL_HDR(index));
}

// Only the word that holds the index of the next node, and what shares it.
uint vitrailLoadNext(uint index, VitrailLayout nodes) {
  return VITRAIL_CHOOSE(nodes, VITRAIL_LINK(index), VITRAIL_COMPACT(index).y, VITRAIL_HDR(index).w);
}

// Links a node to another; what else its word holds stays.
void vitrailStoreNext(uint index, uint next, VitrailLayout nodes) {
  uint mask = vitrailNextMask(nodes);
  uint word = next & mask;
  if (mask != 0xffffffffu) word |= vitrailLoadNext(index, nodes) & ~mask;
  if (nodes.format == VITRAIL_FORMAT_STANDARD) {
    VITRAIL_LINK(index) = word;
  } else if (nodes.format == VITRAIL_FORMAT_COMPACT) {
    VITRAIL_COMPACT(index).y = word;
  } else {
    VITRAIL_HDR(index).w = word;
  }
}

// The words of a node, in however many arrays they lie.
uint vitrailNodeWords(VitrailLayout nodes) {
  return VITRAIL_CHOOSE(nodes, 3u, 2u, 4u);
}

// The host's word of a node, of targets whose nodes carry one.
void vitrailStoreWord(uint index, uint word, VitrailLayout nodes) {
  VITRAIL_WORD(index, vitrailNodeWords(nodes)) = word;
}
uint vitrailLoadWord(uint index, VitrailLayout nodes) { return VITRAIL_WORD(index, vitrailNodeWords(nodes)); }

#endif
