// The host's root signature: what vitrailCollect() needs, from parameter 0 on.
#define ROOT "CBV(b13), UAV(u1), UAV(u2), UAV(u3), UAV(u4)"
