// Times of finding the object in a photo of 12 megapixels: without its mesh, and by the photo's colours with
// it.
//
//   segmentation_benchmark [repeats=N]
#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <functional>
#include <string>
#include <vector>

#include "../quality/photo_cases.hpp"
#include "drape/alignment/align.hpp"
#include "drape/base/random.hpp"
#include "drape/metrics/distribution.hpp"
#include "drape/segmentation/segment_photo.hpp"
#include "program_arguments.hpp"

namespace drape {
namespace {

constexpr int width = 4000;
constexpr int height = 3000;

// The photo with many more pixels, each with noise of its own.
Image8 enlarged(const Image8& rgb) {
  Image8 large(width, height, 3);
  Rng rng(1);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      for (int c = 0; c < 3; ++c) {
        const double value =
            rgb.at(x * rgb.width() / width, y * rgb.height() / height, c) + rng.uniform(-4, 4);
        large.at(x, y, c) = static_cast<std::uint8_t>(std::clamp(value, 0.0, 255.0));
      }
  return large;
}

void print(const std::string& name, double limit, int repeats, const std::function<void()>& call) {
  std::vector<double> busy;
  std::vector<double> passed;
  for (int i = 0; i < repeats; ++i) {
    const double before = test::cpu_seconds();
    const auto begin = std::chrono::steady_clock::now();
    call();
    passed.push_back(std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
    busy.push_back(test::cpu_seconds() - before);
  }
  fmt::print("{:28} {:5.2f} s (at most {:.1f}), CPU {:5.2f} s\n", name, metrics::distribution(passed).median,
             limit, metrics::distribution(busy).median);
  std::fflush(stdout);
}

void run(int repeats) {
  const PhotoCase photo = simulated_case(1, Scene::clutter);
  const Image8 rgb = enlarged(photo.rgb);
  for (const auto& [method, name] :
       {std::pair{segmentation::Method::kmeans, "kmeans"}, {segmentation::Method::grabcut, "grabcut"}}) {
    segmentation::SegmentOptions options;
    options.method = method;
    print(fmt::format("segments by {}", name), 2, repeats,
          [&] { (void)segmentation::segment_photo(rgb, {}, {}, options, 1); });
  }
  const Image8 nothing(width, height, 1, stencil::unknown);
  alignment::AlignOptions options;
  options.evidence = alignment::EvidenceKind::colour;
  alignment::PhotoEvidence evidence{nothing, std::nullopt, &rgb};
  const auto align = [&] { (void)alignment::align_photo(photo.mesh, evidence, options, 1, {}); };
  const double factor = static_cast<double>(width) / photo.rgb.width();
  Rng rng(3);
  std::array<double, 4> box = loose_box(photo.silhouette, rng);
  for (double& value : box) value *= factor;
  evidence.box_px = box;
  print("colours in a box", 1.5, repeats, align);
  evidence.box_px.reset();
  const std::array<double, 2> click = click_inside(photo.silhouette, rng);
  evidence.click_px = {click[0] * factor, click[1] * factor};
  print("colours round a click", 4, repeats, align);
  evidence.click_px.reset();
  print("colours of the whole photo", 7, repeats, align);
}

}  // namespace
}  // namespace drape

int main(int count, char** texts) {
  return drape::test::measuring_main(count, texts, [](drape::test::ProgramArguments& arguments) {
    const int repeats = arguments.integer("repeats").value_or(3);
    arguments.finish();
    drape::run(repeats);
  });
}
