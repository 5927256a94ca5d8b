#include "outline_figures.hpp"

#include <algorithm>

#include "outline_misfit.hpp"
#include "surface_view.hpp"

namespace drape::alignment {

OutlineFigures outline_figures(const OutlineMesh& mesh, const OutlinePose& pose,
                               const StencilEvidence& evidence, const OutlineNoise& noise, double object_px) {
  constexpr double bridge = 0.04;  // of the object
  const int last = evidence.levels() - 1;
  const double px = evidence.window(last).px_per_photo_px;
  OutlineFigures figures;
  figures.object_px = object_px;
  figures.noise_px = noise.sigma_px / px;
  figures.correlation_px = noise.correlation_px / px;
  OutlineDrawing drawing;
  drawing.draw(mesh, pose, evidence.window(last));
  const OutlineMisfit misfit =
      outline_misfit(evidence.pieces(drawing, last, most_noise_reach_px, inlier_px(noise)),
                     std::max(4.0, bridge * figures.object_px * px));
  figures.fits = misfit.fits;
  figures.largest_gap = misfit.largest_gap;
  figures.inner_side = inner_side_share(mesh, pose, evidence.window(last));
  return figures;
}

}  // namespace drape::alignment
