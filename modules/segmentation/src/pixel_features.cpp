#include "pixel_features.hpp"

#include <algorithm>
#include <vector>

#include "superpixels.hpp"

namespace drape::segmentation {

double position_scale(const ImageF& lab, double position_weight) {
  return 100.0 * position_weight / std::max(lab.width(), lab.height());
}

Patches patches_of(const ImageF& lab, double position_weight, int count) {
  Patches p;
  p.labels = superpixels(lab, count);
  const auto n = 1 + *std::max_element(p.labels.data().begin(), p.labels.data().end());
  const double scale = position_scale(lab, position_weight);
  const auto feature = [&](int x, int y) {
    Eigen::Matrix<double, 1, color_position_count> row;
    row << lab.at(x, y, 0), lab.at(x, y, 1), lab.at(x, y, 2), scale * x, scale * y;
    return row;
  };
  p.mean = Eigen::MatrixXd::Zero(n, color_position_count);
  p.pixels = Eigen::VectorXd::Zero(n);
  for (int y = 0; y < lab.height(); ++y)
    for (int x = 0; x < lab.width(); ++x) {
      p.mean.row(p.labels.at(x, y)) += feature(x, y);
      p.pixels[p.labels.at(x, y)] += 1;
    }
  p.mean.array().colwise() /= p.pixels.array();
  for (int y = 0; y < lab.height(); ++y)
    for (int x = 0; x < lab.width(); ++x)
      p.scatter_within += (feature(x, y) - p.mean.row(p.labels.at(x, y))).squaredNorm();
  return p;
}

Labels spread(const std::vector<int>& cluster_of_patch, const Labels& patches) {
  Labels out = patches;
  for (std::int32_t& label : out.data()) label = cluster_of_patch[static_cast<std::size_t>(label)];
  return out;
}

}  // namespace drape::segmentation
