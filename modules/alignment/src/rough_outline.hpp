// The last step of an alignment by a stencil: what noise or symmetry leaves open, the photo's inside tells.
#pragma once

#include <optional>
#include <vector>

#include "drape/base/progress.hpp"
#include "noisy_outline.hpp"
#include "photo_plane.hpp"
#include "stencil_evidence.hpp"
#include "surface_light.hpp"

namespace drape::alignment {

struct PhotoInside {
  const Image8& rgb;
  const PhotoPlane& plane;
  const std::vector<Eigen::Vector3f>& colors;  // of the mesh's vertices, or empty
};

/// Where the outline is smooth the best pose is fitted to its pixels; of several that fit nearly as well each
/// is moved by the photo's inside, which then tells them apart. Where it is rough, each is settled with
/// weights that fit the noise, and then by the photo's inside as well, if that is given and makes both more
/// likely. Sorted anew, by agreements whose inliers allow for the noise.
struct SettledPoses {
  std::vector<RefinedPose> poses;
  OutlineNoise noise;   // about the best pose
  bool smooth = false;  // the best pose, and what scores nearly as well, were fitted to the pixels
  bool shaded = false;  // the photo's inside had a say in the best pose
  std::optional<ShadingFit> inside;  // about the best pose; nothing where nobody asked
};
[[nodiscard]] SettledPoses settled_poses(const std::vector<RefinedPose>& poses, const OutlineMesh& mesh,
                                         const StencilEvidence& evidence, const LensPrior& lens,
                                         const std::optional<PhotoInside>& photo, const Progress& progress);

}  // namespace drape::alignment
