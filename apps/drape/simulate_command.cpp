#include <fmt/format.h>

#include "commands.hpp"
#include "drape/base/error.hpp"
#include "drape/base/files.hpp"
#include "drape/pipeline/config.hpp"
#include "drape/simulation/simulation.hpp"

namespace drape::app {

void simulate_command(const SimulateArguments& arguments, const std::atomic<bool>& stop) {
  pipeline::ConfigNode root = pipeline::parse_yaml(read_file(arguments.spec), arguments.spec.string());
  for (const std::string& set : arguments.sets) {
    const std::size_t equals = set.find('=');
    if (equals == std::string::npos)
      throw config_error("--set {}: must be key=value, such as noise_m=0.0002", set);
    pipeline::set_value(root, std::string_view(set).substr(0, equals),
                        std::string_view(set).substr(equals + 1));
  }
  simulation::SimulationSpec spec;
  std::vector<std::string> problems;
  pipeline::assign_options(options_of(spec), root, "", problems);
  if (!problems.empty()) throw Error(ErrorCode::config, fmt::format("{}", fmt::join(problems, "\n")));

  const std::filesystem::path folder =
      arguments.output.empty() ? arguments.spec.parent_path() / arguments.spec.stem() : arguments.output;
  ProgressDisplay display(arguments.progress);
  const Progress progress(
      [&](double fraction, std::string_view what) { display.show("simulate", fraction, what); }, &stop);
  simulation::simulate(spec, folder, progress);
  fmt::print("{}\n", folder.string());
}

}  // namespace drape::app
