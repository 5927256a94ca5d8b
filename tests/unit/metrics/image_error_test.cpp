#include "drape/metrics/image_error.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "drape/base/random.hpp"
#include "support.hpp"

namespace drape::metrics {
namespace {

Image8 pattern(int width, int height, int channels) {
  Image8 image(width, height, channels);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      for (int c = 0; c < channels; ++c)
        image.at(x, y, c) =
            static_cast<std::uint8_t>(128 + 60 * std::sin(0.3 * x + c) + 40 * std::cos(0.2 * y));
  return image;
}

Image8 noisy(Image8 image, double deviation, std::uint64_t seed) {
  Rng rng(seed);
  for (std::uint8_t& value : image.data())
    value = static_cast<std::uint8_t>(std::clamp(std::lround(value + deviation * rng.normal()), 0L, 255L));
  return image;
}

Image8 left_half(int width, int height) {
  Image8 mask(width, height, 1, stencil::background);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width / 2; ++x) mask.at(x, y) = stencil::object;
  return mask;
}

// Equation 13 of Wang et al. at one pixel, with the 121 weights written out.
double ssim_at(const Image8& a, const Image8& b, int at_x, int at_y) {
  double w = 0, ma = 0, mb = 0, aa = 0, bb = 0, ab = 0;
  for (int dy = -5; dy <= 5; ++dy)
    for (int dx = -5; dx <= 5; ++dx) {
      if (!a.contains(at_x + dx, at_y + dy)) continue;
      const double weight = std::exp(-(dx * dx + dy * dy) / (2 * 1.5 * 1.5));
      const double va = a.at(at_x + dx, at_y + dy);
      const double vb = b.at(at_x + dx, at_y + dy);
      w += weight;
      ma += weight * va;
      mb += weight * vb;
      aa += weight * va * va;
      bb += weight * vb * vb;
      ab += weight * va * vb;
    }
  ma /= w;
  mb /= w;
  const double saa = aa / w - ma * ma;
  const double sbb = bb / w - mb * mb;
  const double sab = ab / w - ma * mb;
  return (2 * ma * mb + 6.5025) * (2 * sab + 58.5225) /
         ((ma * ma + mb * mb + 6.5025) * (saa + sbb + 58.5225));
}

TEST(Psnr, OfAKnownDifference) {
  const Image8 image(64, 48, 3, 100);
  EXPECT_NEAR(psnr_db(image, Image8(64, 48, 3, 110)).value(), 20 * std::log10(25.5), 1e-12);
  EXPECT_TRUE(std::isinf(psnr_db(image, image).value()));
}

TEST(Psnr, OfKnownNoise) {
  const Image8 image = pattern(400, 300, 3);
  const double deviation = 8;
  // Rounding adds 1 / 12 to the variance.
  const double expected = 10 * std::log10(255 * 255 / (deviation * deviation + 1.0 / 12));
  EXPECT_NEAR(psnr_db(image, noisy(image, deviation, 5)).value(), expected, 0.05);
}

TEST(Psnr, SeesOnlyWhatTheMaskKeeps) {
  const Image8 image = pattern(60, 40, 3);
  Image8 other = image;
  for (int y = 0; y < 40; ++y)
    for (int x = 30; x < 60; ++x) other.at(x, y, 1) = 0;
  EXPECT_TRUE(std::isinf(psnr_db(image, other, left_half(60, 40)).value()));
  EXPECT_LT(psnr_db(image, other).value(), 20);
  Image8 unknown = left_half(60, 40);
  for (std::uint8_t& value : unknown.data()) value = value == 255 ? 128 : 0;
  EXPECT_FALSE(psnr_db(image, other, unknown).has_value());
}

TEST(Ssim, IsOneForEqualPictures) {
  const Image8 image = pattern(80, 60, 3);
  EXPECT_NEAR(ssim(image, image).value(), 1, 1e-12);
  EXPECT_NEAR(ssim(image, image, left_half(80, 60)).value(), 1, 1e-12);
}

TEST(Ssim, OfFlatPicturesIsTheLuminanceTerm) {
  const double expected = (2 * 100.0 * 150.0 + 6.5025) / (100.0 * 100.0 + 150.0 * 150.0 + 6.5025);
  EXPECT_NEAR(ssim(Image8(40, 40, 1, 100), Image8(40, 40, 1, 150)).value(), expected, 1e-9);
}

TEST(Ssim, AgreesWithTheEquationPixelByPixel) {
  const Image8 a = pattern(31, 23, 1);
  const Image8 b = noisy(a, 25, 6);
  double sum = 0;
  for (int y = 0; y < 23; ++y)
    for (int x = 0; x < 31; ++x) sum += ssim_at(a, b, x, y);
  EXPECT_NEAR(ssim(a, b).value(), sum / (31 * 23), 1e-9);
}

TEST(Ssim, FallsWithNoiseAndIsSymmetric) {
  const Image8 image = pattern(120, 90, 3);
  double before = 1;
  for (const double deviation : {3.0, 10.0, 30.0}) {
    const Image8 other = noisy(image, deviation, 7);
    const double now = ssim(image, other).value();
    EXPECT_LT(now, before);
    EXPECT_DOUBLE_EQ(now, ssim(other, image).value());
    before = now;
  }
}

TEST(Ssim, WhatLiesOutsideTheMaskDoesNotMatter) {
  const Image8 a = pattern(60, 40, 3);
  const Image8 b = noisy(a, 12, 8);
  Image8 changed = b;
  for (int y = 0; y < 40; ++y)
    for (int x = 30; x < 60; ++x) changed.at(x, y, 0) = 255;
  const Image8 mask = left_half(60, 40);
  EXPECT_EQ(ssim(a, b, mask), ssim(a, changed, mask));
  EXPECT_NE(ssim(a, b), ssim(a, changed));
}

TEST(ImageError, DifferentSizesAndChannelsAreErrors) {
  const auto message = [](auto call) { return test::error_message(ErrorCode::input, call); };
  EXPECT_NE(message([] { (void)psnr_db(Image8(3, 4, 3), Image8(4, 3, 3)); }), "");
  EXPECT_NE(message([] { (void)ssim(Image8(3, 4, 3), Image8(3, 4, 1)); }), "");
  EXPECT_NE(message([] { (void)ssim(Image8(3, 4, 3), Image8(3, 4, 3), Image8(3, 5, 1)); }), "");
  EXPECT_NE(message([] { (void)psnr_db(Image8(3, 4, 3), Image8(3, 4, 3), Image8(3, 4, 3)); }), "");
}

TEST(ImageError, OfEmptyPicturesIsNothing) {
  EXPECT_FALSE(psnr_db(Image8(), Image8()).has_value());
  EXPECT_FALSE(ssim(Image8(), Image8()).has_value());
  EXPECT_FALSE(ssim(Image8(5, 5, 1), Image8(5, 5, 1), Image8(5, 5, 1)).has_value());
}

// Linear light 64 bytes apart by the factor given, in windows that each have one of their own.
Image8 lit(const Image8& paint, double left, double right) {
  Image8 picture = paint;
  for (int y = 0; y < paint.height(); ++y)
    for (int x = 0; x < paint.width(); ++x) {
      const double light = x < paint.width() / 2 ? left : right;
      // Powers, as sRGB's curve is none.
      for (int c = 0; c < paint.channels(); ++c) {
        const double stored = paint.at(x, y, c) / 255.0;
        const double linear = light * std::pow((stored + 0.055) / 1.055, 2.4);
        picture.at(x, y, c) =
            static_cast<std::uint8_t>(std::lround(255 * (1.055 * std::pow(linear, 1 / 2.4) - 0.055)));
      }
    }
  return picture;
}

TEST(LocalAlbedoError, ForgivesTheLightOfAWindowAndNotAnEdgeInIt) {
  Image8 paint(40, 40, 3);
  Rng rng(4);
  for (std::uint8_t& value : paint.data()) value = static_cast<std::uint8_t>(100 + rng.below(120));
  EXPECT_NEAR(local_albedo_error(paint, paint).value(), 0, 1e-12);
  EXPECT_LT(local_albedo_error(lit(paint, 0.5, 0.5), paint).value(), 1e-4);
  const double edge = local_albedo_error(lit(paint, 1, 0.25), paint).value();
  EXPECT_GT(edge, 0.02);
  // The windows that the edge lies in are a third of all.
  EXPECT_LT(edge, 0.2);
  EXPECT_NEAR(local_albedo_error(Image8(40, 40, 3, 0), paint).value(), 1, 1e-12);
  EXPECT_FALSE(local_albedo_error(paint, paint, Image8(40, 40, 1, stencil::background)).has_value());
  EXPECT_NE(test::error_message(ErrorCode::input, [&] { (void)local_albedo_error(paint, paint, {}, 1); }),
            "");
}

}  // namespace
}  // namespace drape::metrics
