// The second cue: whether the light on the object in the photo falls as a pose's normals would have it.
#pragma once

#include <cstddef>
#include <vector>

#include "drape/alignment/align.hpp"

namespace drape::alignment {

/// Which of `cameras`, that the outline cannot tell apart, the photo's shading speaks for; 0 unless another
/// is better beyond doubt. Brightness inside the stencil is fitted by the nine spherical harmonics of second
/// order of the normals that a camera sees (Basri and Jacobs 2003: nearly all that a matt body shows under
/// any distant light); what is compared is the likelihood of the fits, as if 200 pixels were independent.
/// `photo` is RGB at the stencil's size.
[[nodiscard]] std::size_t best_shaded(const TriangleMesh& mesh, const Image8& photo, const Image8& stencil,
                                      const std::vector<Camera>& cameras);

}  // namespace drape::alignment
