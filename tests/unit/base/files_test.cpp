#include "drape/base/files.hpp"

#include <gtest/gtest.h>

#include "drape/base/hash.hpp"
#include "support.hpp"

namespace drape {
namespace {

TEST(Files, WrittenThenReadBack) {
  const test::ScratchFolder folder;
  const std::string bytes("a\0b\n", 4);
  write_file(folder / "x.bin", bytes);
  EXPECT_EQ(read_file(folder / "x.bin"), bytes);
  EXPECT_FALSE(std::filesystem::exists(folder / "x.bin.writing"));
}

TEST(Files, ErrorsNameTheFile) {
  const test::ScratchFolder folder;
  EXPECT_NE(test::error_message(ErrorCode::input, [&] { (void)read_file(folder / "none.txt"); })
                .find("none.txt: no such file"),
            std::string::npos);
  EXPECT_NE(
      test::error_message(ErrorCode::input, [&] { (void)read_file(folder.path()); }).find("is a folder"),
      std::string::npos);
  EXPECT_NE(test::error_message(ErrorCode::io, [&] { write_file(folder / "no/such/folder.txt", "x"); })
                .find("folder.txt"),
            std::string::npos);
}

TEST(Files, AFailedWriterKeepsTheOldFileAndLeavesNothing) {
  const test::ScratchFolder folder;
  write_file(folder / "x", "old");
  EXPECT_THROW(write_file_aside(folder / "x",
                                [](const std::filesystem::path& aside) {
                                  write_file(aside, "half");
                                  throw std::runtime_error("no more");
                                }),
               std::runtime_error);
  EXPECT_EQ(read_file(folder / "x"), "old");
  EXPECT_FALSE(std::filesystem::exists(folder / "x.writing"));
}

TEST(Files, ExtensionIsLowerCase) {
  EXPECT_EQ(extension("a/B.PLY"), "ply");
  EXPECT_EQ(extension("a/b"), "");
}

TEST(Hash, KnownDigests) {
  // FIPS 180-4's examples.
  EXPECT_EQ(sha256(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(sha256("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  const test::ScratchFolder folder;
  write_file(folder / "abc", "abc");
  EXPECT_EQ(sha256_file(folder / "abc"), sha256("abc"));
}

}  // namespace
}  // namespace drape
