// A frame buffer of our own: one colour plane of a chosen format and a floating-point depth plane.
#pragma once

#include <Eigen/Core>

#include "clip_matrix.hpp"
#include "gl_functions.hpp"

namespace drape::rendering {

/// Lives in the context that is current when it is first used, as long as that does.
class RenderTarget {
 public:
  enum class Kind {
    coverage,  // 8 bits, no depth plane
    faces,     // 32-bit numbers
    colors     // RGBA
  };
  explicit RenderTarget(Kind kind) : kind_(kind) {}

  /// Binds it at the window's size in samples, cleared (faces to all ones, colours to `background`), with all
  /// of OpenGL's state that our passes depend on. Error{try_again} when there is no memory for it.
  void begin(const Window& window, const Eigen::Vector3f& background = Eigen::Vector3f::Zero());

  /// Copies what was drawn to `destination`, whose rows are `row_length` pixels apart.
  void read(void* destination, int row_length) const;

 private:
  void allocate(int width, int height);

  Kind kind_;
  int width_ = 0;
  int height_ = 0;
  GLuint framebuffer_ = 0;
  GLuint color_ = 0;
  GLuint depth_ = 0;
};

}  // namespace drape::rendering
