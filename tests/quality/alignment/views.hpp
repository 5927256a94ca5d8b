// Random cameras before an object, and how far a found one is from the true one.
#pragma once

#include <cstdint>

#include "drape/geometry/camera.hpp"
#include "drape/metrics/camera_error.hpp"
#include "models.hpp"

namespace drape::lab {

struct Lens {
  Camera::Projection projection = Camera::Projection::perspective;
  double least_fov_deg = 20;  // horizontal
  double most_fov_deg = 60;
};

inline constexpr int photo_px = 512;  // width and height of the simulated photos

/// Any rotation; the object off the middle of the picture, its bounding sphere over half to 0.9 of its
/// height; a field of view within the lens's. `off_center`: the principal point away from the picture's
/// middle by this share of its width, in a random direction, as in a cropped photo.
[[nodiscard]] Camera random_view(const Ball& ball, const Lens& lens, std::uint64_t seed,
                                 double off_center = 0);

/// The error modulo the turns that map the object onto itself: the least over them. A mirror symmetry is no
/// such turn: the mirrored pose shows the object from another side.
[[nodiscard]] metrics::CameraError error_modulo_symmetry(const Camera& found, const Camera& truth,
                                                         const Model& model);

}  // namespace drape::lab
