// Writes words of a buffer in the order of the command list: the first ones as they are given, and behind them one
// value, but for up to four places with another. Direct3D 12 has no command for that.
cbuffer Words : register(b0) {
  uint count; // that are written
  uint given; // of those as given, at most 16
  uint value; // of the others,
  uint mark;  // but for those at `places`
  uint4 words[4];
  uint4 places; // beyond `count`: none
};

RWByteAddressBuffer written : register(u0);

[numthreads(64, 1, 1)] void main(uint3 id : SV_DispatchThreadID) {
  const uint threads = 64u * 32768u; // the most that a dispatch has
  for (uint i = id.x; i < count; i += threads) {
    uint word = value;
    if (i < given) word = words[i / 4u][i % 4u];
    if (any(places == uint4(i, i, i, i))) word = mark;
    written.Store(4u * i, word);
  }
}
