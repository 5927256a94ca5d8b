#include <fmt/core.h>

#include "commands.hpp"
#include "drape/base/files.hpp"
#include "drape/pipeline/reference.hpp"
#include "drape/stages/stage_table.hpp"

namespace drape::app {

bool reference_command(const std::filesystem::path& file, bool check) {
  const std::string page = pipeline::reference_page(stages::stage_table());
  if (check) return std::filesystem::exists(file) && read_file(file) == page;
  write_file(file, page);
  fmt::print("{}\n", file.string());
  return true;
}

}  // namespace drape::app
