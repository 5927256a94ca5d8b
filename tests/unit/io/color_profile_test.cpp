#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>

#include "drape/base/files.hpp"
#include "drape/base/random.hpp"
#include "drape/io/photo.hpp"
#include "picture_bytes.hpp"
#include "support.hpp"

namespace drape {
namespace {

using test::raw;

std::string fixed(double value) {
  return raw(static_cast<std::int32_t>(std::lround(value * 65536)), true);
}

/// An ICC profile of the matrix and curves kind; the columns of `xyz` are the primaries under D50.
std::string icc_profile(const Eigen::Matrix3d& xyz, const std::string& curve) {
  const std::vector<std::string> names{"rXYZ", "gXYZ", "bXYZ", "rTRC", "gTRC", "bTRC"};
  std::string table = raw(std::uint32_t{6}, true), data;
  const std::size_t begin = 128 + 4 + 12 * names.size();
  for (std::size_t i = 0; i < names.size(); ++i) {
    const auto column = static_cast<Eigen::Index>(i % 3);
    const std::string value = i < 3 ? "XYZ " + std::string(4, '\0') + fixed(xyz(0, column)) +
                                          fixed(xyz(1, column)) + fixed(xyz(2, column))
                                    : curve;
    table += names[i] + raw(static_cast<std::uint32_t>(begin + data.size()), true) +
             raw(static_cast<std::uint32_t>(value.size()), true);
    data += value + std::string((4 - value.size() % 4) % 4, '\0');
  }
  std::string header(128, '\0');
  header.replace(16, 8, "RGB XYZ ");
  header.replace(36, 4, "acsp");
  return header + table + data;
}

/// sRGB's own curve as an ICC parametric curve of type 3.
std::string srgb_curve() {
  return "para" + std::string(4, '\0') + raw(std::uint16_t{3}, true) + std::string(2, '\0') + fixed(2.4) +
         fixed(1 / 1.055) + fixed(0.055 / 1.055) + fixed(1 / 12.92) + fixed(0.04045);
}
std::string gamma_curve(double gamma) {
  return "curv" + std::string(4, '\0') + raw(std::uint32_t{1}, true) +
         raw(static_cast<std::uint16_t>(std::lround(gamma * 256)), true);
}

// Under D50, as published with the profiles of these names.
Eigen::Matrix3d srgb_primaries() {
  return (Eigen::Matrix3d() << 0.43607, 0.38515, 0.14307, 0.22249, 0.71687, 0.06061, 0.01392, 0.09708,
          0.71410)
      .finished();
}
Eigen::Matrix3d display_p3_primaries() {
  return (Eigen::Matrix3d() << 0.51512, 0.29198, 0.15710, 0.24120, 0.69225, 0.06657, -0.00105, 0.04189,
          0.78407)
      .finished();
}

double linear(double s) {
  return s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4);
}
double encoded(double l) {
  return l <= 0.0031308 ? 12.92 * l : 1.055 * std::pow(l, 1 / 2.4) - 0.055;
}

Image8 random_image() {
  Rng rng(3);
  Image8 image(16, 16, 3);
  for (std::uint8_t& value : image.data()) value = static_cast<std::uint8_t>(40 + rng.below(160));
  return image;
}

/// A TIFF, which keeps every byte, with a profile.
io::Photo photo_with(const Image8& image, const std::string& profile) {
  test::TiffBuilder tiff(false);
  tiff.add_long(256, static_cast<std::uint32_t>(image.width()));
  tiff.add_long(257, static_cast<std::uint32_t>(image.height()));
  tiff.add_shorts(258, {8, 8, 8});
  tiff.add_short(259, 1);
  tiff.add_short(262, 2);
  tiff.add_short(277, 3);
  tiff.add_long(278, static_cast<std::uint32_t>(image.height()));
  if (!profile.empty()) tiff.add_undefined(34675, profile);
  tiff.add_pixels(std::string(image.data().begin(), image.data().end()));
  const test::ScratchFolder folder;
  write_file(folder / "x.tif", tiff.bytes());
  return io::read_photo(folder / "x.tif");
}

TEST(ColorProfile, SrgbStaysAsItIs) {
  const Image8 image = random_image();
  EXPECT_EQ(photo_with(image, "").rgb, image);
  EXPECT_EQ(photo_with(image, icc_profile(srgb_primaries(), srgb_curve())).rgb, image);
}

TEST(ColorProfile, OtherPrimariesAndCurvesAreConverted) {
  // Truth: colours known in sRGB, encoded as the profile would have them.
  const Image8 truth = random_image();
  struct Kind {
    Eigen::Matrix3d primaries;
    std::string curve;
    double gamma;  // 0: sRGB's curve
  };
  for (const Kind& kind : {Kind{display_p3_primaries(), srgb_curve(), 0},
                           Kind{display_p3_primaries(), gamma_curve(2.2), 2.19921875},
                           Kind{srgb_primaries(), gamma_curve(1.8), 1.80078125}}) {
    Image8 stored = truth;
    for (int y = 0; y < 16; ++y)
      for (int x = 0; x < 16; ++x) {
        const Eigen::Vector3d srgb(linear(truth.at(x, y, 0) / 255.0), linear(truth.at(x, y, 1) / 255.0),
                                   linear(truth.at(x, y, 2) / 255.0));
        const Eigen::Vector3d other = kind.primaries.inverse() * srgb_primaries() * srgb;
        for (int c = 0; c < 3; ++c) {
          const double value = std::clamp(other[c], 0.0, 1.0);
          stored.at(x, y, c) = static_cast<std::uint8_t>(
              std::lround(255 * (kind.gamma == 0 ? encoded(value) : std::pow(value, 1 / kind.gamma))));
        }
      }
    EXPECT_NE(stored, truth);
    const Image8 read = photo_with(stored, icc_profile(kind.primaries, kind.curve)).rgb;
    int worst = 0;
    for (std::size_t i = 0; i < truth.data().size(); ++i)
      worst = std::max(worst, std::abs(truth.data()[i] - read.data()[i]));
    // Both roundings to bytes, carried through the matrix: two steps at most in these mid tones.
    EXPECT_LE(worst, 2);
  }
}

TEST(ColorProfile, InAJpegOfSeveralSegments) {
  const test::ScratchFolder folder;
  const std::string jpeg = io::encode_image(random_image(), "jpg", 95);
  const std::string profile = icc_profile(display_p3_primaries(), srgb_curve());
  std::string segments;
  for (std::size_t part = 0; part < 2; ++part) {
    const std::string data = std::string("ICC_PROFILE\0", 12) + static_cast<char>(part + 1) + '\x02' +
                             profile.substr(part * 200, part == 0 ? 200 : std::string::npos);
    segments += "\xFF\xE2" + raw(static_cast<std::uint16_t>(data.size() + 2), true) + data;
  }
  write_file(folder / "x.jpg", jpeg.substr(0, 2) + segments + jpeg.substr(2));
  write_file(folder / "y.jpg", jpeg);
  EXPECT_NE(io::read_photo(folder / "x.jpg").rgb, io::read_photo(folder / "y.jpg").rgb);
}

io::Photo png_photo_with(const Image8& image, const std::string& profile_chunk) {
  const std::string png = io::encode_image(image, "png");
  const test::ScratchFolder folder;
  write_file(folder / "x.png", png.substr(0, 33) + profile_chunk + png.substr(33));
  return io::read_photo(folder / "x.png");
}

TEST(ColorProfile, InAPng) {
  const Image8 image = random_image();
  const std::string profile = icc_profile(display_p3_primaries(), srgb_curve());
  const std::string name("Display P3\0\0", 12);
  const std::string packed = test::zlib_stored(profile);
  EXPECT_EQ(png_photo_with(image, test::png_chunk("iCCP", name + packed)).rgb,
            photo_with(image, profile).rgb);
  EXPECT_NE(photo_with(image, profile).rgb, image);
  // Half of it, none of it, no end of the name, another kind of packing: as without.
  for (const std::string& bad : {name + packed.substr(0, packed.size() / 2), name, std::string("Display"),
                                 std::string("Display P3\0\x01", 12) + packed, std::string()})
    EXPECT_EQ(png_photo_with(image, test::png_chunk("iCCP", bad)).rgb, image);
}

TEST(ColorProfile, SixteenBitsAreConvertedInFull) {
  // So narrow a range of greys that bytes have three of them.
  test::TiffBuilder tiff(false);
  constexpr int width = 200;
  std::string samples;
  for (int x = 0; x < width; ++x)
    for (int c = 0; c < 3; ++c) samples += raw(static_cast<std::uint16_t>(20000 + 3 * x), false);
  tiff.add_long(256, width);
  tiff.add_long(257, 1);
  tiff.add_shorts(258, {16, 16, 16});
  tiff.add_short(259, 1);
  tiff.add_short(262, 2);
  tiff.add_short(277, 3);
  tiff.add_long(278, 1);
  tiff.add_undefined(34675, icc_profile(srgb_primaries(), gamma_curve(1.8)));
  tiff.add_pixels(samples);
  const test::ScratchFolder folder;
  write_file(folder / "x.tif", tiff.bytes());
  const io::Photo photo = io::read_photo(folder / "x.tif", true);
  ASSERT_EQ(photo.deep_rgb.width(), width);
  for (int x = 0; x < width; ++x) {
    const double truth = 65535 * encoded(std::pow((20000 + 3 * x) / 65535.0, 1.80078125));
    for (int c = 0; c < 3; ++c) {
      EXPECT_NEAR(photo.deep_rgb.at(x, 0, c), truth, 3) << x;  // primaries have five digits
      EXPECT_NEAR(photo.rgb.at(x, 0, c), truth / 257, 0.51);
    }
  }
}

TEST(ColorProfile, DamagedProfilesNeverHurt) {
  const Image8 image(2, 2, 3, 100);
  const std::string good = icc_profile(display_p3_primaries(), gamma_curve(2.2));
  Rng rng(5);
  for (int i = 0; i < 300; ++i) {
    std::string bad = good;
    for (int k = 0; k < 3; ++k) bad[128 + rng.below(bad.size() - 128)] = static_cast<char>(rng.below(256));
    EXPECT_EQ(photo_with(image, bad).rgb.width(), 2);
  }
  for (std::size_t size = 5; size < good.size(); size += 3) {
    EXPECT_EQ(photo_with(image, good.substr(0, size)).rgb.width(), 2) << size;
  }
  EXPECT_EQ(photo_with(image, "no profile at all").rgb, image);
}

}  // namespace
}  // namespace drape
