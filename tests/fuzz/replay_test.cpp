// The corpus that fuzzing starts from, through the same entry.
#include <gtest/gtest.h>

#include "drape/base/files.hpp"
#include "scan_bytes.hpp"
#include "scan_entry.hpp"

namespace drape {
namespace {

TEST(FuzzReplay, EveryFileOfTheCorpusIsRead) {
  for (const test::ScanFile& file : test::scanner_files())
    EXPECT_TRUE(test::read_as_scan(file.name, file.bytes)) << file.name;
}

TEST(FuzzReplay, EveryFileAsEveryOtherFormat) {
  for (const test::ScanFile& file : test::scanner_files())
    for (const test::ScanFile& other : test::scanner_files())
      (void)test::read_as_scan(other.name, file.bytes);
}

}  // namespace
}  // namespace drape
