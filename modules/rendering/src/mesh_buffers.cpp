#include "mesh_buffers.hpp"

#include <algorithm>
#include <cmath>

#include "drape/base/error.hpp"

namespace drape::rendering {
namespace {

constexpr GLuint faces_slot = attribute::uv + 1;

}  // namespace

LocalFrame::LocalFrame(const TriangleMesh& mesh) {
  for (const Face& face : mesh.faces)
    for (const std::uint32_t v : face) box.extend(mesh.vertices[v]);
  if (box.isEmpty()) return;
  center = box.center();
  const double half_diagonal = box.diagonal().norm() / 2;
  if (half_diagonal > 0) scale = half_diagonal;
}

Eigen::Matrix4d LocalFrame::world_from_local() const {
  Eigen::Matrix4d matrix = Eigen::Matrix4d::Identity();
  matrix.topLeftCorner<3, 3>() *= scale;
  matrix.topRightCorner<3, 1>() = center;
  return matrix;
}

Rgba to_bytes(const Eigen::Vector3f& color, std::uint8_t alpha) {
  Rgba bytes;
  for (int i = 0; i < 3; ++i)
    bytes[i] = static_cast<std::uint8_t>(std::lround(255.0F * std::clamp(color[i], 0.0F, 1.0F)));
  bytes[3] = alpha;
  return bytes;
}

VertexArray::VertexArray() {
  gl_functions().GenVertexArrays(1, &array_);
}

void VertexArray::fill_buffer(GLenum target, GLuint slot, const void* data, std::size_t bytes) {
  const GlFunctions& gl = gl_functions();
  bind();
  GLuint& buffer = buffers_[slot];
  if (buffer == 0) gl.GenBuffers(1, &buffer);
  gl.BindBuffer(target, buffer);
  gl.BufferData(target, static_cast<GLsizeiptr>(bytes), data, GL_STATIC_DRAW);
  if (gl.GetError() != GL_NO_ERROR)
    throw Error(ErrorCode::try_again, "no memory for a mesh that is to be drawn");
}

void VertexArray::add(GLuint attribute, std::span<const Eigen::Vector3f> values) {
  fill_buffer(GL_ARRAY_BUFFER, attribute, values.data(), values.size_bytes());
  gl_functions().VertexAttribPointer(attribute, 3, GL_FLOAT, GL_FALSE, 0, nullptr);
  gl_functions().EnableVertexAttribArray(attribute);
}

void VertexArray::add(GLuint attribute, std::span<const Eigen::Vector2f> values) {
  fill_buffer(GL_ARRAY_BUFFER, attribute, values.data(), values.size_bytes());
  gl_functions().VertexAttribPointer(attribute, 2, GL_FLOAT, GL_FALSE, 0, nullptr);
  gl_functions().EnableVertexAttribArray(attribute);
}

void VertexArray::add(GLuint attribute, std::span<const Rgba> values) {
  fill_buffer(GL_ARRAY_BUFFER, attribute, values.data(), values.size_bytes());
  gl_functions().VertexAttribPointer(attribute, 4, GL_UNSIGNED_BYTE, GL_TRUE, 0, nullptr);
  gl_functions().EnableVertexAttribArray(attribute);
}

void VertexArray::set_faces(std::span<const Face> faces) {
  fill_buffer(GL_ELEMENT_ARRAY_BUFFER, faces_slot, faces.data(), faces.size_bytes());
}

void VertexArray::bind() const {
  gl_functions().BindVertexArray(array_);
}

void draw_faces(std::size_t first, std::size_t count) {
  const std::size_t offset = first * sizeof(Face);
  gl_functions().DrawElements(GL_TRIANGLES, static_cast<GLsizei>(3 * count), GL_UNSIGNED_INT,
                              reinterpret_cast<const void*>(offset));
}

}  // namespace drape::rendering
