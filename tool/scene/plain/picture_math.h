// Makes pictures that a material needs out of those that a file names.
#pragma once

#include "../scene.h"

namespace vitrail::tool {

// One channel of a picture: r, g, b, m (alpha), l or z (luminance). '\0': alpha where the picture has any, otherwise
// luminance.
char usedChannel(const Image& image, char channel);

// Makes each value base + gain * value; alpha stays.
Image rescaled(Image image, float base, float gain);

// The colours of one picture (white without it) and a channel of another as its alpha, in the larger of both sizes.
Image withAlpha(const Image* colors, const Image& alpha, char channel);

// glTF's texture: green is the channel of one picture, blue that of the other; full where there is none. One is there.
Image metallicRoughnessImage(const Image* roughness, char roughnessChannel, const Image* metallic,
                             char metallicChannel);

// Whether a picture holds directions rather than heights: its colours are of about unit length, and most point
// outwards.
bool looksLikeNormals(const Image& image);

// The normal map of a height map. From black to white is `strength` hundredths of the picture's width.
Image normalsFromHeights(const Image& heights, char channel, float strength);

} // namespace vitrail::tool
