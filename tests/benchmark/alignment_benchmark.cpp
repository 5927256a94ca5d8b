// What alignment costs, beside the thesis's method, its published figures, and other methods.
//
//   alignment_benchmark [--long] [--limit SECONDS] [--json FILE] [--parts thesis,peers,times]
//
// The short form ends within three minutes: one stencil a model, the thesis's method stopped after 8 CPU
// seconds a stencil (printed as >8), and no peers unless they are asked for. --long: three stencils, 600
// seconds at most, more photos, and the peers; that takes hours. --limit: other seconds a stencil.
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
  const int limit_s = arguments.integer("limit").value_or(all ? 600 : 8);
  std::vector<std::string> parts = arguments.list("parts");
  for (const std::string& part : parts)
    if (part != "thesis" && part != "peers" && part != "times")
      throw config_error("there is no part {}; there are thesis, peers, times", part);
  arguments.finish();
  if (parts.empty())
    parts = all ? std::vector<std::string>{"times", "thesis", "peers"}
                : std::vector<std::string>{"times", "thesis"};
  const auto has = [&](const std::string& part) {
    return std::find(parts.begin(), parts.end(), part) != parts.end();
  };
  set_thread_count(1);
  nlohmann::json json;
  if (has("times")) json["times"] = print_times(all ? 20 : 3);
  if (has("thesis")) {
    print_model_sizes();
    const int stencils = all ? 3 : 1;
    json["table_5_2"] = print_thesis_table({45, 100, stencils, static_cast<double>(limit_s)});
    json["table_5_3"] = print_thesis_table({20, 10, stencils, static_cast<double>(limit_s)});
  }
  if (has("peers")) json["peers"] = print_peer_table(all ? 10 : 1);
  if (!file.empty()) write_file(file, json.dump(2) + "\n");
}

}  // namespace
}  // namespace drape::lab

int main(int count, char** texts) {
  return drape::test::measuring_main(count, texts, drape::lab::run);
}
