#include "drape/io/photo.hpp"

#include <gtest/gtest.h>

#include "drape/base/files.hpp"
#include "support.hpp"

namespace drape {
namespace {

using test::error_message;
using test::ScratchFolder;

Image8 gradient(int width, int height, int channels) {
  Image8 image(width, height, channels);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      for (int c = 0; c < channels; ++c)
        image.at(x, y, c) = static_cast<std::uint8_t>((x * 7 + y * 31 + c * 80) % 256);
  return image;
}

TEST(Photo, PngReadsBackExactly) {
  const ScratchFolder folder;
  for (const int channels : {1, 3, 4}) {
    const Image8 image = gradient(13, 7, channels);
    io::write_image(folder / "x.png", image);
    const io::Photo photo = io::read_photo(folder / "x.png");
    ASSERT_EQ(photo.rgb.width(), 13);
    ASSERT_EQ(photo.rgb.height(), 7);
    ASSERT_EQ(photo.rgb.channels(), 3);
    EXPECT_EQ(photo.alpha.empty(), channels != 4);
    EXPECT_FALSE(photo.focal_px_prior);
    for (int y = 0; y < 7; ++y)
      for (int x = 0; x < 13; ++x) {
        for (int c = 0; c < 3; ++c) EXPECT_EQ(photo.rgb.at(x, y, c), image.at(x, y, channels == 1 ? 0 : c));
        if (channels == 4) {
          EXPECT_EQ(photo.alpha.at(x, y), image.at(x, y, 3));
        }
      }
    EXPECT_EQ(io::read_photo_size(folder / "x.png").width, 13);
    EXPECT_EQ(io::read_photo_size(folder / "x.png").height, 7);
  }
}

Image16 deep_gradient(int width, int height) {
  Image16 image(width, height, 3);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      for (int c = 0; c < 3; ++c)
        image.at(x, y, c) = static_cast<std::uint16_t>(257 * x + 8191 * y + 21845 * c);
  return image;
}

TEST(Photo, SixteenBitsAreKeptIfAskedFor) {
  const ScratchFolder folder;
  const Image16 image = deep_gradient(13, 7);
  io::write_tiff(folder / "x.tif", image);
  const io::Photo deep = io::read_photo(folder / "x.tif", true);
  EXPECT_EQ(deep.deep_rgb, image);
  EXPECT_EQ(deep.rgb, bytes_from_deep(image));
  const io::Photo plain = io::read_photo(folder / "x.tif");
  EXPECT_TRUE(plain.deep_rgb.empty());
  EXPECT_EQ(plain.rgb, deep.rgb);
  io::write_image(folder / "x.png", gradient(13, 7, 3));
  EXPECT_TRUE(io::read_photo(folder / "x.png", true).deep_rgb.empty());
}

TEST(Photo, StencilValues) {
  const ScratchFolder folder;
  Image8 image(3, 1, 1);
  image.data() = {0, 128, 255};
  io::write_image(folder / "s.png", image);
  EXPECT_EQ(io::read_stencil(folder / "s.png", 3, 1), image);
  image.data() = {10, 128, 127};
  io::write_image(folder / "s.png", image);
  EXPECT_EQ(io::read_stencil(folder / "s.png", 3, 1).data(), (std::vector<std::uint8_t>{0, 255, 0}));
  image.data() = {0, 1, 1};
  io::write_image(folder / "s.png", image);
  EXPECT_EQ(io::read_stencil(folder / "s.png", 3, 1).data(), (std::vector<std::uint8_t>{0, 255, 255}));
  Image8 cut_out(2, 1, 4, 255);
  cut_out.at(0, 0, 3) = 0;
  io::write_image(folder / "s.png", cut_out);
  EXPECT_EQ(io::read_stencil(folder / "s.png", 2, 1).data(), (std::vector<std::uint8_t>{0, 255}));
  EXPECT_NE(error_message(ErrorCode::input, [&] { (void)io::read_stencil(folder / "s.png", 1, 2); })
                .find("s.png: has 2 x 1"),
            std::string::npos);
}

TEST(Photo, RefusedByName) {
  const ScratchFolder folder;
  const auto problem = [&](const std::string& name, const std::string& bytes) {
    write_file(folder / name, bytes);
    return error_message(ErrorCode::input, [&] { (void)io::read_photo(folder / name); });
  };
  EXPECT_NE(problem("a.heic", std::string("\0\0\0\x18"
                                          "ftypheic\0\0\0\0",
                                          16))
                .find("heif-convert a.heic"),
            std::string::npos);
  EXPECT_NE(problem("a.jpg", std::string("\0\0\0\x18"
                                         "ftypmif1\0\0\0\0",
                                         16))
                .find("HEIC"),
            std::string::npos);
  EXPECT_NE(problem("a.avif", std::string("\0\0\0\x18"
                                          "ftypavif\0\0\0\0",
                                          16))
                .find("AVIF"),
            std::string::npos);
  EXPECT_NE(problem("a.cr3", std::string("\0\0\0\x18"
                                         "ftypcrx \0\0\0\0",
                                         16))
                .find("darktable-cli"),
            std::string::npos);
  EXPECT_NE(problem("a.CR2", std::string("II*\0\x10\0\0\0CR\2\0", 12)).find("darktable-cli"),
            std::string::npos);
  EXPECT_NE(problem("a.NEF", std::string("MM\0*\0\0\0\x08\0\0", 10)).find("RAW"), std::string::npos);
  EXPECT_NE(problem("a.raf", "FUJIFILMCCD-RAW 0201").find("RAW"), std::string::npos);
  EXPECT_NE(problem("a.png", "hello").find("is no picture"), std::string::npos);
  EXPECT_NE(problem("a.png", "").find("is empty"), std::string::npos);
  EXPECT_NE(error_message(ErrorCode::input, [&] { (void)io::read_photo(folder / "none.jpg"); })
                .find("no such file"),
            std::string::npos);
  EXPECT_NE(error_message(ErrorCode::input, [&] { (void)io::read_photo(folder.path()); }).find("is a folder"),
            std::string::npos);
}

}  // namespace
}  // namespace drape
