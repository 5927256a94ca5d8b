// The README's table of formats is the one that the readers use.
#include <gtest/gtest.h>

#include "drape/base/files.hpp"
#include "drape/io/scan_files.hpp"
#include "support.hpp"

namespace drape {
namespace {

TEST(Readme, ListsTheScanFormatsAsTheReadersDo) {
  const std::string readme = read_file(test::source("README.md"));
  for (const io::ScanFormatFacts& facts : io::scan_format_facts()) {
    std::string row = "| " + std::string(facts.name) + " | `.";
    for (const char c : facts.extensions) row += c == ' ' ? std::string("` `.") : std::string(1, c);
    row += "` | " + std::string(facts.reads) + " | " + std::string(facts.keeps) + " | " +
           (facts.written ? "yes" : "") + " |";
    EXPECT_NE(readme.find(row), std::string::npos) << row;
  }
}

}  // namespace
}  // namespace drape
