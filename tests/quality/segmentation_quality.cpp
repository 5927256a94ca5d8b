// Intersection over union of stencils with hand-made masks of nine photos: unaided, from a box, from a click.
// Usage: segmentation_quality [methods=kmeans,em] [only=ROW] [save=FOLDER] [option=value ...], options as in
// the `segment` section of a configuration.
#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <functional>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <string>
#include <vector>

#include "drape/base/error.hpp"
#include "drape/segmentation/segment_photo.hpp"
#include "program_arguments.hpp"
#include "support.hpp"

namespace drape {
namespace {

namespace fs = std::filesystem;
using segmentation::Method;
using segmentation::PhotoRegion;
using segmentation::SegmentOptions;

Image8 read(const fs::path& file, int mode) {
  cv::Mat pixels = cv::imread(file.string(), mode);
  if (pixels.empty()) throw input_error("{}: cannot be read", file.string());
  if (pixels.channels() == 3) cv::cvtColor(pixels, pixels, cv::COLOR_BGR2RGB);
  Image8 image(pixels.cols, pixels.rows, pixels.channels());
  std::copy_n(pixels.data, image.data().size(), image.data().begin());
  return image;
}

struct Case {
  std::string name;
  Image8 rgb;
  Image8 truth;      // 255 object, 0 background, 128 ignored
  Image8 scribbles;  // stencil::object, background or unknown
  std::array<double, 4> box{};
  std::array<double, 2> click{};
};

// The data's marks are a palette's: pale yellow object, red background, black none.
Image8 read_scribbles(const fs::path& file) {
  const Image8 marks = read(file, cv::IMREAD_COLOR);
  Image8 scribbles(marks.width(), marks.height(), 1, stencil::unknown);
  for (int y = 0; y < marks.height(); ++y)
    for (int x = 0; x < marks.width(); ++x)
      if (marks.at(x, y, 0) > 127)
        scribbles.at(x, y) = marks.at(x, y, 1) > 127 ? stencil::object : stencil::background;
  return scribbles;
}

Case load(const fs::path& photo) {
  Case c;
  c.name = photo.stem().string();
  c.rgb = read(photo, cv::IMREAD_COLOR);
  c.truth = read(photo.parent_path() / (c.name + "_gt.png"), cv::IMREAD_GRAYSCALE);
  c.scribbles = read_scribbles(photo.parent_path() / (c.name + "_scribble1.png"));
  cv::Mat object(c.truth.height(), c.truth.width(), CV_8U, c.truth.data().data());
  object = object == 255;
  const cv::Rect box = cv::boundingRect(object);
  c.box = {double(box.x), double(box.y), double(box.width), double(box.height)};
  cv::Mat depth;
  cv::distanceTransform(object, depth, cv::DIST_L2, cv::DIST_MASK_PRECISE);
  cv::Point deepest;
  cv::minMaxLoc(depth, nullptr, nullptr, nullptr, &deepest);
  c.click = {deepest.x + 0.5, deepest.y + 0.5};
  return c;
}

std::array<double, 4> grown(const Case& c, double share) {
  return {c.box[0] - share * c.box[2], c.box[1] - share * c.box[3], c.box[2] * (1 + 2 * share),
          c.box[3] * (1 + 2 * share)};
}

double intersection_over_union(const Image8& found, const Image8& truth) {
  double both = 0;
  double either = 0;
  for (std::size_t i = 0; i < truth.data().size(); ++i) {
    if (truth.data()[i] == 128) continue;
    const bool a = found.data()[i] == stencil::object;
    const bool b = truth.data()[i] == 255;
    both += a && b;
    either += a || b;
  }
  return either > 0 ? both / either : 0;
}

struct Row {
  std::string name;
  std::function<PhotoRegion(const Case&)> region;
};

void measure(const std::vector<Case>& cases, const SegmentOptions& options, const std::string& method,
             const std::string& only, const std::string& save_folder) {
  const std::vector<Row> rows = {
      {"unaided", [](const Case&) { return PhotoRegion{}; }},
      {"box",
       [](const Case& c) {
         return PhotoRegion{c.box, {}};
       }},
      {"box +20 %",
       [](const Case& c) {
         return PhotoRegion{grown(c, 0.2), {}};
       }},
      {"click",
       [](const Case& c) {
         return PhotoRegion{{}, c.click};
       }},
      {"scribbles",
       [](const Case& c) {
         return PhotoRegion{{}, {}, c.scribbles};
       }},
  };
  for (const Row& row : rows) {
    if (row.name.find(only) != 0) continue;
    std::vector<double> scores;
    std::string each;
    cv::Mat sheet;
    const auto start = std::chrono::steady_clock::now();
    for (const Case& c : cases) {
      const auto found = segmentation::segment_photo(c.rgb, {}, row.region(c), options, 1);
      scores.push_back(intersection_over_union(found.stencil, c.truth));
      each += fmt::format(" {:.2f}({:.2f})", scores.back(), found.confidence);
      if (save_folder.empty()) continue;
      cv::Mat picture(c.rgb.height(), c.rgb.width(), CV_8UC3);
      const Image8 painted = segmentation::paint_labels(found);
      for (int y = 0; y < c.rgb.height(); ++y)
        for (int x = 0; x < c.rgb.width(); ++x)
          for (int k = 0; k < 3; ++k)
            picture.at<cv::Vec3b>(y, x)[k] = found.stencil.at(x, y) == stencil::object
                                                 ? c.rgb.at(x, y, 2 - k)
                                                 : static_cast<std::uint8_t>(c.rgb.at(x, y, 2 - k) / 4);
      cv::Mat labels(c.rgb.height(), c.rgb.width(), CV_8UC3,
                     const_cast<std::uint8_t*>(painted.data().data()));
      cv::Mat both;
      cv::cvtColor(labels, labels, cv::COLOR_RGB2BGR);
      cv::hconcat(picture, labels, both);
      cv::resize(both, both, {700, 240});
      if (sheet.empty())
        sheet = both;
      else
        cv::vconcat(sheet, both, sheet);
    }
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    if (!sheet.empty())
      cv::imwrite(fmt::format("{}/{}-{}.png", save_folder, method, row.name.substr(0, row.name.find('%'))),
                  sheet);
    std::vector<double> sorted = scores;
    std::sort(sorted.begin(), sorted.end());
    fmt::print("{:8} {:10} median IoU {:.3f} worst {:.2f}  {:.2f} s a photo |{}\n", method, row.name,
               sorted[sorted.size() / 2], sorted.front(), seconds / static_cast<double>(cases.size()), each);
  }
}

void run(test::ProgramArguments& arguments) {
  if (!test::have_data("segmentation")) {
    fmt::print("skipped: needs segmentation/ of DRAPE_TEST_DATA\n");
    return;
  }
  SegmentOptions options;
  std::string only;
  std::string save_folder;
  std::string methods;
  if (const auto given = arguments.text("only")) only = *given;
  if (const auto given = arguments.text("methods")) methods = *given;
  if (const auto given = arguments.text("save")) save_folder = *given;
  arguments.read(options);
  arguments.finish();
  std::vector<Case> cases;
  std::vector<fs::path> photos;
  for (const auto& entry : fs::directory_iterator(test::data("segmentation")))
    if (entry.path().extension() != ".png") photos.push_back(entry.path());
  std::sort(photos.begin(), photos.end());
  for (const fs::path& photo : photos) cases.push_back(load(photo));
  for (const auto& [method, name] : {std::pair{Method::automatic, "auto"},
                                     {Method::kmeans, "kmeans"},
                                     {Method::divisive, "divisive"},
                                     {Method::agglomerative, "agglomerative"},
                                     {Method::em, "em"},
                                     {Method::grabcut, "grabcut"},
                                     {Method::background, "background"}}) {
    if (!methods.empty() && methods.find(name) == std::string::npos) continue;
    options.method = method;
    measure(cases, options, name, only, save_folder);
  }
}

}  // namespace
}  // namespace drape

int main(int count, char** texts) {
  return drape::test::measuring_main(count, texts, drape::run);
}
