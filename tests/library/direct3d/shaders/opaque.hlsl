// A triangle over the whole picture, of one colour at one depth.
cbuffer Constants : register(b0) {
  float4 color;
  float depth;
};

float4 place(uint id : SV_VertexID) : SV_Position {
  return float4(id == 1 ? 3.0 : -1.0, id == 2 ? 3.0 : -1.0, depth, 1.0);
}

float4 main() : SV_Target { return color; }
