#include "fitness.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace drape::alignment {
namespace {

using std::numbers::pi;

Image8 disc(double radius, double cx = 100, double cy = 90) {
  Image8 image(200, 180, 1, stencil::background);
  for (int y = 0; y < image.height(); ++y)
    for (int x = 0; x < image.width(); ++x)
      if (std::hypot(x + 0.5 - cx, y + 0.5 - cy) < radius) image.at(x, y) = stencil::object;
  return image;
}

double fitness(const Image8& photo, const Image8& model, Fitness kind, bool box_only = false) {
  const ImageStencil image = image_stencil(photo, 1024);
  ExhaustiveOptions options;
  options.fitness = kind;
  options.box_only = box_only;
  return (*make_fitness(image, options))(model);
}

TEST(FitnessMeasures, AreHundredForTheSameStencilAndZeroForNone) {
  for (const Fitness kind : {Fitness::area, Fitness::list, Fitness::rays}) {
    EXPECT_DOUBLE_EQ(fitness(disc(50), disc(50), kind), 100);
    EXPECT_DOUBLE_EQ(fitness(disc(50), Image8(200, 180, 1, stencil::background), kind), 0);
  }
}

TEST(FitnessMeasures, KeepTheMeaningOfThresholdsForASmallerDisc) {
  // Off by 2 px all round: 96 % of the radius is 92 % of the area, and L d / A is 8 %. Pixels make it
  // uncertain by about a tenth of a pixel in d, 0.4 %.
  EXPECT_NEAR(fitness(disc(50), disc(48), Fitness::area), 92.16, 0.4);
  EXPECT_NEAR(fitness(disc(50), disc(48), Fitness::list), 92, 1.2);
  EXPECT_NEAR(fitness(disc(50), disc(48), Fitness::rays), 92, 0.6);
  EXPECT_NEAR(fitness(disc(50), disc(52), Fitness::rays), 92, 0.6);
}

TEST(FitnessMeasures, OfAShiftedDisc) {
  // Two discs of radius r, d apart: 1 - overlap = 4 d / (pi r) to first order; rays find the mean |d cos| as
  // well.
  const double expected = 100 * (1 - 4 * 3 / (pi * 50));
  EXPECT_NEAR(fitness(disc(50), disc(50, 103), Fitness::area), expected, 0.6);
  EXPECT_NEAR(fitness(disc(50), disc(50, 103), Fitness::rays), expected, 0.8);
  // Pair by pair every point is off, those that slide along the outline too.
  const double list = fitness(disc(50), disc(50, 103), Fitness::list);
  EXPECT_LT(list, expected);
  EXPECT_GT(list, 100 * (1 - 2 * 4.5 / 50));
}

TEST(FitnessMeasures, OutlinesDoNotSeeHolesAreaDoes) {
  Image8 holed = disc(50);
  for (int y = 80; y < 100; ++y)
    for (int x = 90; x < 110; ++x) holed.at(x, y) = stencil::background;
  EXPECT_LT(fitness(disc(50), holed, Fitness::area), 96);
  EXPECT_DOUBLE_EQ(fitness(disc(50), holed, Fitness::list), 100);
  EXPECT_DOUBLE_EQ(fitness(disc(50), holed, Fitness::rays), 100);
}

TEST(AreaFitness, CountsModelPixelsOutsideTheBoxAsMissesUnlessBoxOnly) {
  Image8 with_tail = disc(50);
  for (int y = 85; y < 95; ++y)
    for (int x = 100; x < 200; ++x) with_tail.at(x, y) = stencil::object;
  const double expected = 100 * (pi * 2500) / (pi * 2500 + 500);  // 50 x 10 pixels stand out
  EXPECT_NEAR(fitness(disc(50), with_tail, Fitness::area), expected, 0.2);
  EXPECT_GT(fitness(disc(50), with_tail, Fitness::area, true), 99.8);
}

TEST(FitnessMeasures, LeaveUnknownPixelsOut) {
  Image8 covered = disc(50);
  Image8 model = disc(50);
  for (int y = 0; y < 180; ++y)
    for (int x = 120; x < 200; ++x) {
      covered.at(x, y) = stencil::unknown;
      model.at(x, y) = (x + y) % 2 == 0 ? stencil::object : stencil::background;
    }
  EXPECT_DOUBLE_EQ(fitness(covered, model, Fitness::area), 100);
  EXPECT_GT(fitness(covered, disc(50), Fitness::rays),
            99);  // rays into the unknown would be off by up to 50 px
  EXPECT_LT(fitness(covered, disc(40), Fitness::rays), 85);
}

}  // namespace
}  // namespace drape::alignment
