#include "drape/metrics/image_error.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "drape/base/error.hpp"

namespace drape::metrics {
namespace {

void require_alike(const Image8& first, const Image8& second, const Image8& mask) {
  if (first.width() != second.width() || first.height() != second.height() ||
      first.channels() != second.channels())
    throw input_error("cannot compare pictures of {} x {} x {} and {} x {} x {} values", first.width(),
                      first.height(), first.channels(), second.width(), second.height(), second.channels());
  if (!mask.empty() &&
      (mask.channels() != 1 || mask.width() != first.width() || mask.height() != first.height()))
    throw input_error("the mask of pictures of {} x {} pixels has {} x {} pixels and {} channels",
                      first.width(), first.height(), mask.width(), mask.height(), mask.channels());
}

bool chosen(const Image8& mask, int x, int y) {
  return mask.empty() || mask.at(x, y) == stencil::object;
}

double luma(const Image8& image, int x, int y) {
  if (image.channels() < 3) return image.at(x, y);
  return 0.299 * image.at(x, y, 0) + 0.587 * image.at(x, y, 1) + 0.114 * image.at(x, y, 2);
}

// Gaussian sums of what the mask keeps.
cv::Mat window_sums(const cv::Mat& values) {
  cv::Mat sums;
  cv::GaussianBlur(values, sums, cv::Size(11, 11), 1.5, 1.5, cv::BORDER_CONSTANT);
  return sums;
}

double similarity(double mean_a, double mean_b, double variance_a, double variance_b, double covariance) {
  constexpr double c1 = (0.01 * 255) * (0.01 * 255);
  constexpr double c2 = (0.03 * 255) * (0.03 * 255);
  // Wang et al. 2004, equation 13.
  return (2 * mean_a * mean_b + c1) * (2 * covariance + c2) /
         ((mean_a * mean_a + mean_b * mean_b + c1) * (variance_a + variance_b + c2));
}

}  // namespace

namespace {

// Sums over one window's pixels, for the factor and the error that is left: the truth's squares less what the
// best multiple of the other picture explains.
struct WindowSums {
  double truth = 0;
  double made = 0;
  double both = 0;
  [[nodiscard]] double error() const { return made > 0 ? truth - both * both / made : truth; }
};

double linear_light(std::uint8_t stored) {
  const double s = stored / 255.0;
  return s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4);
}

}  // namespace

std::optional<double> local_albedo_error(const Image8& made, const Image8& truth, const Image8& mask,
                                         int window_px) {
  require_alike(made, truth, mask);
  if (window_px < 2) throw input_error("a window of {} pixels is too small to compare in", window_px);
  double error = 0;
  double all = 0;
  for (int top = 0; top < made.height(); top += window_px / 2)
    for (int left = 0; left < made.width(); left += window_px / 2)
      for (int c = 0; c < made.channels(); ++c) {
        WindowSums sums;
        for (int y = top; y < std::min(made.height(), top + window_px); ++y)
          for (int x = left; x < std::min(made.width(), left + window_px); ++x) {
            if (!chosen(mask, x, y)) continue;
            const double t = linear_light(truth.at(x, y, c));
            const double m = linear_light(made.at(x, y, c));
            sums.truth += t * t;
            sums.made += m * m;
            sums.both += t * m;
          }
        error += sums.error();
        all += sums.truth;
      }
  if (!(all > 0)) return std::nullopt;
  return error / all;
}

std::optional<double> psnr_db(const Image8& first, const Image8& second, const Image8& mask) {
  require_alike(first, second, mask);
  double squares = 0;
  std::size_t values = 0;
  for (int y = 0; y < first.height(); ++y)
    for (int x = 0; x < first.width(); ++x) {
      if (!chosen(mask, x, y)) continue;
      for (int c = 0; c < first.channels(); ++c) {
        const double difference = static_cast<double>(first.at(x, y, c)) - second.at(x, y, c);
        squares += difference * difference;
        ++values;
      }
    }
  if (values == 0) return std::nullopt;
  if (squares == 0) return std::numeric_limits<double>::infinity();
  return 10 * std::log10(255.0 * 255.0 * static_cast<double>(values) / squares);
}

std::optional<double> ssim(const Image8& first, const Image8& second, const Image8& mask) {
  require_alike(first, second, mask);
  if (first.empty()) return std::nullopt;
  cv::Mat weight(first.height(), first.width(), CV_64F);
  cv::Mat a(weight.size(), CV_64F);
  cv::Mat b(weight.size(), CV_64F);
  for (int y = 0; y < first.height(); ++y)
    for (int x = 0; x < first.width(); ++x) {
      const double kept = chosen(mask, x, y) ? 1.0 : 0.0;
      weight.at<double>(y, x) = kept;
      a.at<double>(y, x) = kept * luma(first, x, y);
      b.at<double>(y, x) = kept * luma(second, x, y);
    }
  const cv::Mat weights = window_sums(weight);
  const cv::Mat sum_a = window_sums(a);
  const cv::Mat sum_b = window_sums(b);
  const cv::Mat sum_aa = window_sums(a.mul(a));
  const cv::Mat sum_bb = window_sums(b.mul(b));
  const cv::Mat sum_ab = window_sums(a.mul(b));

  double total = 0;
  std::size_t pixels = 0;
  for (int y = 0; y < first.height(); ++y)
    for (int x = 0; x < first.width(); ++x) {
      if (!chosen(mask, x, y)) continue;
      const double w = weights.at<double>(y, x);
      const double mean_a = sum_a.at<double>(y, x) / w;
      const double mean_b = sum_b.at<double>(y, x) / w;
      total += similarity(mean_a, mean_b, sum_aa.at<double>(y, x) / w - mean_a * mean_a,
                          sum_bb.at<double>(y, x) / w - mean_b * mean_b,
                          sum_ab.at<double>(y, x) / w - mean_a * mean_b);
      ++pixels;
    }
  if (pixels == 0) return std::nullopt;
  return total / static_cast<double>(pixels);
}

}  // namespace drape::metrics
