// What the guides' shaders take as given.
vec3 smoke = vec3(0.2), highlight = vec3(0.9), flame = vec3(1.0, 0.5, 0.1), tint = vec3(0.6, 0.8, 0.9);
vec4 shade() { return vec4(smoke, 0.5); }
