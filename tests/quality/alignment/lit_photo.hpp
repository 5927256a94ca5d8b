// Pictures of an object under a light that nobody knows.
#pragma once

#include <cstdint>

#include "drape/geometry/camera.hpp"
#include "drape/geometry/image.hpp"
#include "drape/geometry/triangle_mesh.hpp"

namespace drape::lab {

/// RGB. One lamp from a random side of the camera, light from all around, a highlight; smooth surfaces are
/// shaded smoothly, edges stay sharp. The object is of one grey, or has its vertex colours if `painted`; the
/// background is a ramp of another grey. 2 % of noise.
[[nodiscard]] Image8 lit_photo(const TriangleMesh& object, const Camera& camera, bool painted,
                               std::uint64_t seed);

}  // namespace drape::lab
