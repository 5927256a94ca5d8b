#include "passes.hpp"

#include <string>

#include "shader_program.hpp"

namespace drape::rendering {
namespace {

constexpr const char* position_only = R"(#version 450 core
in vec3 position;
uniform mat4 clip_from_local;
void main() { gl_Position = clip_from_local * vec4(position, 1.0); }
)";

constexpr const char* draw_one = R"(#version 450 core
out float covered;
void main() { covered = 1.0; }
)";

constexpr const char* draw_face = R"(#version 450 core
out uint face;
void main() { face = uint(gl_PrimitiveID); }
)";

// Light is reckoned in the camera's axes (x right, y down, z forward), about the middle of the mesh.
constexpr const char* surface_vertex = R"(#version 450 core
in vec3 position;
in vec3 normal;
in vec4 color;
in vec2 uv;
uniform mat4 clip_from_local;
uniform mat3 camera_from_local;
out vec3 place;
out vec3 smooth_normal;
out vec4 vertex_color;
out vec2 texture_place;
void main() {
  gl_Position = clip_from_local * vec4(position, 1.0);
  place = camera_from_local * position;
  smooth_normal = camera_from_local * normal;
  vertex_color = color;
  texture_place = uv;
}
)";

constexpr const char* light = R"(#version 450 core
in vec3 place;
in vec3 smooth_normal;
in vec4 vertex_color;
in vec2 texture_place;
uniform vec3 eye;
uniform bool perspective;
out vec4 pixel;

vec3 decode(vec3 c) {  // IEC 61966-2-1
  return mix(c / 12.92, pow((c + 0.055) / 1.055, vec3(2.4)), greaterThan(c, vec3(0.04045)));
}
vec3 encode(vec3 c) {
  c = clamp(c, 0.0, 1.0);
  return mix(12.92 * c, 1.055 * pow(c, vec3(1.0 / 2.4)) - 0.055, greaterThan(c, vec3(0.0031308)));
}

// A soft key light above and left of the camera, a weak one from the right, and light from all round that is
// brighter from above: both sides of a face are lit alike.
vec3 shade(vec3 albedo) {
  vec3 view = normalize(perspective ? eye - place : eye);
  vec3 flat_normal = cross(dFdx(place), dFdy(place));
  float size = length(flat_normal);
  flat_normal = size > 0.0 ? flat_normal / size : view;
  if (dot(flat_normal, view) < 0.0) flat_normal = -flat_normal;
  float length_of_normal = length(smooth_normal);
  vec3 n = length_of_normal > 1e-6 ? smooth_normal / length_of_normal : flat_normal;
  if (dot(n, flat_normal) < 0.0) n = -n;
  vec3 key = normalize(vec3(-0.45, -0.6, -1.0));
  vec3 side = normalize(vec3(0.9, -0.1, -0.5));
  float around = mix(0.10, 0.26, 0.5 - 0.5 * n.y);
  float diffuse = around + 0.86 * max(dot(n, key), 0.0) + 0.12 * max(dot(n, side), 0.0);
  float glint = 0.05 * pow(max(dot(n, normalize(key + view)), 0.0), 24.0);
  return albedo * diffuse + glint;
}
)";

constexpr const char* draw_shaded = R"(
uniform vec3 filled_color;
void main() {
  vec3 color = mix(vertex_color.rgb, filled_color, vertex_color.a);
  pixel = vec4(encode(shade(decode(color))), 1.0);
}
)";

// The texture is an sRGB one: what the sampler gives is linear already.
constexpr const char* draw_textured = R"(
uniform bool lit;
uniform bool image;
uniform vec3 flat_color;
uniform sampler2D picture;
void main() {
  vec3 albedo = image ? texture(picture, texture_place).rgb : decode(flat_color) * decode(vertex_color.rgb);
  pixel = vec4(encode(lit ? shade(albedo) : albedo), 1.0);
}
)";

GLint uniform(GLuint program, const char* name) {
  return gl_functions().GetUniformLocation(program, name);
}

void set_matrix(GLint location, const Eigen::Matrix4d& matrix) {
  const Eigen::Matrix4f floats = matrix.cast<float>();
  gl_functions().UniformMatrix4fv(location, 1, GL_FALSE, floats.data());
}

void set_vector(GLint location, const Eigen::Vector3f& vector) {
  gl_functions().Uniform3fv(location, 1, vector.data());
}

GLuint link_surface(const char* fragment) {
  return link_program(surface_vertex, (std::string(light) + fragment).c_str(),
                      {{attribute::position, "position"},
                       {attribute::normal, "normal"},
                       {attribute::color, "color"},
                       {attribute::uv, "uv"}});
}

}  // namespace

StencilPass::StencilPass()
    : program_(link_program(position_only, draw_one, {{attribute::position, "position"}})),
      clip_from_local_(uniform(program_, "clip_from_local")) {}

void StencilPass::use(const Eigen::Matrix4d& clip_from_local) const {
  gl_functions().UseProgram(program_);
  set_matrix(clip_from_local_, clip_from_local);
}

FacePass::FacePass()
    : program_(link_program(position_only, draw_face, {{attribute::position, "position"}})),
      clip_from_local_(uniform(program_, "clip_from_local")) {}

void FacePass::use(const Eigen::Matrix4d& clip_from_local) const {
  gl_functions().UseProgram(program_);
  set_matrix(clip_from_local_, clip_from_local);
}

ViewFrame::ViewFrame(const Camera& camera, const LocalFrame& local)
    : camera_from_local(camera.camera_from_world.linear().cast<float>()),
      perspective(camera.projection == Camera::Projection::perspective) {
  const Eigen::Vector3d center_in_camera = camera.camera_from_world * local.center;
  eye = perspective ? Eigen::Vector3f((-center_in_camera / local.scale).cast<float>())
                    : Eigen::Vector3f(0, 0, -1);
}

ShadedPass::ShadedPass()
    : program_(link_surface(draw_shaded)),
      clip_from_local_(uniform(program_, "clip_from_local")),
      camera_from_local_(uniform(program_, "camera_from_local")),
      eye_(uniform(program_, "eye")),
      perspective_(uniform(program_, "perspective")),
      filled_color_(uniform(program_, "filled_color")) {}

void ShadedPass::use(const Eigen::Matrix4d& clip_from_local, const ViewFrame& view,
                     const Eigen::Vector3f& filled_color) const {
  gl_functions().UseProgram(program_);
  set_matrix(clip_from_local_, clip_from_local);
  gl_functions().UniformMatrix3fv(camera_from_local_, 1, GL_FALSE, view.camera_from_local.data());
  set_vector(eye_, view.eye);
  gl_functions().Uniform1i(perspective_, view.perspective ? 1 : 0);
  set_vector(filled_color_, filled_color);
}

TexturedPass::TexturedPass()
    : program_(link_surface(draw_textured)),
      clip_from_local_(uniform(program_, "clip_from_local")),
      camera_from_local_(uniform(program_, "camera_from_local")),
      eye_(uniform(program_, "eye")),
      perspective_(uniform(program_, "perspective")),
      lit_(uniform(program_, "lit")),
      image_(uniform(program_, "image")),
      flat_color_(uniform(program_, "flat_color")) {}

void TexturedPass::use(const Eigen::Matrix4d& clip_from_local, const ViewFrame& view, bool lit) const {
  gl_functions().UseProgram(program_);
  set_matrix(clip_from_local_, clip_from_local);
  gl_functions().UniformMatrix3fv(camera_from_local_, 1, GL_FALSE, view.camera_from_local.data());
  set_vector(eye_, view.eye);
  gl_functions().Uniform1i(perspective_, view.perspective ? 1 : 0);
  gl_functions().Uniform1i(lit_, lit ? 1 : 0);
}

void TexturedPass::set_material(bool image, const Eigen::Vector3f& flat_color) const {
  gl_functions().Uniform1i(image_, image ? 1 : 0);
  set_vector(flat_color_, flat_color);
}

}  // namespace drape::rendering
