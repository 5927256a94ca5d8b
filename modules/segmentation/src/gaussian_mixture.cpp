#include "gaussian_mixture.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <opencv2/ml.hpp>
#include <set>

#include "drape/base/random.hpp"
#include "pixel_features.hpp"
#include "texture_features.hpp"

namespace drape::segmentation {
namespace {

constexpr int feature_count = 8;
constexpr int sample_pixels = 6000;  // that the mixture is fitted to
constexpr int most_components = 8;
constexpr double texture_scale = 50;  // half of black against white
constexpr double smoothing_px = 1.5;  // of the colours, so that texture does not count twice
// A component narrower than this is noise of one flat area: it would win every comparison of likelihoods.
constexpr double least_deviation = 2;

cv::Mat features_of(const ImageF& lab, double position_weight) {
  const cv::Mat colors(lab.height(), lab.width(), CV_32FC3, const_cast<float*>(lab.data().data()));
  cv::Mat smooth;
  cv::GaussianBlur(colors, smooth, {}, smoothing_px, smoothing_px, cv::BORDER_REFLECT_101);
  const ImageF texture = texture_features(lab);
  const double scale = position_scale(lab, position_weight);
  cv::Mat features(lab.width() * lab.height(), feature_count, CV_64F);
  for (int y = 0; y < lab.height(); ++y)
    for (int x = 0; x < lab.width(); ++x) {
      auto* row = features.ptr<double>(y * lab.width() + x);
      for (int c = 0; c < 3; ++c) {
        row[c] = static_cast<double>(smooth.at<cv::Vec3f>(y, x)[c]);
        row[3 + c] = texture_scale * static_cast<double>(texture.at(x, y, c));
      }
      row[6] = scale * x;
      row[7] = scale * y;
    }
  return features;
}

cv::Mat sampled(const cv::Mat& features, Rng& rng) {
  if (features.rows <= sample_pixels) return features.clone();
  cv::Mat sample(sample_pixels, features.cols, CV_64F);
  for (int i = 0; i < sample.rows; ++i)
    features.row(static_cast<int>(rng.below(static_cast<std::uint64_t>(features.rows))))
        .copyTo(sample.row(i));
  return sample;
}

// Noise as wide as the least deviation keeps every covariance away from zero.
void widen(cv::Mat& sample, Rng& rng) {
  for (int i = 0; i < sample.rows; ++i)
    for (int c = 0; c < sample.cols; ++c) sample.at<double>(i, c) += least_deviation * rng.normal();
}

struct Mixture {
  cv::Ptr<cv::ml::EM> model;
  double description_length = 0;  // -log likelihood + half a log n for each parameter
};

Mixture fitted(const cv::Mat& sample, int k, std::uint64_t seed) {
  Mixture mixture;
  mixture.model = cv::ml::EM::create();
  mixture.model->setClustersNumber(k);
  mixture.model->setCovarianceMatrixType(cv::ml::EM::COV_MAT_DIAGONAL);
  mixture.model->setTermCriteria({cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 60, 1e-4});
  cv::Mat likelihoods;
  cv::theRNG().state = seed | 1U;  // of the k-means that it starts from
  mixture.model->trainEM(sample, likelihoods);
  const double parameters = k * (2 * feature_count) + k - 1;
  mixture.description_length = -cv::sum(likelihoods)[0] + 0.5 * parameters * std::log(sample.rows);
  return mixture;
}

}  // namespace

Labels mixture_clusters(const ImageF& lab, std::optional<int> clusters, double position_weight,
                        std::uint64_t seed) {
  const cv::Mat features = features_of(lab, position_weight);
  Rng rng(item_seed(seed, 0));
  cv::Mat sample = sampled(features, rng);
  widen(sample, rng);
  const int most = std::min(clusters.value_or(most_components), sample.rows);
  Labels labels(lab.width(), lab.height(), 1, 0);
  if (most < 2) return labels;
  Mixture best = fitted(sample, clusters ? most : 2, item_seed(seed, 1));
  for (int k = 3; !clusters && k <= most; ++k) {
    Mixture other = fitted(sample, k, item_seed(seed, 1));
    if (other.description_length < best.description_length) best = std::move(other);
  }
  cv::Mat probabilities;
  best.model->predict(features, probabilities);
  for (int i = 0; i < features.rows; ++i) {
    const auto* row = probabilities.ptr<double>(i);
    labels.data()[static_cast<std::size_t>(i)] =
        static_cast<std::int32_t>(std::max_element(row, row + probabilities.cols) - row);
  }
  return labels;
}

}  // namespace drape::segmentation
