#include <Eigen/Geometry>
#include <algorithm>
#include <numeric>
#include <vector>

#include "clip_matrix.hpp"
#include "crease_normals.hpp"
#include "drape/base/error.hpp"
#include "drape/rendering/renderer.hpp"
#include "mesh_buffers.hpp"
#include "offscreen_context.hpp"
#include "passes.hpp"
#include "render_target.hpp"
#include "supersampling.hpp"
#include "windows.hpp"

namespace drape::rendering {
namespace {

void check_model(const TexturedMesh& model) {
  const std::string problem = problem_of(model.mesh);
  if (!problem.empty()) throw input_error("the textured model cannot be drawn: {}", problem);
  const std::size_t faces = model.mesh.faces.size();
  if (model.corner_uvs.size() != faces || model.face_materials.size() != faces)
    throw input_error(
        "the textured model cannot be drawn: it has {} faces, but texture coordinates of {} and "
        "materials of {}",
        faces, model.corner_uvs.size(), model.face_materials.size());
  for (const std::uint32_t material : model.face_materials)
    if (material >= model.materials.size())
      throw input_error("the textured model cannot be drawn: a face names material {}, but there are only {}",
                        material, model.materials.size());
  for (const Material& material : model.materials) {
    const Image8& image = material.image;
    if (!image.empty() && (image.channels() != 3 || image.width() > most_side || image.height() > most_side))
      throw input_error(
          "the textured model cannot be drawn: the image of material {} has {} channels and "
          "{} x {} pixels; it must have 3 and at most {} a side",
          material.name, image.channels(), image.width(), image.height(), most_side);
  }
}

// Faces grouped by material, so that each material is one draw call.
struct MaterialRuns {
  std::vector<std::uint32_t> faces;  // in the order in which they are drawn
  std::vector<std::size_t> begins;   // per material, and the end
};

MaterialRuns sort_by_material(const TexturedMesh& model) {
  MaterialRuns runs;
  runs.faces.resize(model.mesh.faces.size());
  std::iota(runs.faces.begin(), runs.faces.end(), 0U);
  std::stable_sort(runs.faces.begin(), runs.faces.end(), [&](std::uint32_t a, std::uint32_t b) {
    return model.face_materials[a] < model.face_materials[b];
  });
  runs.begins.assign(model.materials.size() + 1, 0);
  for (const std::uint32_t material : model.face_materials) ++runs.begins[material + 1];
  std::partial_sum(runs.begins.begin(), runs.begins.end(), runs.begins.begin());
  return runs;
}

// Texture coordinates belong to corners, so every corner is a vertex of its own.
void add_corners(const TexturedMesh& model, const LocalFrame& local, const MaterialRuns& runs,
                 VertexArray& array) {
  const TriangleMesh& mesh = model.mesh;
  const SplitVertices split = split_at_creases(mesh);
  std::vector<Eigen::Vector3f> points;
  std::vector<Eigen::Vector3f> normals;
  std::vector<Eigen::Vector2f> uvs;
  std::vector<Rgba> colors;
  std::vector<Face> faces;
  for (const std::uint32_t f : runs.faces) {
    const auto first = static_cast<std::uint32_t>(points.size());
    faces.push_back({first, first + 1, first + 2});
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t v = mesh.faces[f][k];
      points.push_back(local.from_world(mesh.vertices[v]));
      normals.push_back(split.normals[split.faces[f][k]]);
      uvs.push_back(model.corner_uvs[f][k]);
      colors.push_back(to_bytes(mesh.colors.empty() ? Eigen::Vector3f::Ones() : mesh.colors[v], 255));
    }
  }
  array.add(attribute::position, points);
  array.add(attribute::normal, normals);
  array.add(attribute::uv, uvs);
  array.add(attribute::color, colors);
  array.set_faces(faces);
}

// 0 for a material without an image. Texture row 0 is the image's top row, so v downwards needs no flip.
GLuint upload_texture(const Material& material) {
  if (material.image.empty()) return 0;
  const GlFunctions& gl = gl_functions();
  GLuint texture = 0;
  gl.GenTextures(1, &texture);
  gl.BindTexture(GL_TEXTURE_2D, texture);
  gl.PixelStorei(GL_UNPACK_ALIGNMENT, 1);
  gl.TexImage2D(GL_TEXTURE_2D, 0, GL_SRGB8, material.image.width(), material.image.height(), 0, GL_RGB,
                GL_UNSIGNED_BYTE, material.image.data().data());
  gl.GenerateMipmap(GL_TEXTURE_2D);
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  if (gl.GetError() != GL_NO_ERROR)
    throw Error(ErrorCode::try_again, "no memory for the image of material " + material.name);
  return texture;
}

}  // namespace

Image8 render_textured(const TexturedMesh& model, const Camera& camera, const TexturedStyle& style) {
  check_model(model);
  check_size(camera);
  const LocalFrame local(model.mesh);
  const MaterialRuns runs = sort_by_material(model);
  OffscreenContext context;
  const auto current = context.make_current();
  const TexturedPass pass;
  VertexArray array;
  add_corners(model, local, runs, array);
  std::vector<GLuint> textures;
  for (const Material& material : model.materials) textures.push_back(upload_texture(material));

  const GlFunctions& gl = gl_functions();
  const std::optional<DepthRange> range = depth_range(camera, local.box);
  const ViewFrame view(camera, local);
  RenderTarget target(RenderTarget::Kind::colors);
  Image8 picture(camera.width, camera.height, 3);
  std::vector<std::uint32_t> samples;
  for (const Window& window : windows_of(camera, style.samples_per_side)) {
    target.begin(window, style.background);
    if (range) {
      pass.use(clip_from_world(camera, window, *range) * local.world_from_local(), view, style.lit);
      array.bind();
      for (std::size_t m = 0; m < model.materials.size(); ++m) {
        gl.BindTexture(GL_TEXTURE_2D, textures[m]);
        pass.set_material(textures[m] != 0, model.materials[m].flat_color);
        draw_faces(runs.begins[m], runs.begins[m + 1] - runs.begins[m]);
      }
    }
    samples.resize(window.sample_count());
    target.read(samples.data(), window.width * window.samples);
    average_samples(samples, window.samples, picture, window.x, window.y, window.width, window.height);
  }
  return picture;
}

}  // namespace drape::rendering
