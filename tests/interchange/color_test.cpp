// Colours from a photo's file to the model's: against Little CMS, and a colour checker through the whole
// chain.
#include <gtest/gtest.h>
#include <lcms2.h>

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>

#include "drape/base/files.hpp"
#include "drape/base/random.hpp"
#include "drape/io/model_files.hpp"
#include "drape/io/photo.hpp"
#include "drape/texturing/texture_mesh.hpp"
#include "gltf_check.hpp"
#include "picture_bytes.hpp"
#include "support.hpp"

namespace drape::test {
namespace {

using Eigen::Vector3d;

struct ProfileEnd {
  void operator()(void* profile) const { cmsCloseProfile(profile); }
};
using Profile = std::unique_ptr<void, ProfileEnd>;

Profile profile_of(const cmsCIExyY& white, const cmsCIExyYTRIPLE& primaries, double gamma) {
  cmsToneCurve* curve = cmsBuildGamma(nullptr, gamma);
  std::array<cmsToneCurve*, 3> curves = {curve, curve, curve};
  Profile profile(cmsCreateRGBProfile(&white, &primaries, curves.data()));
  cmsFreeToneCurve(curve);
  return profile;
}
// Adobe RGB (1998) and ROMM RGB (ISO 22028-2), by their published primaries.
Profile adobe_rgb() {
  return profile_of({0.3127, 0.3290, 1}, {{0.64, 0.33, 1}, {0.21, 0.71, 1}, {0.15, 0.06, 1}}, 563.0 / 256);
}
Profile pro_photo() {
  return profile_of({0.3457, 0.3585, 1}, {{0.7347, 0.2653, 1}, {0.1596, 0.8404, 1}, {0.0366, 0.0001, 1}},
                    1.8);
}
std::string bytes_of(const Profile& profile) {
  cmsUInt32Number size = 0;
  cmsSaveProfileToMem(profile.get(), nullptr, &size);
  std::string bytes(size, '\0');
  cmsSaveProfileToMem(profile.get(), bytes.data(), &size);
  return bytes;
}

/// A TIFF of the colours (sRGB, 0..255) as a program would store them that works in the profile's space.
std::string tiff_in(const Profile& profile, const Image8& srgb, int bits) {
  const Profile standard(cmsCreate_sRGBProfile());
  cmsHTRANSFORM transform = cmsCreateTransform(standard.get(), TYPE_RGB_DBL, profile.get(), TYPE_RGB_DBL,
                                               INTENT_RELATIVE_COLORIMETRIC, cmsFLAGS_NOOPTIMIZE);
  std::string samples;
  for (int y = 0; y < srgb.height(); ++y)
    for (int x = 0; x < srgb.width(); ++x) {
      const std::array<double, 3> from = {srgb.at(x, y, 0) / 255.0, srgb.at(x, y, 1) / 255.0,
                                          srgb.at(x, y, 2) / 255.0};
      std::array<double, 3> to{};
      cmsDoTransform(transform, from.data(), to.data(), 1);
      for (const double value : to) {
        const double most = bits == 16 ? 65535 : 255;
        const auto stored = static_cast<std::uint16_t>(std::lround(most * std::clamp(value, 0.0, 1.0)));
        samples += bits == 16 ? raw(stored, false) : raw(static_cast<std::uint8_t>(stored), false);
      }
    }
  cmsDeleteTransform(transform);
  const auto depth = static_cast<std::uint16_t>(bits);
  TiffBuilder tiff(false);
  tiff.add_long(256, static_cast<std::uint32_t>(srgb.width()));
  tiff.add_long(257, static_cast<std::uint32_t>(srgb.height()));
  tiff.add_shorts(258, {depth, depth, depth});
  tiff.add_short(259, 1);
  tiff.add_short(262, 2);
  tiff.add_short(277, 3);
  tiff.add_long(278, static_cast<std::uint32_t>(srgb.height()));
  tiff.add_undefined(34675, bytes_of(profile));
  tiff.add_pixels(samples);
  return tiff.bytes();
}

TEST(ColorProfile, AgreesWithLittleCms) {
  Rng rng(8);
  Image8 image(24, 24, 3);
  for (std::uint8_t& value : image.data()) value = static_cast<std::uint8_t>(20 + rng.below(220));
  const ScratchFolder folder;
  const Profile adobe = adobe_rgb();
  const Profile romm = pro_photo();
  for (const auto& [profile, bits, most] : {std::tuple(&adobe, 16, 1), std::tuple(&romm, 16, 1),
                                            // A byte step of strong green is several of faint red.
                                            std::tuple(&adobe, 8, 6)}) {
    std::filesystem::remove(folder / "x.tif");
    write_file(folder / "x.tif", tiff_in(*profile, image, bits));
    const Image8 read = io::read_photo(folder / "x.tif").rgb;
    int worst = 0;
    for (std::size_t i = 0; i < image.data().size(); ++i)
      worst = std::max(worst, std::abs(image.data()[i] - read.data()[i]));
    EXPECT_LE(worst, most) << bits << " bits";
  }
}

Vector3d lab_of(const Vector3d& srgb) {  // 0..255; to D65
  Vector3d linear;
  for (int c = 0; c < 3; ++c) {
    const double s = srgb[c] / 255;
    linear[c] = s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4);
  }
  const Eigen::Matrix3d xyz =
      (Eigen::Matrix3d() << 0.4124, 0.3576, 0.1805, 0.2126, 0.7152, 0.0722, 0.0193, 0.1192, 0.9505)
          .finished();
  const Vector3d t = (xyz * linear).cwiseQuotient(Vector3d(0.9505, 1, 1.089));
  const auto f = [](double v) { return v > 216.0 / 24389 ? std::cbrt(v) : (24389.0 / 27 * v + 16) / 116; };
  return {116 * f(t.y()) - 16, 500 * (f(t.x()) - f(t.y())), 200 * (f(t.y()) - f(t.z()))};
}

// CIEDE2000, as Sharma, Wu and Dalal write it ("The CIEDE2000 color-difference formula", 2005).
double delta_e(const Vector3d& one, const Vector3d& two) {
  constexpr double degree = std::numbers::pi / 180;
  const auto seventh = [](double c) {
    return std::sqrt(std::pow(c, 7) / (std::pow(c, 7) + std::pow(25.0, 7)));
  };
  const double mean = (std::hypot(one.y(), one.z()) + std::hypot(two.y(), two.z())) / 2;
  const double g = 0.5 * (1 - seventh(mean));
  const auto hue = [&](const Vector3d& lab) {
    const double h = std::atan2(lab.z(), (1 + g) * lab.y()) / degree;
    return h < 0 ? h + 360 : h;
  };
  const double c1 = std::hypot((1 + g) * one.y(), one.z());
  const double c2 = std::hypot((1 + g) * two.y(), two.z());
  const double h1 = hue(one);
  const double h2 = hue(two);
  double dh = c1 * c2 == 0 ? 0 : h2 - h1;
  if (dh > 180) dh -= 360;
  if (dh < -180) dh += 360;
  double h = h1 + h2;
  if (c1 * c2 != 0) h = std::abs(h1 - h2) <= 180 ? h / 2 : h < 360 ? h / 2 + 180 : h / 2 - 180;
  const double l = (one.x() + two.x()) / 2;
  const double c = (c1 + c2) / 2;
  const double t = 1 - 0.17 * std::cos((h - 30) * degree) + 0.24 * std::cos(2 * h * degree) +
                   0.32 * std::cos((3 * h + 6) * degree) - 0.2 * std::cos((4 * h - 63) * degree);
  const double sl = 1 + 0.015 * (l - 50) * (l - 50) / std::sqrt(20 + (l - 50) * (l - 50));
  const double sc = 1 + 0.045 * c;
  const double sh = 1 + 0.015 * c * t;
  const double turn = -std::sin(2 * 30 * std::exp(-std::pow((h - 275) / 25, 2)) * degree) * 2 * seventh(c);
  const double x = (two.x() - one.x()) / sl;
  const double y = (c2 - c1) / sc;
  const double z = 2 * std::sqrt(c1 * c2) * std::sin(dh / 2 * degree) / sh;
  return std::sqrt(x * x + y * y + z * z + turn * y * z);
}

TEST(DeltaE, IsThatOfThePublishedPairs) {
  EXPECT_NEAR(delta_e({50, 2.6772, -79.7751}, {50, 0, -82.7485}), 2.0425, 1e-4);
  EXPECT_NEAR(delta_e({50, 2.5, 0}, {73, 25, -18}), 27.1492, 1e-4);
  EXPECT_NEAR(delta_e({2.0776, 0.0795, -1.1350}, {0.9033, -0.0636, -0.5514}), 0.9082, 1e-4);
}

// The 24 patches of the chart, sRGB.
constexpr std::array<std::array<int, 3>, 24> patches = {
    {{115, 82, 68},   {194, 150, 130}, {98, 122, 157},  {87, 108, 67},   {133, 128, 177}, {103, 189, 170},
     {214, 126, 44},  {80, 91, 166},   {193, 90, 99},   {94, 60, 108},   {157, 188, 64},  {224, 163, 46},
     {56, 61, 150},   {70, 148, 73},   {175, 54, 60},   {231, 199, 31},  {187, 86, 149},  {8, 133, 161},
     {243, 243, 242}, {200, 200, 200}, {160, 160, 160}, {122, 122, 121}, {85, 85, 85},    {52, 52, 52}}};
constexpr int patch_px = 40;

Image8 chart() {
  Image8 image(6 * patch_px, 4 * patch_px, 3);
  for (int y = 0; y < image.height(); ++y)
    for (int x = 0; x < image.width(); ++x)
      for (int c = 0; c < 3; ++c)
        image.at(x, y, c) = static_cast<std::uint8_t>(
            patches[static_cast<std::size_t>(y / patch_px * 6 + x / patch_px)][static_cast<std::size_t>(c)]);
  return image;
}

// The chart as a plane of one square per patch, seen straight on.
TriangleMesh board() {
  TriangleMesh mesh;
  for (int y = 0; y <= 4; ++y)
    for (int x = 0; x <= 6; ++x) mesh.vertices.emplace_back(x, -y, 0);
  const auto at = [](int x, int y) { return static_cast<std::uint32_t>(y * 7 + x); };
  for (int y = 0; y < 4; ++y)
    for (int x = 0; x < 6; ++x) {
      mesh.faces.push_back({at(x, y), at(x, y + 1), at(x + 1, y + 1)});
      mesh.faces.push_back({at(x, y), at(x + 1, y + 1), at(x + 1, y)});
    }
  return mesh;
}
Camera straight_on(double scale) {
  Camera camera;
  camera.projection = Camera::Projection::orthographic;
  camera.width = static_cast<int>(6 * patch_px * scale);
  camera.height = static_cast<int>(4 * patch_px * scale);
  camera.K << patch_px * scale, 0, 0, 0, patch_px * scale, 0, 0, 0, 1;
  camera.camera_from_world.linear() = Vector3d(1, -1, -1).asDiagonal();
  camera.camera_from_world.translation() = Vector3d(0, 0, 10);
  return camera;
}

TEST(ColorChecker, KeepsEveryPatchFromTheFileToTheModel) {
  const ScratchFolder folder;
  write_file(folder / "chart.tif", tiff_in(adobe_rgb(), chart(), 16));
  const io::Photo photo = io::read_photo(folder / "chart.tif");
  const TriangleMesh mesh = board();
  const Camera camera = straight_on(1);
  const Image8 stencil(camera.width, camera.height, 1, stencil::object);
  for (const texturing::TextureMode mode : {texturing::TextureMode::project, texturing::TextureMode::atlas})
    for (const bool jpeg : {false, true}) {
      texturing::TextureOptions options;
      options.mode = mode;
      options.level_seams = false;
      const texturing::TextureResult result = texturing::texture_mesh(
          mesh, mesh, std::vector<texturing::TextureView>{{photo.rgb, camera, stencil, "chart"}}, options);
      io::GlbOptions glb;
      glb.jpeg_textures = jpeg;
      io::write_glb(folder / "chart.glb", result.model, Eigen::Affine3d::Identity(), {0, 0, 0}, glb);
      double worst = 0;
      std::size_t seen = 0;
      for (const GltfPrimitive& p : read_gltf(folder / "chart.glb").primitives) {
        if (p.image.empty()) continue;
        std::filesystem::remove(folder / "texture");
        write_file(folder / "texture", p.image);
        const Image8 texture = io::read_photo(folder / "texture").rgb;
        for (std::size_t i = 0; i < p.indices.size(); i += 3) {
          Eigen::Vector3f x = Eigen::Vector3f::Zero();
          Eigen::Vector2f uv = Eigen::Vector2f::Zero();
          for (std::size_t k = 0; k < 3; ++k) {
            x += p.positions[p.indices[i + k]] / 3;
            uv += p.uvs[p.indices[i + k]] / 3;
          }
          const auto patch = static_cast<std::size_t>(std::floor(-x.y()) * 6 + std::floor(x.x()));
          const auto u = static_cast<int>(uv.x() * static_cast<float>(texture.width()));
          const auto v = static_cast<int>(uv.y() * static_cast<float>(texture.height()));
          const Vector3d shown(texture.at(u, v, 0), texture.at(u, v, 1), texture.at(u, v, 2));
          const Vector3d truth(patches[patch][0], patches[patch][1], patches[patch][2]);
          worst = std::max(worst, delta_e(lab_of(shown), lab_of(truth)));
          ++seen;
        }
      }
      EXPECT_GE(seen, 48U);
      EXPECT_LT(worst, 1) << "jpeg " << jpeg;
    }
}

// What Little CMS makes of the largest difference to sRGB of a profile, in bytes.
double largest_difference_to_srgb(const std::string& icc) {
  const Profile profile(cmsOpenProfileFromMem(icc.data(), static_cast<cmsUInt32Number>(icc.size())));
  if (!profile) return std::numeric_limits<double>::infinity();
  const Profile standard(cmsCreate_sRGBProfile());
  cmsHTRANSFORM transform = cmsCreateTransform(profile.get(), TYPE_RGB_DBL, standard.get(), TYPE_RGB_DBL,
                                               INTENT_RELATIVE_COLORIMETRIC, cmsFLAGS_NOOPTIMIZE);
  double worst = 0;
  Rng rng(4);
  for (int i = 0; i < 1000; ++i) {
    const std::array<double, 3> from = {rng.uniform(), rng.uniform(), rng.uniform()};
    std::array<double, 3> to{};
    cmsDoTransform(transform, from.data(), to.data(), 1);
    for (std::size_t k = 0; k < 3; ++k) worst = std::max(worst, 255 * std::abs(to[k] - from[k]));
  }
  cmsDeleteTransform(transform);
  return worst;
}

std::uint32_t little_endian(const std::string& bytes, std::size_t at, std::size_t size) {
  std::uint32_t value = 0;
  for (std::size_t i = size; i-- > 0;) value = value << 8 | static_cast<unsigned char>(bytes.at(at + i));
  return value;
}

/// The profile of a TIFF's first directory (tag 34675); tags have to rise.
std::string profile_of_tiff(const std::string& tiff) {
  EXPECT_EQ(tiff.substr(0, 2), "II");
  const std::size_t directory = little_endian(tiff, 4, 4);
  std::uint32_t before = 0;
  std::string profile;
  for (std::uint32_t i = 0; i < little_endian(tiff, directory, 2); ++i) {
    const std::size_t at = directory + 2 + 12 * std::size_t{i};
    EXPECT_GT(little_endian(tiff, at, 2), before);
    before = little_endian(tiff, at, 2);
    if (before == 34675)
      profile = tiff.substr(little_endian(tiff, at + 8, 4), little_endian(tiff, at + 4, 4));
  }
  return profile;
}

TEST(WrittenPictures, SayThatTheirColoursAreSrgb) {
  const Image8 image = chart();
  const std::string jpeg = io::encode_image(image, "jpg");
  // JFIF's own segment comes first, and one of the profile follows.
  EXPECT_EQ(jpeg.substr(2, 2), "\xFF\xE0");
  const std::size_t mark = jpeg.find(std::string("ICC_PROFILE\0\1\1", 14));
  ASSERT_NE(mark, std::string::npos);
  const std::size_t size =
      256 * static_cast<unsigned char>(jpeg[mark - 2]) + static_cast<unsigned char>(jpeg[mark - 1]);
  EXPECT_EQ(jpeg.substr(mark - 4, 2), "\xFF\xE2");
  EXPECT_LT(largest_difference_to_srgb(jpeg.substr(mark + 14, size - 16)), 0.1);
  EXPECT_EQ(io::encode_image(image, "jpg"), jpeg);
  EXPECT_EQ(io::encode_image(image, "jpg", 95, io::Samples::numbers).find("ICC_PROFILE"), std::string::npos);

  const std::string png = io::encode_image(image, "png");
  EXPECT_EQ(png.substr(33, 13), std::string("\0\0\0\1sRGB\0\xAE\xCE\x1C\xE9", 13));
  EXPECT_EQ(io::encode_image(image, "png", 95, io::Samples::numbers).find("sRGB"), std::string::npos);

  const ScratchFolder folder;
  const Image16 deep = deep_from_bytes(image);
  io::write_tiff(folder / "x.tif", deep);
  EXPECT_LT(largest_difference_to_srgb(profile_of_tiff(read_file(folder / "x.tif"))), 0.1);
  EXPECT_EQ(io::read_photo(folder / "x.tif", true).deep_rgb, deep);
}

}  // namespace
}  // namespace drape::test
