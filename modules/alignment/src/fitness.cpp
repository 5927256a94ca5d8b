#include "fitness.hpp"

#include <cstdint>

#include "outline_fitness.hpp"

namespace drape::alignment {
namespace {

// Thesis 4.2.4: of the pixels that either stencil holds, the share that both do.
class AreaFitness : public FitnessMeasure {
 public:
  AreaFitness(const ImageStencil& image, bool box_only) : image_(image) {
    if (box_only) {
      left_ = image.box_left;
      top_ = image.box_top;
      right_ = image.box_right;
      bottom_ = image.box_bottom;
    } else {
      right_ = image.pixels.width() - 1;
      bottom_ = image.pixels.height() - 1;
    }
  }

  double operator()(const Image8& model) const override {
    std::uint64_t both = 0;
    std::uint64_t either = 0;
    for (int y = top_; y <= bottom_; ++y) {
      const auto a = image_.pixels.row(y);
      const auto b = model.row(y);
      const auto known = image_.known.row(y);
      std::uint32_t row_both = 0;
      std::uint32_t row_either = 0;
      for (auto x = static_cast<std::size_t>(left_); x <= static_cast<std::size_t>(right_); ++x) {
        // Both stencils hold 0 or 255 where the pixel is known.
        row_both += static_cast<std::uint32_t>(a[x] & b[x] & known[x]);
        row_either += static_cast<std::uint32_t>((a[x] | b[x]) & known[x]);
      }
      both += row_both;
      either += row_either;
    }
    return either == 0 ? 0.0 : 100.0 * static_cast<double>(both) / static_cast<double>(either);
  }

 private:
  const ImageStencil& image_;
  int left_ = 0, top_ = 0, right_ = 0, bottom_ = 0;
};

}  // namespace

std::unique_ptr<FitnessMeasure> make_fitness(const ImageStencil& image, const ExhaustiveOptions& options) {
  switch (options.fitness) {
    case Fitness::list:
      return std::make_unique<ListFitness>(image);
    case Fitness::rays:
      return std::make_unique<RayFitness>(image);
    case Fitness::area:
      break;
  }
  return std::make_unique<AreaFitness>(image, options.box_only);
}

}  // namespace drape::alignment
