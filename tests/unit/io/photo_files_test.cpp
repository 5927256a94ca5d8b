// The kinds of picture files that users bring, whole and damaged.
#include <gtest/gtest.h>

#include <cmath>

#include "drape/base/files.hpp"
#include "drape/base/random.hpp"
#include "drape/io/photo.hpp"
#include "picture_bytes.hpp"
#include "support.hpp"

namespace drape {
namespace {

using test::error_message;
using test::raw;
using test::ScratchFolder;
using test::TiffBuilder;
using Bytes = std::vector<std::uint8_t>;

io::Photo photo_of(const std::string& bytes, const std::string& name = "x") {
  const ScratchFolder folder;
  write_file(folder / name, bytes);
  const io::Photo photo = io::read_photo(folder / name);
  const io::ImageSize size = io::read_photo_size(folder / name);
  EXPECT_EQ(size.width, photo.rgb.width());
  EXPECT_EQ(size.height, photo.rgb.height());
  return photo;
}

std::string problem(const std::string& bytes, const std::string& name = "x") {
  const ScratchFolder folder;
  write_file(folder / name, bytes);
  return error_message(ErrorCode::input, [&] { (void)io::read_photo(folder / name); });
}

/// True if it reads as a picture, false for an Error{input}; anything else escapes and fails the test.
bool reads(const ScratchFolder& folder, const std::string& bytes) {
  // Replacing a file makes some file systems flush it; a new one does not.
  std::filesystem::remove(folder / "x");
  write_file(folder / "x", bytes);
  try {
    (void)io::read_photo(folder / "x");
    return true;
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::input) << error.what();
    return false;
  }
}

Image8 smooth(int width, int height) {
  Image8 image(width, height, 3);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      image.at(x, y, 0) = static_cast<std::uint8_t>(255 * x / width);
      image.at(x, y, 1) = static_cast<std::uint8_t>(255 * y / height);
      image.at(x, y, 2) = 90;
    }
  return image;
}

TiffBuilder orientation_tag(int orientation, bool big_endian) {
  TiffBuilder tiff(big_endian);
  tiff.add_short(274, static_cast<std::uint16_t>(orientation));
  return tiff;
}

/// An uncompressed TIFF of 8-bit RGB.
std::string tiff_file(const Image8& image, int orientation, bool big_endian) {
  TiffBuilder tiff(big_endian);
  tiff.add_long(256, static_cast<std::uint32_t>(image.width()));
  tiff.add_long(257, static_cast<std::uint32_t>(image.height()));
  tiff.add_shorts(258, {8, 8, 8});
  tiff.add_short(259, 1);
  tiff.add_short(262, 2);
  tiff.add_short(274, static_cast<std::uint16_t>(orientation));
  tiff.add_short(277, 3);
  tiff.add_long(278, static_cast<std::uint32_t>(image.height()));
  tiff.add_pixels(std::string(image.data().begin(), image.data().end()));
  return tiff.bytes();
}

/// The standard's own words: where the stored row 0 and column 0 are in the upright picture.
Image8 upright_by_definition(const Image8& stored, int orientation) {
  static const std::array<std::pair<char, char>, 8> sides{
      {{'t', 'l'}, {'t', 'r'}, {'b', 'r'}, {'b', 'l'}, {'l', 't'}, {'r', 't'}, {'r', 'b'}, {'l', 'b'}}};
  const auto [row_side, column_side] = sides[static_cast<std::size_t>(orientation - 1)];
  const bool turned = row_side == 'l' || row_side == 'r';
  Image8 image(turned ? stored.height() : stored.width(), turned ? stored.width() : stored.height(), 3);
  for (int row = 0; row < stored.height(); ++row)
    for (int column = 0; column < stored.width(); ++column) {
      int x = 0, y = 0;
      for (const auto& [side, distance] : {std::pair{row_side, row}, std::pair{column_side, column}}) {
        if (side == 't') y = distance;
        if (side == 'b') y = image.height() - 1 - distance;
        if (side == 'l') x = distance;
        if (side == 'r') x = image.width() - 1 - distance;
      }
      for (int c = 0; c < 3; ++c) image.at(x, y, c) = stored.at(column, row, c);
    }
  return image;
}

TEST(PhotoFiles, EveryOrientationOfEveryFormat) {
  const Image8 stored = smooth(6, 4);
  for (int orientation = 1; orientation <= 8; ++orientation) {
    const Image8 upright = upright_by_definition(stored, orientation);
    for (const bool big : {false, true}) {
      const std::string exif = orientation_tag(orientation, big).bytes();
      const std::string png = io::encode_image(stored, "png");
      EXPECT_EQ(photo_of(png.substr(0, 33) + test::png_chunk("eXIf", exif) + png.substr(33)).rgb, upright)
          << "PNG " << orientation;
      EXPECT_EQ(photo_of(tiff_file(stored, orientation, big)).rgb, upright) << "TIFF " << orientation;
      const std::string jpeg = io::encode_image(stored, "jpg", 100);
      const Image8 decoded = photo_of(jpeg).rgb;
      EXPECT_EQ(photo_of(test::with_exif(jpeg, exif)).rgb, upright_by_definition(decoded, orientation))
          << "JPEG " << orientation;
    }
  }
}

TEST(PhotoFiles, PngOfEveryKind) {
  const auto expect = [](const std::string& bytes, const Bytes& rgb, const Bytes& alpha) {
    const io::Photo photo = photo_of(bytes);
    EXPECT_EQ(photo.rgb.data(), rgb);
    EXPECT_EQ(photo.alpha.data(), alpha);
  };
  using namespace std::string_literals;
  expect(test::png_file(2, 1, 8, 0, {"\x10\xFF"}), {16, 16, 16, 255, 255, 255}, {});
  expect(test::png_file(2, 1, 8, 4, {"\x10\xFF\x20\x80"}), {16, 16, 16, 32, 32, 32}, {255, 128});
  expect(test::png_file(1, 1, 8, 6, {"\x01\x02\x03\x00"s}), {1, 2, 3}, {0});
  expect(test::png_file(1, 1, 8, 6, {"\x01\x02\x03\xFF"s}), {1, 2, 3}, {});
  expect(test::png_file(4, 1, 1, 0, {"\x50"}), {0, 0, 0, 255, 255, 255, 0, 0, 0, 255, 255, 255}, {});
  const std::string palette = test::png_chunk("PLTE", "\x01\x02\x03\xC8\xC9\xCA");
  expect(test::png_file(2, 1, 8, 3, {"\x01\x00"s}, palette), {200, 201, 202, 1, 2, 3}, {});
  expect(test::png_file(2, 1, 8, 3, {"\x01\x00"s}, palette + test::png_chunk("tRNS", "\x07")),
         {200, 201, 202, 1, 2, 3}, {255, 7});
  // 16 bit: v * 255 / 65535, rounded. 0x8080 is exactly 128; 0x80FF is 128.49; 0x8101 is 128.502.
  expect(test::png_file(4, 1, 16, 0, {"\x80\x80\x80\xFF\x81\x01\xFF\xFF"}),
         {128, 128, 128, 128, 128, 128, 129, 129, 129, 255, 255, 255}, {});
  expect(test::png_file(1, 1, 16, 2, {"\x00\x7F\x00\x81\x01\x01"s}), {0, 1, 1}, {});
  expect(test::png_file(1, 1, 16, 6, {"\xFF\xFF\x00\x00\x80\x80\x40\x40"s}), {255, 0, 128}, {64});
}

TEST(PhotoFiles, PngSaysThatItsColoursAreSrgb) {
  using namespace std::string_literals;
  const std::string chunk = "\0\0\0\1sRGB\0\xAE\xCE\x1C\xE9"s;  // of the specification's own example
  const Image8 colors = smooth(8, 4);
  const std::string png = io::encode_image(colors, "png");
  EXPECT_EQ(png.find(chunk), 33U);
  EXPECT_LT(png.find(chunk), png.find("IDAT"));
  EXPECT_EQ(io::encode_image(Image8(8, 4, 4, 200), "png").find(chunk), 33U);
  const test::ScratchFolder folder;
  write_file(folder / "x.png", png);
  EXPECT_EQ(io::read_photo(folder / "x.png").rgb, colors);
  for (const std::string& other : {io::encode_image(Image8(8, 4, 1, 255), "png"),
                                   io::encode_image(colors, "png", 95, io::Samples::numbers)})
    EXPECT_EQ(other.find("sRGB"), std::string::npos);
}

TEST(PhotoFiles, StencilsOfEveryDepth) {
  const ScratchFolder folder;
  using namespace std::string_literals;
  for (const std::string& bytes :
       {test::png_file(2, 1, 1, 0, {"\x40"}), test::png_file(2, 1, 8, 0, {"\x00\x01"s}),
        test::png_file(2, 1, 8, 0, {"\x7F\x81"}), test::png_file(2, 1, 16, 0, {"\x00\x00\xFF\xFF"s}),
        test::png_file(2, 1, 16, 0, {"\x00\x00\x00\x01"s}), test::png_file(2, 1, 8, 4, {"\x33\x10\x33\xF0"}),
        test::png_file(2, 1, 8, 2, {"\xFF\x00\x00\xFF\xFF\x00"s})}) {
    write_file(folder / "m.png", bytes);
    EXPECT_EQ(io::read_stencil(folder / "m.png", 2, 1).data(), (Bytes{0, 255}));
  }
}

TEST(PhotoFiles, BmpPnmWebp) {
  using namespace std::string_literals;
  const Bytes expected{1, 2, 3, 250, 251, 252};
  const std::string bmp = "BM" + raw(std::uint32_t{54 + 8}, false) + std::string(4, '\0') +
                          raw(std::uint32_t{54}, false) + raw(std::uint32_t{40}, false) +
                          raw(std::int32_t{2}, false) + raw(std::int32_t{1}, false) +
                          raw(std::uint16_t{1}, false) + raw(std::uint16_t{24}, false) +
                          std::string(24, '\0') + "\x03\x02\x01\xFC\xFB\xFA\0\0"s;
  EXPECT_EQ(photo_of(bmp).rgb.data(), expected);
  EXPECT_EQ(photo_of("P6\n# made by hand\n2 1\n255\n\x01\x02\x03\xFA\xFB\xFC").rgb.data(), expected);
  EXPECT_EQ(photo_of("P3 2 1 255\n1 2 3\n250 251 252\n").rgb.data(), expected);
  EXPECT_EQ(photo_of("P5 2 1 255\n\x07\xFF").rgb.data(), (Bytes{7, 7, 7, 255, 255, 255}));
  EXPECT_EQ(photo_of("P5 1 1 65535\n\x80\x80").rgb.data(), (Bytes{128, 128, 128}));
  // A lossless WebP of one pixel.
  EXPECT_EQ(photo_of("RIFF\x1A\0\0\0WEBPVP8L\x0D\0\0\0\x2F\0\0\0\x10\x07\x10\x11\x11\x88\x88\xFE\x07\0"s)
                .rgb.width(),
            1);
  for (const std::string& bytes : {bmp, "P6 2 1 255\n\x01\x02\x03\xFA\xFB\xFC"s}) {
    EXPECT_NE(problem(bytes.substr(0, bytes.size() - 3)).find("truncated"), std::string::npos);
  }
  EXPECT_FALSE(problem("P6\n999999999 999999999\n255\nabc").empty());
  EXPECT_FALSE(problem("P6\n2 x").empty());
  EXPECT_FALSE(problem("BM").empty());
}

TEST(PhotoFiles, FocalLengthFromExif) {
  const std::string jpeg = io::encode_image(smooth(30, 20), "jpg");
  const auto focal = [&](auto fill, bool big = true) {
    TiffBuilder camera(big);
    fill(camera);
    TiffBuilder tiff(big);
    tiff.add_text(271, "Maker");
    tiff.add_text(272, "Maker X-1 ");
    tiff.add_directory(34665, camera);
    const io::Photo photo = photo_of(test::with_exif(jpeg, tiff.bytes()));
    EXPECT_EQ(photo.camera_model, "Maker X-1");
    return photo.focal_px_prior;
  };
  for (const bool big : {false, true}) {
    // 50 mm on film 36 mm wide: 50 / 36 of the longer side.
    EXPECT_NEAR(focal([](TiffBuilder& t) { t.add_short(41989, 50); }, big).value_or(0), 50.0 / 36 * 30, 1e-9);
    // 8 mm with 100 pixels to the millimetre, given per centimetre, of a picture that was 60 pixels wide.
    EXPECT_NEAR(focal(
                    [](TiffBuilder& t) {
                      t.add_ratio(37386, 80, 10);
                      t.add_long(40962, 60);
                      t.add_ratio(41486, 1000, 1);
                      t.add_short(41488, 3);
                    },
                    big)
                    .value_or(0),
                8.0 * 100 * 0.5, 1e-9);
  }
  // Inches where the unit is missing; the 35 mm value counts first.
  EXPECT_NEAR(focal([](TiffBuilder& t) {
                t.add_ratio(37386, 8, 1);
                t.add_ratio(41486, 254, 1);
              }).value_or(0),
              80, 1e-9);
  EXPECT_NEAR(focal([](TiffBuilder& t) {
                t.add_ratio(37386, 8, 1);
                t.add_ratio(41486, 254, 1);
                t.add_short(41989, 36);
              }).value_or(0),
              30, 1e-9);
  // What makes no sense is no prior.
  EXPECT_FALSE(focal([](TiffBuilder& t) { t.add_short(41989, 0); }));
  EXPECT_FALSE(focal([](TiffBuilder& t) { t.add_short(41989, 65000); }));
  EXPECT_FALSE(focal([](TiffBuilder& t) { t.add_ratio(37386, 8, 0); }));
  EXPECT_FALSE(focal([](TiffBuilder& t) { t.add_ratio(37386, 8, 1); }));
}

TEST(PhotoFiles, DamagedExifNeverHurts) {
  TiffBuilder camera(false);
  camera.add_short(41989, 50);
  camera.add_ratio(37386, 8, 1);
  TiffBuilder tiff(false);
  tiff.add_text(272, "A camera");
  tiff.add_short(274, 6);
  tiff.add_directory(34665, camera);
  const std::string good = tiff.bytes();
  const std::string jpeg = io::encode_image(smooth(8, 4), "jpg");
  const ScratchFolder folder;
  Rng rng(7);
  for (int i = 0; i < 600; ++i) {
    std::string bad = good;
    for (int k = 0; k < 3; ++k) bad[rng.below(bad.size())] = static_cast<char>(rng.below(256));
    EXPECT_TRUE(reads(folder, test::with_exif(jpeg, bad))) << i;
  }
  for (std::size_t size = 0; size < good.size(); ++size)
    EXPECT_TRUE(reads(folder, test::with_exif(jpeg, good.substr(0, size)))) << size;
}

TEST(PhotoFiles, TruncatedAtEveryByteIsAnError) {
  const ScratchFolder folder;
  const Image8 image = smooth(20, 10);
  for (const std::string& good :
       {io::encode_image(image, "png"), io::encode_image(image, "jpg"), tiff_file(image, 1, false)}) {
    EXPECT_TRUE(reads(folder, good));
    for (std::size_t size = 0; size < good.size(); ++size) {
      // The last four bytes of a TIFF builder's file are pixels as well: nothing may be missing.
      EXPECT_FALSE(reads(folder, good.substr(0, size))) << "at " << size << " of " << good.size();
    }
  }
}

TEST(PhotoFiles, FlippedBytesAreErrorsOrPictures) {
  const ScratchFolder folder;
  const Image8 image = smooth(20, 10);
  for (const std::string& good :
       {io::encode_image(image, "png"), tiff_file(image, 1, true), std::string("P6 2 1 255\n123456")})
    for (std::size_t at = 0; at<good.size(); at += good.size()> 400 ? 3 : 1) {
      std::string bad = good;
      bad[at] = static_cast<char>(bad[at] ^ 0x5A);
      (void)reads(folder, bad);
    }
}

TEST(PhotoFiles, TooManyPixelsAreRefusedBeforeDecoding) {
  EXPECT_NE(problem(test::png_file(1U << 16, 1U << 16, 8, 2, {"abc"})).find("65536 x 65536 pixels"),
            std::string::npos);
  EXPECT_NE(problem(test::png_file(0x7FFFFFFF, 0x7FFFFFFF, 8, 2, {"abc"})).find("pixels"), std::string::npos);
  EXPECT_NE(problem(test::png_file(0, 5, 8, 2, {"abc"})).find("no pixels"), std::string::npos);
  EXPECT_FALSE(problem(test::png_file(1000, 1000, 8, 2, {"abc"})).empty());
}

TEST(PhotoFiles, FloatingPointPicturesAreRefused) {
  TiffBuilder tiff(false);
  tiff.add_long(256, 1);
  tiff.add_long(257, 1);
  tiff.add_short(258, 32);
  tiff.add_short(259, 1);
  tiff.add_short(262, 1);
  tiff.add_short(277, 1);
  tiff.add_long(278, 1);
  tiff.add_short(339, 3);
  tiff.add_pixels(raw(0.5F, false));
  EXPECT_NE(problem(tiff.bytes()).find("convert it to PNG"), std::string::npos);
}

TEST(PhotoFiles, WriteErrorsAreIoErrors) {
  const ScratchFolder folder;
  EXPECT_NE(
      error_message(ErrorCode::io, [&] { io::write_image(folder / "no/x.png", smooth(2, 2)); }).find("x.png"),
      std::string::npos);
  EXPECT_FALSE(
      error_message(ErrorCode::io, [&] { io::write_image(folder / "x.gif", smooth(2, 2)); }).empty());
}

TEST(PhotoFiles, RealPhotos) {
  for (const std::string name : {"photos/lmo/can.png", "photos/dino/dino0001.png", "segmentation/37073.jpg",
                                 "segmentation/llama.bmp"}) {
    if (!test::have_data(name)) GTEST_SKIP() << "needs " << name << " of DRAPE_TEST_DATA";
    const io::Photo photo = io::read_photo(test::data(name));
    EXPECT_GT(photo.rgb.width(), 300) << name;
    EXPECT_TRUE(photo.alpha.empty()) << name;
  }
}

}  // namespace
}  // namespace drape
