/* A host in C with a window: draws two panes, the nearer one first, resolves into the window's own framebuffer, frame
 * after frame, and looks at a pixel. */
#include <epoxy/gl.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include <GLFW/glfw3.h>

#include <vitrail/gl.h>

static const char* const kVertex =
    "#version 430 core\n"
    "uniform float depth;\n"
    "void main() {\n"
    "  vec2 corner = vec2(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0);\n"
    "  gl_Position = vec4(corner, depth, 1.0);\n"
    "}\n";
static const char* const kFragment =
    "uniform vec4 color;\n"
    "void main() { vitrailCollect(color); }\n";

static void fail(const char* what) {
  fprintf(stderr, "gl_glfw: %s\n", what);
  exit(1);
}

static void onLog(VitrailLogSeverity severity, const char* message, void* user) {
  (void)severity;
  (void)user;
  fail(message);
}

static void onDebug(GLenum source, GLenum type, GLuint id, GLenum severity, GLsizei length, const GLchar* text,
                    const void* user) {
  (void)source, (void)id, (void)severity, (void)length, (void)user;
  if (type == GL_DEBUG_TYPE_ERROR || type == GL_DEBUG_TYPE_UNDEFINED_BEHAVIOR) fail(text);
}

static void* load(const char* name, void* user) {
  (void)user;
  return (void*)glfwGetProcAddress(name);
}

static GLuint createProgram(VitrailGlContext context) {
  const GLuint program = glCreateProgram();
  const char* fragment[3] = {"#version 430 core\n", vitrailGlCollectSource(context), kFragment};
  const GLuint shaders[2] = {glCreateShader(GL_VERTEX_SHADER), glCreateShader(GL_FRAGMENT_SHADER)};
  GLint linked = GL_FALSE;
  glShaderSource(shaders[0], 1, &kVertex, NULL);
  glShaderSource(shaders[1], 3, fragment, NULL);
  for (int i = 0; i < 2; ++i) {
    glCompileShader(shaders[i]);
    glAttachShader(program, shaders[i]);
    glDeleteShader(shaders[i]);
  }
  glLinkProgram(program);
  glGetProgramiv(program, GL_LINK_STATUS, &linked);
  if (!linked) fail("the program does not link");
  return program;
}

static void drawPane(GLuint program, float depth, float r, float g, float b, float a) {
  glUniform1f(glGetUniformLocation(program, "depth"), depth);
  glUniform4f(glGetUniformLocation(program, "color"), r, g, b, a);
  glDrawArrays(GL_TRIANGLES, 0, 3);
}

static void checkPixel(void) {
  float pixel[4];
  glReadPixels(20, 20, 1, 1, GL_RGBA, GL_FLOAT, pixel);
  /* Half of green over half of red over blue. */
  const float expected[3] = {0.25f, 0.5f, 0.25f};
  for (int i = 0; i < 3; ++i) {
    if (fabsf(pixel[i] - expected[i]) > 0.01f) {
      fprintf(stderr, "gl_glfw: channel %d is %.3f, not %.3f\n", i, pixel[i], expected[i]);
      exit(1);
    }
  }
}

int main(void) {
  if (!glfwInit()) fail("GLFW does not start");
  glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 4);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 3);
  glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
  glfwWindowHint(GLFW_OPENGL_DEBUG_CONTEXT, GLFW_TRUE);
  GLFWwindow* window = glfwCreateWindow(64, 64, "gl_glfw", NULL, NULL);
  if (window == NULL) fail("there is no window with OpenGL 4.3");
  glfwMakeContextCurrent(window);
  glEnable(GL_DEBUG_OUTPUT);
  glEnable(GL_DEBUG_OUTPUT_SYNCHRONOUS);
  glDebugMessageCallback(onDebug, NULL);

  VitrailGlContextDesc contextDesc = {0};
  contextDesc.getProcAddress = load;
  contextDesc.log = onLog;
  VitrailGlContext context = NULL;
  if (vitrailGlCreateContext(&contextDesc, &context) != VITRAIL_SUCCESS) fail("no context");
  VitrailGlTargetDesc targetDesc = {0};
  targetDesc.width = 64;
  targetDesc.height = 64;
  targetDesc.memoryBudget = 4 << 20;
  targetDesc.resolve = VITRAIL_RESOLVE_FRAGMENT;
  VitrailGlTarget target = NULL;
  if (vitrailGlCreateTarget(context, &targetDesc, &target) != VITRAIL_SUCCESS) fail("no target");
  const GLuint program = createProgram(context);
  GLuint vertices = 0;
  glGenVertexArrays(1, &vertices);
  glBindVertexArray(vertices);
  glViewport(0, 0, 64, 64);

  VitrailStats stats = {0};
  for (int frame = 0; frame < 5; ++frame) {
    if (vitrailGlUpdateTarget(target, 0) != VITRAIL_SUCCESS) fail("no update");
    glDepthMask(GL_TRUE);
    glClearColor(0.0f, 0.0f, 1.0f, 1.0f);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    vitrailGlBegin(target, NULL);
    vitrailGlBind(target);
    glUseProgram(program);
    glEnable(GL_DEPTH_TEST);
    glDepthMask(GL_FALSE);
    glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
    drawPane(program, -0.5f, 0.0f, 1.0f, 0.0f, 0.5f); /* the nearer one first */
    drawPane(program, 0.5f, 1.0f, 0.0f, 0.0f, 0.5f);
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    vitrailGlCollected(target);
    vitrailGlResolve(target, NULL);
    vitrailGlEnd(target);
    checkPixel();
    glfwSwapBuffers(window);
    glfwPollEvents();
  }
  glFinish();
  if (vitrailGlReadStats(target, 0, &stats) != VITRAIL_SUCCESS) fail("no statistics");
  if (stats.complete != 1 || stats.layersMax != 2 || stats.coveredPixels != 64 * 64) fail("wrong statistics");
  vitrailGlDestroyTarget(target);
  vitrailGlDestroyContext(context);
  glDeleteProgram(program);
  glfwTerminate();
  printf("gl_glfw: exact\n");
  return 0;
}
