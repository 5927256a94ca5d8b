#include "color_level.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <set>

namespace drape::alignment {
namespace {

constexpr int cluster_samples = 4000;
constexpr std::uint64_t cluster_seed = 20;
constexpr std::size_t most_segments = 32;
constexpr float segment_step = 150;  // Lab units: two neighbours on the circle are 29 apart

// Of the pixels of `reduced`, which has `scale` pixels a photo pixel and starts at `corner` in the photo.
void fill(LabWindow& out, const cv::Mat& reduced) {
  cv::Mat unit;
  cv::Mat lab;
  reduced.convertTo(unit, CV_32FC3, 1.0 / 255.0);
  cv::cvtColor(unit, lab, cv::COLOR_RGB2Lab);
  for (int y = 0; y < lab.rows; ++y) {
    const auto* from = lab.ptr<float>(y);
    std::copy_n(from, 3 * lab.cols, out.lab.row(y).begin());
  }
}

// The reduced picture as the ideal camera would have taken it.
cv::Mat undistorted(const cv::Mat& reduced, const PhotoPlane& plane, const Eigen::Vector2d& corner,
                    double scale, LabWindow& out) {
  cv::Mat places(reduced.rows, reduced.cols, CV_32FC2);
  for (int y = 0; y < places.rows; ++y)
    for (int x = 0; x < places.cols; ++x) {
      const Eigen::Vector2d photo = plane.to_photo(out.window.to_photo(Eigen::Vector2d(x + 0.5, y + 0.5)));
      const Eigen::Vector2d at = (photo - corner) * scale - Eigen::Vector2d(0.5, 0.5);
      places.at<cv::Vec2f>(y, x) = {static_cast<float>(at.x()), static_cast<float>(at.y())};
      if (at.x() > -0.5 && at.y() > -0.5 && at.x() < reduced.cols - 0.5 && at.y() < reduced.rows - 0.5)
        out.known.set(x, y);
    }
  cv::Mat result;
  cv::remap(reduced, result, places, cv::noArray(), cv::INTER_LINEAR, cv::BORDER_REPLICATE);
  return result;
}

std::uint16_t bin_of(const float* lab) {
  const auto step = [](float value, float least, float width) {
    return static_cast<unsigned>(std::clamp((value - least) / width, 0.F, 15.F));
  };
  return static_cast<std::uint16_t>(256 * step(lab[0], 0, 6.25F) + 16 * step(lab[1], -64, 8) +
                                    step(lab[2], -64, 8));
}

std::size_t nearest(const std::vector<LabColor>& clusters, const float* lab) {
  std::size_t best = 0;
  float least = std::numeric_limits<float>::max();
  for (std::size_t i = 0; i < clusters.size(); ++i) {
    float distance = 0;
    for (std::size_t c = 0; c < 3; ++c) distance += (clusters[i][c] - lab[c]) * (clusters[i][c] - lab[c]);
    if (distance >= least) continue;
    least = distance;
    best = i;
  }
  return best;
}

Image<ColorLevel::Step> steps_of(const ImageF& lab) {
  Image<ColorLevel::Step> steps(lab.width(), lab.height(), 1);
  for (int y = 1; y + 1 < lab.height(); ++y)
    for (int x = 1; x + 1 < lab.width(); ++x) {
      ColorLevel::Step step;
      for (int c = 0; c < 3; ++c) {
        const float dx = lab.at(x + 1, y, c) - lab.at(x - 1, y, c);
        const float dy = lab.at(x, y + 1, c) - lab.at(x, y - 1, c);
        step.xx += dx * dx;
        step.xy += dx * dy;
        step.yy += dy * dy;
      }
      steps.at(x, y) = step;
    }
  return steps;
}

// The part of the photo in a box, and the pixels that it is reduced to.
struct Cut {
  cv::Rect part;
  cv::Size size;
  Window window;
};

Cut cut_of(int photo_width, int photo_height, const PhotoPlane& plane, const PhotoBox& box, double scale) {
  Cut cut;
  cut.part.x = std::clamp(static_cast<int>(std::floor(box.left)), 0, photo_width - 1);
  cut.part.y = std::clamp(static_cast<int>(std::floor(box.top)), 0, photo_height - 1);
  cut.part.width =
      std::clamp(static_cast<int>(std::ceil(box.right)), cut.part.x + 1, photo_width) - cut.part.x;
  cut.part.height =
      std::clamp(static_cast<int>(std::ceil(box.bottom)), cut.part.y + 1, photo_height) - cut.part.y;
  cut.size.width = std::max(1, static_cast<int>(std::lround(cut.part.width * scale)));
  cut.size.height = std::max(1, static_cast<int>(std::lround(cut.part.height * scale)));
  cut.window.width = cut.size.width;
  cut.window.height = cut.size.height;
  // Rounding to whole pixels stretches the axes apart by less than half a pixel in all.
  cut.window.px_per_photo_px = std::sqrt(static_cast<double>(cut.size.area()) / cut.part.area());
  const Eigen::Vector2d middle(cut.part.x + cut.part.width / 2.0, cut.part.y + cut.part.height / 2.0);
  cut.window.origin = plane.to_ideal(middle) -
                      Eigen::Vector2d(cut.size.width, cut.size.height) / (2 * cut.window.px_per_photo_px);
  return cut;
}

}  // namespace

LabWindow lab_window(const Image8& rgb, const PhotoPlane& plane, const PhotoBox& box, double scale) {
  const Cut cut = cut_of(rgb.width(), rgb.height(), plane, box, scale);
  const cv::Mat whole(rgb.height(), rgb.width(), CV_8UC3, const_cast<std::uint8_t*>(rgb.data().data()));
  const cv::Size& size = cut.size;
  cv::Mat reduced;
  cv::resize(whole(cut.part), reduced, size, 0, 0, scale < 1 ? cv::INTER_AREA : cv::INTER_LINEAR);

  LabWindow out;
  out.window = cut.window;
  out.lab = ImageF(size.width, size.height, 3);
  out.known = BitImage(size.width, size.height);
  if (plane.plain()) {
    for (int y = 0; y < size.height; ++y)
      for (int x = 0; x < size.width; ++x) out.known.set(x, y);
    fill(out, reduced);
  } else {
    fill(out, undistorted(reduced, plane, Eigen::Vector2d(cut.part.x, cut.part.y), out.window.px_per_photo_px,
                          out));
  }
  return out;
}

std::vector<LabColor> color_clusters(const LabWindow& window, int most) {
  const std::size_t pixels = window.lab.data().size() / 3;
  const std::size_t every = std::max<std::size_t>(1, pixels / cluster_samples);
  cv::Mat samples(static_cast<int>((pixels + every - 1) / every), 3, CV_32F);
  std::set<std::array<float, 3>> distinct;
  for (int i = 0; i < samples.rows; ++i) {
    const float* lab = window.lab.data().data() + 3 * every * static_cast<std::size_t>(i);
    std::copy_n(lab, 3, samples.ptr<float>(i));
    if (static_cast<int>(distinct.size()) < most) distinct.insert({lab[0], lab[1], lab[2]});
  }
  const int count = std::min(most, static_cast<int>(distinct.size()));
  cv::Mat labels;
  cv::Mat centers;
  cv::theRNG().state = cluster_seed;
  cv::kmeans(samples, count, labels, {cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 20, 0.3}, 1,
             cv::KMEANS_PP_CENTERS, centers);
  std::vector<LabColor> clusters;
  for (int i = 0; i < centers.rows; ++i) {
    const auto* center = centers.ptr<float>(i);
    clusters.push_back({center[0], center[1], center[2]});
  }
  return clusters;
}

ColorLevel color_level(const LabWindow& from, const std::vector<LabColor>& clusters) {
  ColorLevel level;
  level.window = from.window;
  level.known = from.known;
  const int width = from.lab.width();
  const int height = from.lab.height();
  level.bins = Image<std::uint16_t>(width, height, 1, ColorLevel::no_bin);
  level.labels.assign(clusters.size(), BitImage(width, height));
  level.label_at = Image8(width, height, 1, ColorLevel::no_label);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      if (!from.known.at(x, y)) continue;
      const float* lab = &from.lab.at(x, y);
      level.bins.at(x, y) = bin_of(lab);
      const std::size_t here = nearest(clusters, lab);
      level.labels[here].set(x, y);
      level.label_at.at(x, y) = static_cast<std::uint8_t>(here);
    }
  level.steps = steps_of(from.lab);
  return level;
}

ColorLevel segment_level(const Image<std::int32_t>& segments, const PhotoPlane& plane, const PhotoBox& box,
                         double scale) {
  ColorLevel level;
  level.window = cut_of(segments.width(), segments.height(), plane, box, scale).window;
  level.smooth = false;
  level.known = BitImage(level.window.width, level.window.height);
  level.bins = Image<std::uint16_t>(level.window.width, level.window.height, 1, ColorLevel::no_bin);
  std::map<std::int32_t, int> pixels;
  Image<std::int32_t> seen(level.window.width, level.window.height, 1, -1);
  for (int y = 0; y < seen.height(); ++y)
    for (int x = 0; x < seen.width(); ++x) {
      const Eigen::Vector2d at = plane.to_photo(level.window.to_photo(Eigen::Vector2d(x + 0.5, y + 0.5)));
      const int u = static_cast<int>(std::floor(at.x()));
      const int v = static_cast<int>(std::floor(at.y()));
      if (!segments.contains(u, v)) continue;
      seen.at(x, y) = segments.at(u, v);
      ++pixels[seen.at(x, y)];
    }
  std::vector<std::pair<int, std::int32_t>> largest;
  for (const auto& [label, count] : pixels) largest.emplace_back(-count, label);
  std::sort(largest.begin(), largest.end());
  std::map<std::int32_t, std::size_t> cluster;
  for (std::size_t i = 0; i < largest.size(); ++i)
    cluster[largest[i].second] = std::min<std::size_t>(i, most_segments - 1);
  level.labels.assign(std::min<std::size_t>(most_segments, largest.size()),
                      BitImage(level.window.width, level.window.height));
  level.label_at = Image8(level.window.width, level.window.height, 1, ColorLevel::no_label);
  ImageF meeting(seen.width(), seen.height(), 3, 0.F);
  for (int y = 0; y < seen.height(); ++y)
    for (int x = 0; x < seen.width(); ++x) {
      if (seen.at(x, y) < 0) continue;
      const std::size_t here = cluster[seen.at(x, y)];
      level.known.set(x, y);
      level.bins.at(x, y) = static_cast<std::uint16_t>(here);
      level.labels[here].set(x, y);
      level.label_at.at(x, y) = static_cast<std::uint8_t>(here);
      // Points of a circle, any two of them a clear step apart.
      const double turn = 2 * std::numbers::pi * static_cast<double>(here) / most_segments;
      meeting.at(x, y, 1) = segment_step * static_cast<float>(std::cos(turn));
      meeting.at(x, y, 2) = segment_step * static_cast<float>(std::sin(turn));
    }
  level.steps = steps_of(meeting);
  return level;
}

}  // namespace drape::alignment
