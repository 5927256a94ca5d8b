#include "drape/report/overlay_picture.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "color.hpp"
#include "drape/base/error.hpp"
#include "drape/base/parallel.hpp"

namespace drape::report {
namespace {

// Okabe and Ito's orange and sky blue, a little stronger to stand out from a photo.
const Eigen::Vector3f orange(1.0F, 0.62F, 0.0F);
const Eigen::Vector3f blue(0.16F, 0.62F, 1.0F);
constexpr float tint_share = 0.55F;
constexpr float dimmed_light = 0.22F;  // of the light outside the object
constexpr float halo_share = 0.6F;     // how dark the rim is that sets a line apart from a bright photo

void require_size(const Image8& stencil, const Image8& photo, std::string_view which) {
  if (stencil.empty()) return;
  if (stencil.channels() != 1 || stencil.width() != photo.width() || stencil.height() != photo.height())
    throw input_error("the {} stencil has {} x {} pixels and {} channels; the photo {} x {} pixels", which,
                      stencil.width(), stencil.height(), stencil.channels(), photo.width(), photo.height());
}

// Distance of every pixel to the stencil's outline, smoothed so that the outline loses its pixel steps.
// Without an outline everything is far away.
cv::Mat outline_distance(const Image8& stencil, double smoothing_px) {
  cv::Mat inside(stencil.height(), stencil.width(), CV_8U);
  for (int y = 0; y < stencil.height(); ++y)
    for (int x = 0; x < stencil.width(); ++x)
      inside.at<std::uint8_t>(y, x) = stencil.at(x, y) == stencil::object ? 255 : 0;
  const int object_pixels = cv::countNonZero(inside);
  if (object_pixels == 0 || object_pixels == static_cast<int>(inside.total()))
    return {inside.size(), CV_32F, cv::Scalar(1e6)};
  const cv::Mat outside = ~inside;
  cv::Mat from_outside;
  cv::Mat from_inside;
  cv::distanceTransform(inside, from_outside, cv::DIST_L2, cv::DIST_MASK_PRECISE);
  cv::distanceTransform(outside, from_inside, cv::DIST_L2, cv::DIST_MASK_PRECISE);
  // The transform measures between pixel centres; the outline runs half a pixel before the other side's.
  cv::Mat distance = from_outside - from_inside;
  for (int y = 0; y < distance.rows; ++y)
    for (int x = 0; x < distance.cols; ++x)
      distance.at<float>(y, x) -= inside.at<std::uint8_t>(y, x) != 0 ? 0.5F : -0.5F;
  cv::GaussianBlur(distance, distance, cv::Size(0, 0), smoothing_px, smoothing_px, cv::BORDER_REPLICATE);
  return cv::abs(distance);
}

// 1 within half the width of the line, falling to 0 over one pixel: anti-aliased.
float coverage(float distance, double width_px) {
  return std::clamp(static_cast<float>(width_px / 2 + 0.5) - distance, 0.0F, 1.0F);
}

class Overlay {
 public:
  Overlay(const Image8& photo, const Image8& image_stencil, const Image8& model_stencil)
      : photo_(photo), image_stencil_(image_stencil), model_stencil_(model_stencil) {
    width_px_ = std::max(1.5, 0.002 * std::max(photo.width(), photo.height()));
    const double smoothing_px = std::max(0.7, 0.5 * width_px_);
    if (!image_stencil.empty()) image_distance_ = outline_distance(image_stencil, smoothing_px);
    if (!model_stencil.empty()) model_distance_ = outline_distance(model_stencil, smoothing_px);
  }

  [[nodiscard]] Eigen::Vector3f pixel(int x, int y) const {
    Eigen::Vector3f light(linear_from_byte(photo_.at(x, y, 0)), linear_from_byte(photo_.at(x, y, 1)),
                          linear_from_byte(photo_.at(x, y, 2)));
    const std::uint8_t image = at(image_stencil_, x, y);
    const std::uint8_t model = at(model_stencil_, x, y);
    if (image != stencil::object && model != stencil::object) light *= dimmed_light;
    if (!image_stencil_.empty() && !model_stencil_.empty()) {
      if (image == stencil::object && model != stencil::object) light = mixed(light, orange_, tint_share);
      if (image == stencil::background && model == stencil::object) light = mixed(light, blue_, tint_share);
    }
    const float to_image = image_distance_.empty() ? 1e6F : image_distance_.at<float>(y, x);
    const float to_model = model_distance_.empty() ? 1e6F : model_distance_.at<float>(y, x);
    const float halo = coverage(std::min(to_image, to_model), 3.2 * width_px_);
    light *= 1 - halo_share * halo;
    // The image's line is wider and lies below, so that both show where they run together.
    light = mixed(light, orange_, coverage(to_image, image_line_width_px()));
    light = mixed(light, blue_, coverage(to_model, width_px_));
    return light;
  }

 private:
  static std::uint8_t at(const Image8& stencil, int x, int y) {
    return stencil.empty() ? stencil::background : stencil.at(x, y);
  }
  static Eigen::Vector3f mixed(const Eigen::Vector3f& a, const Eigen::Vector3f& b, float share_of_b) {
    return (1 - share_of_b) * a + share_of_b * b;
  }
  [[nodiscard]] double image_line_width_px() const {
    return model_stencil_.empty() ? width_px_ : 2.1 * width_px_;
  }

  const Image8& photo_;
  const Image8& image_stencil_;
  const Image8& model_stencil_;
  Eigen::Vector3f orange_ = linear_from_srgb(orange);
  Eigen::Vector3f blue_ = linear_from_srgb(blue);
  double width_px_ = 1;
  cv::Mat image_distance_;
  cv::Mat model_distance_;
};

}  // namespace

Image8 overlay_picture(const Image8& photo, const Image8& image_stencil, const Image8& model_stencil) {
  if (photo.channels() != 3) throw input_error("a photo has 3 channels; this one has {}", photo.channels());
  require_size(image_stencil, photo, "image");
  require_size(model_stencil, photo, "model");
  const Overlay overlay(photo, image_stencil, model_stencil);
  Image8 picture(photo.width(), photo.height(), 3);
  parallel_for(static_cast<std::size_t>(photo.height()), 16, [&](std::size_t begin, std::size_t end) {
    for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y)
      for (int x = 0; x < photo.width(); ++x) {
        const Eigen::Vector3f light = overlay.pixel(x, y);
        for (int c = 0; c < 3; ++c) picture.at(x, y, c) = byte_from_linear(light[c]);
      }
  });
  return picture;
}

}  // namespace drape::report
