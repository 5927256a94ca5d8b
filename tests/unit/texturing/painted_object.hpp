// Objects of a known colour everywhere, photographed by known cameras.
#pragma once

#include <Eigen/Core>
#include <functional>

#include "drape/geometry/camera.hpp"
#include "drape/geometry/image.hpp"
#include "drape/geometry/textured_mesh.hpp"
#include "drape/geometry/triangle_mesh.hpp"
#include "drape/texturing/texture_mesh.hpp"

namespace drape::texturing {

/// Stored RGB 0..255 of a point in space.
using Paint = std::function<Eigen::Vector3d(const Eigen::Vector3d&)>;

/// Blue and green waves of about `wavelength`; red stays under 60.
[[nodiscard]] Paint waves(double wavelength);

/// What no object is painted with: a leak of it onto a model is background.
inline const Eigen::Vector3d background_color(255, 0, 255);

struct Shot {
  Image8 photo;
  Image8 stencil;
  Camera camera;
  [[nodiscard]] TextureView view(const std::string& name = "000_color") const {
    return {photo, camera, stencil, name};
  }
};

/// Each pixel shows the paint at the point its centre sees.
[[nodiscard]] Shot photographed(const TriangleMesh& mesh, const Camera& camera, const Paint& paint);

/// The material's colour (stored, 0..255) at a texture coordinate, bilinear, clamped at the border.
[[nodiscard]] Eigen::Vector3d sampled(const Image8& image, const Eigen::Vector2d& uv);

/// Whether the face is painted from a photo.
[[nodiscard]] bool is_painted(const TexturedMesh& model, std::size_t face);

/// Largest difference (any channel, stored 0..255) between the model and the paint, at points spread over the
/// painted faces for which `counts` holds.
[[nodiscard]] double largest_error(const TexturedMesh& model, const Paint& paint,
                                   const std::function<bool(const Eigen::Vector3d&)>& counts);

/// The least "distance from background colour" over points spread over all painted faces.
[[nodiscard]] double least_distance_to(const TexturedMesh& model, const Eigen::Vector3d& color);

/// Mean difference (largest channel, stored 0..255) between the two sides of edges that are seams: painted on
/// both sides, from elsewhere in the images or from different ones.
[[nodiscard]] double mean_step_across_seams(const TexturedMesh& model);

[[nodiscard]] double painted_area(const TexturedMesh& model);

/// Empty if texture coordinates, materials and attributes are as TexturedMesh promises.
[[nodiscard]] std::string problem_of_model(const TexturedMesh& model);

}  // namespace drape::texturing
