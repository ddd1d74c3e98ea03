/* The header in C: by itself, and beside Direct3D's own. */
#include <vitrail/d3d11.h>

#define COBJMACROS
#include <d3d11.h>

/* A call is made with what each of the headers declares. */
VitrailResult contextFromC(ID3D11Device* device, VitrailD3d11Context* context);
VitrailResult contextFromC(ID3D11Device* device, VitrailD3d11Context* context) {
  VitrailD3d11ContextDesc desc = {0};
  desc.device = device;
  return vitrailD3d11CreateContext(&desc, context);
}
