// Bodies without symmetry, and photos of them, that several tests of alignment share.
#pragma once

#include <cstdint>

#include "drape/geometry/camera.hpp"
#include "drape/geometry/image.hpp"
#include "drape/geometry/triangle_mesh.hpp"

namespace drape::alignment {

/// A brick with a knob on one corner and a plate on one side: no rotation or reflection maps it to itself.
[[nodiscard]] TriangleMesh knobbed_brick();

/// Sees the body turned by `euler_deg` (about x, then y, then z of the camera), middle at (cx, cy), the unit
/// length `unit_px` long, with a horizontal field of view of 45 degrees.
[[nodiscard]] Camera view_of(const Eigen::Vector3d& euler_deg, double unit_px = 34, double cx = 85,
                             double cy = 57, Camera::Projection projection = Camera::Projection::perspective,
                             double fov_deg = 45);

[[nodiscard]] Image8 stencil_of(const TriangleMesh& mesh, const Camera& camera);

/// The mesh, matt and grey, under a lamp from above on the left; RGB.
[[nodiscard]] Image8 lit_photo(const TriangleMesh& mesh, const Camera& camera);

/// The outline of `stencil` waves by up to `amplitude` pixels along x.
[[nodiscard]] Image8 wavy(const Image8& stencil, double amplitude);

[[nodiscard]] double rotation_between_deg(const Camera& a, const Camera& b);

}  // namespace drape::alignment
