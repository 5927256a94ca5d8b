// What alignment costs, beside the thesis's method, its published figures, and other methods.
//
//   alignment_benchmark [--long] [--json FILE] [--parts thesis,peers,times]
//
// The short form takes a few minutes: one stencil a model, the first pass by 45 degrees, 30 CPU seconds a
// stencil at most. --long: three stencils, also the first pass by 20 degrees with a tenth of its list, 600
// seconds at most; that takes hours.
#include <fmt/core.h>

#include <algorithm>
#include <string>
#include <vector>

#include "alignment/peer_table.hpp"
#include "alignment/thesis_tables.hpp"
#include "drape/base/error.hpp"
#include "drape/base/files.hpp"
#include "drape/base/parallel.hpp"
#include "program_arguments.hpp"

namespace drape::lab {
namespace {

void run(test::ProgramArguments& arguments) {
  const bool all = arguments.flag("long");
  const std::string file = arguments.text("json").value_or("");
  const std::vector<std::string> parts = arguments.list("parts");
  for (const std::string& part : parts)
    if (part != "thesis" && part != "peers" && part != "times")
      throw config_error("there is no part {}; there are thesis, peers, times", part);
  arguments.finish();
  const auto has = [&](const std::string& part) {
    return parts.empty() || std::find(parts.begin(), parts.end(), part) != parts.end();
  };
  set_thread_count(1);
  nlohmann::json json;
  if (has("times")) json["times"] = print_times(all ? 20 : 5);
  if (has("thesis")) {
    print_model_sizes();
    json["table_5_2"] = print_thesis_table({45, 100, all ? 3 : 1, all ? 600.0 : 30.0});
    if (all) json["table_5_3"] = print_thesis_table({20, 10, 3, 600});
  }
  if (has("peers")) json["peers"] = print_peer_table(all ? 10 : 2);
  if (!file.empty()) write_file(file, json.dump(2) + "\n");
}

}  // namespace
}  // namespace drape::lab

int main(int count, char** texts) {
  return drape::test::measuring_main(count, texts, drape::lab::run);
}
