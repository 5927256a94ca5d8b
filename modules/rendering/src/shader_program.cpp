#include "shader_program.hpp"

#include <string>

#include "drape/base/error.hpp"

namespace drape::rendering {
namespace {

constexpr GLsizei log_size = 2000;

GLuint compile(GLenum kind, const char* source) {
  const GlFunctions& gl = gl_functions();
  const GLuint shader = gl.CreateShader(kind);
  gl.ShaderSource(shader, 1, &source, nullptr);
  gl.CompileShader(shader);
  GLint compiled = 0;
  gl.GetShaderiv(shader, GL_COMPILE_STATUS, &compiled);
  if (compiled == 0) {
    std::string words(log_size, '\0');
    gl.GetShaderInfoLog(shader, log_size, nullptr, words.data());
    throw Error(ErrorCode::bug, "a shader does not compile: " + std::string(words.c_str()));
  }
  return shader;
}

}  // namespace

GLuint link_program(const char* vertex_source, const char* fragment_source,
                    std::initializer_list<std::pair<GLuint, const char*>> attributes) {
  const GlFunctions& gl = gl_functions();
  const GLuint program = gl.CreateProgram();
  for (const auto& [kind, source] : {std::pair<GLenum, const char*>{GL_VERTEX_SHADER, vertex_source},
                                     std::pair<GLenum, const char*>{GL_FRAGMENT_SHADER, fragment_source}}) {
    const GLuint shader = compile(kind, source);
    gl.AttachShader(program, shader);
    gl.DeleteShader(shader);
  }
  for (const auto& [location, name] : attributes) gl.BindAttribLocation(program, location, name);
  gl.LinkProgram(program);
  GLint linked = 0;
  gl.GetProgramiv(program, GL_LINK_STATUS, &linked);
  if (linked == 0) {
    std::string words(log_size, '\0');
    gl.GetProgramInfoLog(program, log_size, nullptr, words.data());
    throw Error(ErrorCode::bug, "a shader does not link: " + std::string(words.c_str()));
  }
  return program;
}

}  // namespace drape::rendering
