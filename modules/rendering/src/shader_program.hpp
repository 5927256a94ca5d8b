// Linked GLSL programs.
#pragma once

#include <initializer_list>
#include <utility>

#include "gl_functions.hpp"

namespace drape::rendering {

/// Compiles and links in the current context; attributes are bound to the locations given. Error{bug} with
/// the compiler's words if the source is wrong.
[[nodiscard]] GLuint link_program(const char* vertex_source, const char* fragment_source,
                                  std::initializer_list<std::pair<GLuint, const char*>> attributes);

}  // namespace drape::rendering
