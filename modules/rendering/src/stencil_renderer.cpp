#include "drape/rendering/stencil_renderer.hpp"

#include <cassert>
#include <optional>
#include <vector>

#include "clip_matrix.hpp"
#include "drape/base/error.hpp"
#include "drape/geometry/mesh_topology.hpp"
#include "mesh_buffers.hpp"
#include "offscreen_context.hpp"
#include "passes.hpp"
#include "render_target.hpp"
#include "windows.hpp"

namespace drape::rendering {
namespace {

// What is drawn needs to stay, what only stays with the mesh does not: no copy of the mesh is kept.
struct Resources {
  StencilPass pass;
  VertexArray positions;
};

bool wholly_in_front(const Camera& camera, const BoundingBox& box, const DepthRange& range) {
  if (camera.projection == Camera::Projection::orthographic) return true;
  for (int i = 0; i < 8; ++i)
    if ((camera.camera_from_world * box.corner(static_cast<BoundingBox::CornerType>(i))).z() <= range.nearest)
      return false;
  return true;
}

}  // namespace

struct StencilRenderer::Impl {
  Impl(const TriangleMesh& mesh, int width, int height)
      : local(mesh),
        faces(mesh.faces.size()),
        closed(mesh_topology(mesh).closed_manifold()),
        picture(width, height, 1, stencil::background) {
    const auto current = context.make_current();
    resources.emplace();
    std::vector<Eigen::Vector3f> points;
    points.reserve(mesh.vertices.size());
    for (const Eigen::Vector3d& x : mesh.vertices) points.push_back(local.from_world(x));
    resources->positions.add(attribute::position, points);
    resources->positions.set_faces(mesh.faces);
  }

  LocalFrame local;
  std::size_t faces;
  bool closed;
  Image8 picture;
  OffscreenContext context;
  RenderTarget coverage{RenderTarget::Kind::coverage};
  std::optional<Resources> resources;
};

StencilRenderer::StencilRenderer(const TriangleMesh& mesh, int width, int height) {
  const std::string problem = problem_of(mesh);
  if (!problem.empty()) throw input_error("the mesh cannot be drawn: {}", problem);
  if (width < 1 || height < 1 || width > most_buffer_side || height > most_buffer_side)
    throw input_error("cannot draw a stencil of {} x {} pixels; each side must be within 1 and {}", width,
                      height, most_buffer_side);
  impl_ = std::make_unique<Impl>(mesh, width, height);
}

StencilRenderer::~StencilRenderer() = default;
StencilRenderer::StencilRenderer(StencilRenderer&&) noexcept = default;
StencilRenderer& StencilRenderer::operator=(StencilRenderer&&) noexcept = default;

const Image8& StencilRenderer::draw(const Camera& camera) {
  Impl& impl = *impl_;
  assert(camera.width == impl.picture.width() && camera.height == impl.picture.height());
  const auto current = impl.context.make_current();
  impl.coverage.begin({0, 0, camera.width, camera.height, 1});
  if (const std::optional<DepthRange> range = depth_range(camera, impl.local.box)) {
    const GlFunctions& gl = gl_functions();
    // A closed surface covers a pixel as often with its front as with its back. Which of the two OpenGL takes
    // for the front does not matter.
    if (impl.closed && wholly_in_front(camera, impl.local.box, *range)) {
      gl.Enable(GL_CULL_FACE);
      gl.CullFace(GL_BACK);
    }
    impl.resources->pass.use(clip_from_world(camera, {0, 0, camera.width, camera.height, 1}, *range) *
                             impl.local.world_from_local());
    impl.resources->positions.bind();
    draw_faces(0, impl.faces);
  }
  impl.coverage.read(impl.picture.data().data(), camera.width);
  return impl.picture;
}

}  // namespace drape::rendering
