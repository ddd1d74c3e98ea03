#include "hazards.h"

#include <epoxy/gl.h>

#include <array>
#include <map>

namespace vitrail::tests::opengl {

namespace {

// What a program reaches that shaders can write.
struct Program {
  bool storage = false;
  bool image = false;
};

Program lookAt(GLuint program) {
  Program found;
  GLint count = 0;
  glGetProgramInterfaceiv(program, GL_SHADER_STORAGE_BLOCK, GL_ACTIVE_RESOURCES, &count);
  found.storage = count > 0;
  glGetProgramInterfaceiv(program, GL_UNIFORM, GL_ACTIVE_RESOURCES, &count);
  for (GLint i = 0; i < count; ++i) {
    constexpr GLenum kType = GL_TYPE;
    GLint type = 0;
    glGetProgramResourceiv(program, GL_UNIFORM, static_cast<GLuint>(i), 1, &kType, 1, nullptr, &type);
    found.image = found.image || type == GL_IMAGE_2D;
  }
  return found;
}

// Storage and images that shaders have written, and for which uses a barrier is still to come.
class Memory {
 public:
  void barrier(GLbitfield bits) {
    storage_ &= ~bits;
    arguments_ &= ~bits;
    image_ &= ~bits;
  }

  void dispatch(const Program& program, bool indirect) {
    runShaders("a dispatch", program, indirect);
    if (program.storage) arguments_ = GL_COMMAND_BARRIER_BIT;
    resolved_ = false;
  }
  // Of the draws of a fragment resolve, which follow each other, only one has vertices. They count what they see, and
  // write no arguments.
  void resolve(const Program& program) {
    runShaders("a draw", resolved_ ? Program{} : program, true);
    resolved_ = true;
  }
  void collect() { runShaders(kHostCollects, {true, false}, false); }

  void transfer(std::string_view name) { use(storage_, GL_BUFFER_UPDATE_BARRIER_BIT, name); }

  void hostOrdersPicture() { image_ = 0; }
  void hostUsesPicture() {
    constexpr std::array<GLbitfield, 5> kUses = {GL_TEXTURE_FETCH_BARRIER_BIT, GL_SHADER_IMAGE_ACCESS_BARRIER_BIT,
                                                 GL_FRAMEBUFFER_BARRIER_BIT, GL_TEXTURE_UPDATE_BARRIER_BIT,
                                                 GL_PIXEL_BUFFER_BARRIER_BIT};
    for (const GLbitfield bit : kUses) use(image_, bit, kHostUsesPicture);
  }

  std::vector<std::string> missing;

 private:
  void use(GLbitfield written, GLbitfield bit, std::string_view name) {
    if ((written & bit) == 0) return;
    missing.push_back(std::string(name) + ": what shaders wrote is used without the bit " + std::to_string(bit));
  }

  void runShaders(std::string_view name, const Program& program, bool indirect) {
    if (indirect) use(arguments_, GL_COMMAND_BARRIER_BIT, name);
    if (program.storage) {
      use(storage_, GL_SHADER_STORAGE_BARRIER_BIT, name);
      storage_ = GL_ALL_BARRIER_BITS;
    }
    if (program.image) {
      use(image_, GL_SHADER_IMAGE_ACCESS_BARRIER_BIT, name);
      image_ = GL_ALL_BARRIER_BITS;
    }
  }

  GLbitfield storage_ = 0;
  GLbitfield arguments_ = 0; // in storage; which dispatches write and no draw does
  GLbitfield image_ = 0;
  bool resolved_ = false; // the last thing was a draw of a resolve
};

bool isTransfer(std::string_view name) {
  return name == "BufferSubData" || name == "ClearBufferSubData" || name == "CopyBufferSubData" ||
         name == "GetBufferSubData";
}

} // namespace

std::vector<std::string> missingBarriers(const std::vector<TappedCall>& calls) {
  std::map<GLuint, Program> programs;
  Program program; // the current one
  Memory memory;
  for (const TappedCall& call : calls) {
    if (call.name == "UseProgram" && call.first != 0) {
      const auto [at, isNew] = programs.try_emplace(call.first);
      if (isNew) at->second = lookAt(call.first);
      program = at->second;
    }
    if (call.name == "MemoryBarrier") memory.barrier(call.first);
    if (call.name == "DispatchCompute") memory.dispatch(program, false);
    if (call.name == "DispatchComputeIndirect") memory.dispatch(program, true);
    if (call.name == "DrawArraysIndirect") memory.resolve(program);
    if (isTransfer(call.name)) memory.transfer(call.name);
    if (call.name == kHostCollects) memory.collect();
    if (call.name == kHostOrdersPicture) memory.hostOrdersPicture();
    if (call.name == kHostUsesPicture) memory.hostUsesPicture();
  }
  return memory.missing;
}

} // namespace vitrail::tests::opengl
