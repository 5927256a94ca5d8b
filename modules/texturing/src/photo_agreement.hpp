// Corrects cameras until the photos show the same colours at the same places of the surface.
#pragma once

#include <span>
#include <vector>

#include "drape/base/progress.hpp"
#include "drape/geometry/camera.hpp"
#include "drape/geometry/image.hpp"
#include "drape/geometry/triangle_mesh.hpp"
#include "pose_step.hpp"

namespace drape::texturing {

struct AgreementView {
  const Image8& rgb;
  const Image8& stencil;  // may be empty
  Camera camera;
  const ImageF& depth;  // of the camera, as PhotoSight's
  PoseMatrix hold;      // by the outline
};

struct AgreeingCameras {
  std::vector<Camera> cameras;   // as the views
  std::vector<double> moved_px;  // typical shift on the surface, in the photo
};

/// Colour map optimisation of Zhou and Koltun (SIGGRAPH 2014, section 4), over points spread evenly on the
/// surface: their log light is the mean over the photos that see them, and each photo's camera follows by
/// Gauss-Newton steps on its differences, in turns, on smoothed pictures first. Unlike there, points rather
/// than vertices carry the colours, each photo has its own exposure, differences are robust (Geman and
/// McClure), and the outline goes on holding the camera. Nothing changes where no photos overlap, where that
/// does not bring them closer, and for a camera that would move by more than `most_px`. The same for any
/// number of threads.
[[nodiscard]] AgreeingCameras agreeing_cameras(const TriangleMesh& mesh, std::span<const AgreementView> views,
                                               double most_px, const Progress& progress = {});

}  // namespace drape::texturing
