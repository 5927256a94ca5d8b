#include "drape/rendering/renderer.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <vector>

#include "clip_matrix.hpp"
#include "crease_normals.hpp"
#include "drape/base/error.hpp"
#include "face_depth.hpp"
#include "mesh_buffers.hpp"
#include "offscreen_context.hpp"
#include "passes.hpp"
#include "render_target.hpp"
#include "supersampling.hpp"
#include "windows.hpp"

namespace drape::rendering {
namespace {

const Eigen::Vector3f filled_color(0.95F, 0.55F, 0.2F);

const TriangleMesh& checked(const TriangleMesh& mesh) {
  const std::string problem = problem_of(mesh);
  if (!problem.empty()) throw input_error("the mesh cannot be drawn: {}", problem);
  return mesh;
}

std::vector<Rgba> split_colors(const TriangleMesh& mesh, const SplitVertices& split,
                               const ShadedStyle& style) {
  std::vector<Rgba> colors;
  colors.reserve(split.sources.size());
  const bool own = style.vertex_colors && !mesh.colors.empty();
  for (std::size_t i = 0; i < split.sources.size(); ++i)
    colors.push_back(to_bytes(own ? mesh.colors[split.sources[i]] : style.color,
                              style.highlight_filled && split.filled[i] != 0 ? 255 : 0));
  return colors;
}

}  // namespace

struct Renderer::Impl {
  explicit Impl(const TriangleMesh& given) : mesh(checked(given)), local(mesh) {}

  void bind_positions();
  void bind_split(const ShadedStyle& style);

  /// Draws every window of the camera's image; `use(clip_from_local)` chooses the pass, `read(window)` takes
  /// what was drawn.
  template <class Use, class Read>
  void draw(const Camera& camera, int samples, RenderTarget& target, const Eigen::Vector3f& background,
            const std::optional<DepthRange>& range, Use use, Read read) {
    for (const Window& window : windows_of(camera, samples)) {
      target.begin(window, background);
      if (range) {
        use(Eigen::Matrix4d(clip_from_world(camera, window, *range) * local.world_from_local()));
        draw_faces(0, mesh.faces.size());
      }
      read(window);
    }
  }

  TriangleMesh mesh;
  LocalFrame local;
  OffscreenContext context;
  RenderTarget coverage{RenderTarget::Kind::coverage};
  RenderTarget face_numbers{RenderTarget::Kind::faces};
  RenderTarget colors{RenderTarget::Kind::colors};
  // Made when a picture first needs them.
  std::optional<StencilPass> stencil_pass;
  std::optional<FacePass> face_pass;
  std::optional<ShadedPass> shaded_pass;
  std::optional<VertexArray> positions;
  std::optional<SplitVertices> split;
  std::optional<VertexArray> split_array;
  std::vector<Rgba> colors_in_split_array;
};

void Renderer::Impl::bind_positions() {
  if (!positions) {
    positions.emplace();
    std::vector<Eigen::Vector3f> points;
    points.reserve(mesh.vertices.size());
    for (const Eigen::Vector3d& x : mesh.vertices) points.push_back(local.from_world(x));
    positions->add(attribute::position, points);
    positions->set_faces(mesh.faces);
  }
  positions->bind();
}

void Renderer::Impl::bind_split(const ShadedStyle& style) {
  if (!split) {
    split = split_at_creases(mesh);
    split_array.emplace();
    std::vector<Eigen::Vector3f> points;
    points.reserve(split->sources.size());
    for (const std::uint32_t v : split->sources) points.push_back(local.from_world(mesh.vertices[v]));
    split_array->add(attribute::position, points);
    split_array->add(attribute::normal, split->normals);
    split_array->set_faces(split->faces);
  }
  std::vector<Rgba> wanted = split_colors(mesh, *split, style);
  if (wanted != colors_in_split_array) {
    split_array->add(attribute::color, wanted);
    colors_in_split_array = std::move(wanted);
  }
  split_array->bind();
}

Renderer::Renderer(const TriangleMesh& mesh) : impl_(std::make_unique<Impl>(mesh)) {}
Renderer::~Renderer() = default;
Renderer::Renderer(Renderer&&) noexcept = default;
Renderer& Renderer::operator=(Renderer&&) noexcept = default;

Image8 Renderer::stencil(const Camera& camera) {
  check_size(camera);
  Image8 picture(camera.width, camera.height, 1, stencil::background);
  const std::optional<DepthRange> range = depth_range(camera, impl_->local.box);
  if (!range) return picture;
  const auto current = impl_->context.make_current();
  if (!impl_->stencil_pass) impl_->stencil_pass.emplace();
  impl_->bind_positions();
  impl_->draw(
      camera, 1, impl_->coverage, Eigen::Vector3f::Zero(), range,
      [&](const Eigen::Matrix4d& clip_from_local) { impl_->stencil_pass->use(clip_from_local); },
      [&](const Window& window) { impl_->coverage.read(&picture.at(window.x, window.y), camera.width); });
  return picture;
}

DepthMap Renderer::depth_map(const Camera& camera) {
  check_size(camera);
  Image<std::int32_t> faces(camera.width, camera.height, 1, DepthMap::no_face);
  if (const std::optional<DepthRange> range = depth_range(camera, impl_->local.box)) {
    const auto current = impl_->context.make_current();
    if (!impl_->face_pass) impl_->face_pass.emplace();
    impl_->bind_positions();
    // No face is all ones, which as a signed number is no_face.
    impl_->draw(
        camera, 1, impl_->face_numbers, Eigen::Vector3f::Zero(), range,
        [&](const Eigen::Matrix4d& clip_from_local) { impl_->face_pass->use(clip_from_local); },
        [&](const Window& window) { impl_->face_numbers.read(&faces.at(window.x, window.y), camera.width); });
  }
  ImageF depth = depth_of_faces(impl_->mesh, camera, faces);
  return {std::move(depth), std::move(faces)};
}

Image8 Renderer::shaded(const Camera& camera, const ShadedStyle& style) {
  check_size(camera);
  Image8 picture(camera.width, camera.height, 3);
  const auto current = impl_->context.make_current();
  if (!impl_->shaded_pass) impl_->shaded_pass.emplace();
  impl_->bind_split(style);
  const ViewFrame view(camera, impl_->local);
  std::vector<std::uint32_t> samples;
  impl_->draw(
      camera, style.samples_per_side, impl_->colors, style.background, depth_range(camera, impl_->local.box),
      [&](const Eigen::Matrix4d& clip_from_local) {
        impl_->shaded_pass->use(clip_from_local, view, filled_color);
      },
      [&](const Window& window) {
        samples.resize(window.sample_count());
        impl_->colors.read(samples.data(), window.width * window.samples);
        average_samples(samples, window.samples, picture, window.x, window.y, window.width, window.height);
      });
  return picture;
}

}  // namespace drape::rendering
