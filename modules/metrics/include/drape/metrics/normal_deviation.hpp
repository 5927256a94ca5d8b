// How much the orientation of one surface differs from another's.
#pragma once

#include <cstddef>
#include <cstdint>

#include "drape/geometry/triangle_mesh.hpp"
#include "drape/metrics/distribution.hpp"

namespace drape::metrics {

struct NormalDeviation {
  Distribution angle_deg;  // 0..180, between the normals of the two faces
  double flipped_percent =
      0;  // share of the samples with more than 90 degrees: faces that look the other way
};

/// At area-uniform samples of `from`: the angle between its face's normal and that of the nearest face of
/// `to`. Error{input} if either mesh breaks its promises or has no area, or for samples == 0.
[[nodiscard]] NormalDeviation normal_deviation(const TriangleMesh& from, const TriangleMesh& to,
                                               std::size_t samples = 100'000, std::uint64_t seed = 1);

}  // namespace drape::metrics
