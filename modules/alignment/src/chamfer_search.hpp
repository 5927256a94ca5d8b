// Views of a mesh in an outline that is wrong in part.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "outline_mesh.hpp"
#include "stencil_level.hpp"
#include "view_atlas.hpp"

namespace drape::alignment {

/// A view, turned by `angle` from x towards y, enlarged and put somewhere: a point x of the unit sphere's
/// view is seen at scale * rotated(x) + shift, in the window's pixels.
struct ChamferMatch {
  double score = 0;  // 0..1
  std::size_t view = 0;
  double angle = 0;  // radians
  double scale = 1;
  Eigen::Vector2d shift = Eigen::Vector2d::Zero();
};

/// Where the views' outlines run along the photo's for as much of their lengths as possible, the best first;
/// many are versions of each other. What a bad segmentation cuts off or adds lies on one side of the object:
/// the others still touch what bounds the object there. So every view and roll is placed by three sides of a
/// bounding box, turned by steps of 45 degrees, and by two sides with the size that the area allows. Each
/// place is judged by both outlines' truncated distances to each other in eight directions (Shotton, Blake
/// and Cipolla 2008), and the best are moved until that is as good as it gets nearby.
[[nodiscard]] std::vector<ChamferMatch> chamfer_matches(const OutlineMesh& mesh,
                                                        const std::vector<AtlasView>& views,
                                                        const StencilLevel& photo, std::size_t most);

}  // namespace drape::alignment
