#include "gl_functions.hpp"

#include <GL/osmesa.h>

#include "drape/base/error.hpp"

namespace drape::rendering {
namespace {

GlFunctions look_up() {
  GlFunctions gl;
#define DRAPE_GL_LOOK_UP(type, name)                                  \
  gl.name = reinterpret_cast<type>(OSMesaGetProcAddress("gl" #name)); \
  if (gl.name == nullptr) throw input_error("this OSMesa library has no gl" #name);
  DRAPE_GL_FUNCTIONS(DRAPE_GL_LOOK_UP)
#undef DRAPE_GL_LOOK_UP
  return gl;
}

}  // namespace

const GlFunctions& gl_functions() {
  static const GlFunctions gl = look_up();
  return gl;
}

}  // namespace drape::rendering
