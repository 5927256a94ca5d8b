#include "kmeans_clusters.hpp"

#include <algorithm>
#include <array>
#include <opencv2/core.hpp>
#include <set>

#include "clusters.hpp"
#include "drape/base/random.hpp"
#include "pixel_features.hpp"

namespace drape::segmentation {
namespace {

constexpr int sample_pixels = 4000;  // enough to choose their number

// Rows of L, a, b, x, y.
cv::Mat features_of(const ImageF& lab, double position_weight) {
  cv::Mat features(lab.width() * lab.height(), color_position_count, CV_32F);
  const auto scale = static_cast<float>(position_scale(lab, position_weight));
  for (int y = 0; y < lab.height(); ++y)
    for (int x = 0; x < lab.width(); ++x) {
      auto* row = features.ptr<float>(y * lab.width() + x);
      for (int c = 0; c < 3; ++c) row[c] = lab.at(x, y, c);
      row[3] = scale * static_cast<float>(x);
      row[4] = scale * static_cast<float>(y);
    }
  return features;
}

int distinct_rows(const cv::Mat& features, int enough) {
  std::set<std::array<float, color_position_count>> seen;
  for (int i = 0; i < features.rows && static_cast<int>(seen.size()) < enough; ++i) {
    std::array<float, color_position_count> row{};
    std::copy_n(features.ptr<float>(i), color_position_count, row.begin());
    seen.insert(row);
  }
  return static_cast<int>(seen.size());
}

// The sum of squared distances to the centres; labels are written.
double cluster(const cv::Mat& features, int k, int attempts, std::uint64_t seed, cv::Mat& labels) {
  cv::theRNG().state = seed | 1U;
  const cv::TermCriteria until(cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 40, 0.1);
  return cv::kmeans(features, k, labels, until, attempts, cv::KMEANS_PP_CENTERS);
}

double scatter(const cv::Mat& features) {
  double sum = 0;
  for (int c = 0; c < features.cols; ++c) {
    cv::Scalar mean;
    cv::Scalar deviation;
    cv::meanStdDev(features.col(c), mean, deviation);
    sum += deviation[0] * deviation[0] * features.rows;
  }
  return sum;
}

int automatic_count(const cv::Mat& features, std::uint64_t seed) {
  Rng rng(seed);
  cv::Mat sample(std::min(features.rows, sample_pixels), color_position_count, CV_32F);
  for (int i = 0; i < sample.rows; ++i) {
    const auto chosen = rng.below(static_cast<std::uint64_t>(features.rows));
    features.row(features.rows <= sample_pixels ? i : static_cast<int>(chosen)).copyTo(sample.row(i));
  }
  const double total = scatter(sample);
  const int most = std::min(most_automatic_clusters, distinct_rows(sample, most_automatic_clusters));
  for (int k = 2; k < most; ++k) {
    cv::Mat labels;
    if (cluster(sample, k, 1, seed, labels) <= (1 - explained_share) * total) return k;
  }
  return std::max(1, most);
}

}  // namespace

Labels kmeans_clusters(const ImageF& lab, std::optional<int> clusters, double position_weight,
                       std::uint64_t seed) {
  const cv::Mat features = features_of(lab, position_weight);
  const int wanted = clusters ? *clusters : automatic_count(features, item_seed(seed, 0));
  const int k = std::max(1, std::min(wanted, distinct_rows(features, wanted)));
  Labels labels(lab.width(), lab.height(), 1, 0);
  if (k == 1) return labels;
  cv::Mat found;
  cluster(features, k, 3, item_seed(seed, 1), found);
  std::copy_n(found.ptr<std::int32_t>(), labels.data().size(), labels.data().begin());
  return labels;
}

}  // namespace drape::segmentation
