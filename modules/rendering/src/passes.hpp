// The shaders that pictures are drawn with.
#pragma once

#include <Eigen/Core>

#include "drape/geometry/camera.hpp"
#include "gl_functions.hpp"
#include "mesh_buffers.hpp"

namespace drape::rendering {

/// Draws 1.0 wherever a face is.
class StencilPass {
 public:
  StencilPass();
  void use(const Eigen::Matrix4d& clip_from_local) const;

 private:
  GLuint program_;
  GLint clip_from_local_;
};

/// Draws each face's number.
class FacePass {
 public:
  FacePass();
  void use(const Eigen::Matrix4d& clip_from_local) const;

 private:
  GLuint program_;
  GLint clip_from_local_;
};

/// What the light needs to know of a camera: see shade() in passes.cpp.
struct ViewFrame {
  Eigen::Matrix3f camera_from_local;  // rotation only
  Eigen::Vector3f eye;                // optical centre in that frame, or the direction towards it
  bool perspective;
  ViewFrame(const Camera& camera, const LocalFrame& local);
};

/// Draws lit vertex colours.
class ShadedPass {
 public:
  ShadedPass();
  /// color: of a mesh without colours; alpha 1 of a vertex mixes `filled_color` in.
  void use(const Eigen::Matrix4d& clip_from_local, const ViewFrame& view,
           const Eigen::Vector3f& filled_color) const;

 private:
  GLuint program_;
  GLint clip_from_local_, camera_from_local_, eye_, perspective_, filled_color_;
};

/// Draws a texture, or a flat colour times the vertex colours.
class TexturedPass {
 public:
  TexturedPass();
  void use(const Eigen::Matrix4d& clip_from_local, const ViewFrame& view, bool lit) const;
  /// After use(); the image is that of texture unit 0.
  void set_material(bool image, const Eigen::Vector3f& flat_color) const;

 private:
  GLuint program_;
  GLint clip_from_local_, camera_from_local_, eye_, perspective_, lit_, image_, flat_color_;
};

}  // namespace drape::rendering
