/* What the guides' blocks of code for OpenGL take as given: the host's own variables and functions. */
#include <epoxy/gl.h>

#include <vitrail/gl.h>

#ifdef __cplusplus
#define VITRAIL_NO_VULKAN
#include <vitrail/vitrail.hpp>
extern "C" {
#endif

extern VitrailGlContextDesc contextDesc;
extern VitrailGlContext context;
extern VitrailGlTargetDesc targetDesc;
extern VitrailGlTarget target;

extern GLuint shader;
extern const char* myText;

void drawOpaque(void);
void drawTransparent(void);

#ifdef __cplusplus
}
#endif
