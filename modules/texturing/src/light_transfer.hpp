// What light from all round does at each point of a surface.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "drape/base/progress.hpp"
#include "drape/geometry/triangle_mesh.hpp"
#include "drape/rendering/renderer.hpp"
#include "surface_normals.hpp"

namespace drape::texturing {

/// Irradiance over pi of the nine lights that are real spherical harmonics up to the second order
/// (Ramamoorthi and Hanrahan, "An efficient representation for irradiance environment maps", 2001), where the
/// surface itself does not hide them (Sloan, Kautz, Snyder, "Precomputed radiance transfer", 2002); and,
/// last, of the surface that hides them, were its radiance 1: light bounced once or more.
inline constexpr int transfer_size = 10;
using Transfer = Eigen::Matrix<float, transfer_size, 1>;

/// A point on a face of the mesh.
struct SurfacePlace {
  std::uint32_t face;
  Eigen::Vector3d point;
  Eigen::Vector3d normal;  // smoothed
};

/// Transfers per vertex (per corner at creases), by shadow maps along `directions().size()` directions.
class LightTransfer {
 public:
  /// `lit_places[d][i]`: 255 times how much of direction d's light reaches places[i].
  LightTransfer(const TriangleMesh& mesh, rendering::Renderer& renderer, std::span<const SurfacePlace> places,
                const Progress& progress);

  [[nodiscard]] Transfer at(std::uint32_t face, const Eigen::Vector3d& point) const;

  /// Unit vectors, evenly spread.
  [[nodiscard]] static const std::vector<Eigen::Vector3d>& directions();
  [[nodiscard]] const std::vector<std::vector<std::uint8_t>>& lit_places() const { return lit_places_; }

 private:
  const TriangleMesh& mesh_;
  std::vector<std::array<std::uint32_t, 3>> corner_entries_;  // per face
  std::vector<Transfer> entries_;
  std::vector<std::vector<std::uint8_t>> lit_places_;
};

}  // namespace drape::texturing
