// GrabCut: region colours and a minimum cut, started from a first guess.
#pragma once

#include <array>
#include <cstdint>

#include "hints.hpp"

namespace drape::segmentation {

/// `guess`: stencil::object or background per pixel, some of each. What lies outside the box of the hints
/// stays background; the clicked pixel is object, what is scribbled on is what the scribble says. Returns a
/// stencil of the same size. Rother, Kolmogorov, Blake, "GrabCut" (SIGGRAPH 2004), by OpenCV.
[[nodiscard]] Image8 grabcut(const Image8& rgb, const Image8& guess, const Hints& hints, std::uint64_t seed);

/// The whole picture less 6 % a side.
[[nodiscard]] std::array<int, 4> inset_box(int width, int height);

/// Object within the ellipse that fills the box (left, top, right, bottom), background outside.
[[nodiscard]] Image8 elliptic_guess(int width, int height, const std::array<int, 4>& box);

}  // namespace drape::segmentation
