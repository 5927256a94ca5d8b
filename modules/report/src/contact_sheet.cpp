#include "drape/report/contact_sheet.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "color.hpp"
#include "drape/base/error.hpp"

namespace drape::report {
namespace {

// Linear light; with alpha, premultiplied by it.
cv::Mat to_linear(const Image8& picture) {
  cv::Mat linear(picture.height(), picture.width(), CV_32FC(picture.channels()));
  for (int y = 0; y < picture.height(); ++y) {
    auto* row = linear.ptr<float>(y);
    for (int x = 0; x < picture.width(); ++x) {
      const float alpha = picture.channels() == 4 ? static_cast<float>(picture.at(x, y, 3)) / 255.0F : 1.0F;
      for (int c = 0; c < picture.channels(); ++c)
        *row++ = c == 3 ? alpha : alpha * linear_from_byte(picture.at(x, y, c));
    }
  }
  return linear;
}

Image8 from_linear(const cv::Mat& linear) {
  Image8 picture(linear.cols, linear.rows, linear.channels());
  for (int y = 0; y < linear.rows; ++y) {
    const auto* pixel = linear.ptr<float>(y);
    for (int x = 0; x < linear.cols; ++x, pixel += linear.channels()) {
      const float alpha = linear.channels() == 4 ? pixel[3] : 1.0F;
      for (int c = 0; c < linear.channels(); ++c)
        picture.at(x, y, c) =
            c == 3 ? byte_from_unit(alpha) : byte_from_linear(alpha > 0 ? pixel[c] / alpha : 0.0F);
    }
  }
  return picture;
}

void paste(Image8& sheet, const Image8& picture, int left, int top) {
  const bool grey = picture.channels() == 1;
  for (int y = 0; y < picture.height(); ++y)
    for (int x = 0; x < picture.width(); ++x) {
      const float alpha = picture.channels() == 4 ? static_cast<float>(picture.at(x, y, 3)) / 255.0F : 1.0F;
      for (int c = 0; c < 3; ++c) {
        const float over = linear_from_byte(picture.at(x, y, grey ? 0 : c));
        const float under = linear_from_byte(sheet.at(left + x, top + y, c));
        sheet.at(left + x, top + y, c) = byte_from_linear(alpha * over + (1 - alpha) * under);
      }
    }
}

int columns_for(int count, const ContactSheetStyle& style) {
  if (style.columns > 0) return std::min(style.columns, count);
  constexpr double wanted = 1.5;
  int best = 1;
  double best_distance = std::numeric_limits<double>::infinity();
  for (int columns = 1; columns <= count; ++columns) {
    const int rows = (count + columns - 1) / columns;
    const double shape = static_cast<double>(columns) * style.cell_width_px / (rows * style.cell_height_px);
    // Cells that stay empty in the last row count as a worse shape.
    const double distance = std::abs(std::log(shape / wanted)) + 0.5 * (rows * columns - count);
    if (distance < best_distance) {
      best = columns;
      best_distance = distance;
    }
  }
  return best;
}

}  // namespace

Image8 fitted(const Image8& picture, int max_width, int max_height) {
  if (max_width <= 0 || max_height <= 0)
    throw input_error("cannot fit a picture into {} x {} pixels", max_width, max_height);
  if (picture.width() <= max_width && picture.height() <= max_height) return picture;
  const double factor = std::min(static_cast<double>(max_width) / picture.width(),
                                 static_cast<double>(max_height) / picture.height());
  const cv::Size size(std::clamp(static_cast<int>(std::lround(picture.width() * factor)), 1, max_width),
                      std::clamp(static_cast<int>(std::lround(picture.height() * factor)), 1, max_height));
  cv::Mat reduced;
  cv::resize(to_linear(picture), reduced, size, 0, 0, cv::INTER_AREA);
  return from_linear(reduced);
}

Image8 contact_sheet(std::span<const Image8> pictures, const ContactSheetStyle& style) {
  if (style.cell_width_px <= 0 || style.cell_height_px <= 0 || style.gap_px < 0)
    throw input_error("a contact sheet cannot have cells of {} x {} pixels {} apart", style.cell_width_px,
                      style.cell_height_px, style.gap_px);
  if (pictures.empty()) return {};
  const int count = static_cast<int>(pictures.size());
  const int columns = columns_for(count, style);
  const int rows = (count + columns - 1) / columns;
  const int step_x = style.cell_width_px + style.gap_px;
  const int step_y = style.cell_height_px + style.gap_px;
  Image8 sheet(columns * step_x + style.gap_px, rows * step_y + style.gap_px, 3);
  for (int y = 0; y < sheet.height(); ++y)
    for (int x = 0; x < sheet.width(); ++x)
      for (int c = 0; c < 3; ++c) sheet.at(x, y, c) = byte_from_unit(style.background[c]);
  for (int i = 0; i < count; ++i) {
    const Image8& picture = pictures[static_cast<std::size_t>(i)];
    if (picture.empty()) continue;
    const Image8 small = fitted(picture, style.cell_width_px, style.cell_height_px);
    paste(sheet, small, style.gap_px + i % columns * step_x + (style.cell_width_px - small.width()) / 2,
          style.gap_px + i / columns * step_y + (style.cell_height_px - small.height()) / 2);
  }
  return sheet;
}

}  // namespace drape::report
