#include "drape/stages/stage_table.hpp"

#include <fmt/core.h>

#include "rows.hpp"

namespace drape::stages {

std::string three_digits(std::size_t number) {
  return fmt::format("{:03}", number);
}

std::vector<pipeline::Stage> stage_table() {
  return {ingest_stage(),  register_stage(), mesh_stage(),    fill_stage(),
          segment_stage(), align_stage(),    texture_stage(), export_stage()};
}

}  // namespace drape::stages
