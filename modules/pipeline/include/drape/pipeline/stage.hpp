// A stage: a row of the table that the engine runs. The pipeline knows names, files and options, never
// geometry.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "drape/base/options.hpp"
#include "drape/base/progress.hpp"
#include "drape/pipeline/input.hpp"

namespace drape::pipeline {

/// An artifact of a stage: "mesh/mesh.ply". A `*` stands for one path component: "ingest/scans/*.ply".
struct Artifact {
  std::string stage;
  std::string pattern;
};

using Metric = std::pair<std::string, std::variant<double, std::string>>;

/// What a running stage may ask of the engine and tell it.
class StageRun {
 public:
  virtual ~StageRun() = default;

  /// The input section, with absolute paths.
  [[nodiscard]] virtual const Input& input() const = 0;
  /// Committed file of an earlier stage; it must be named in `reads`. Error{bug} if it is not, or is not
  /// there.
  [[nodiscard]] virtual std::filesystem::path artifact(std::string_view stage,
                                                       std::string_view file) const = 0;
  [[nodiscard]] virtual bool has_artifact(std::string_view stage, std::string_view file) const = 0;
  /// Where to write a file of this stage: inside a folder that is committed when run returns. Parents are
  /// made.
  [[nodiscard]] virtual std::filesystem::path output(std::string_view file) = 0;
  [[nodiscard]] virtual const Progress& progress() const = 0;
  [[nodiscard]] virtual std::uint64_t seed() const = 0;
  /// A number or text for the run's record and the report; the unit is the name's suffix.
  virtual void metric(std::string name, std::variant<double, std::string> value) = 0;
  /// Makes the run's status `review` instead of `ok`, with the reason in words.
  virtual void needs_review(std::string reason) = 0;
};

struct Stage {
  std::string name;                      // the YAML section
  int version = 1;                       // bumped when equal inputs give other outputs
  std::string summary;                   // one line for help and the reference page
  std::vector<std::string> input_parts;  // members of `input:` that it reads: "scans", "poses", "mesh",
                                         // "cameras", "units", "up", "photos", "photo_regions" (mask,
                                         // scribbles, background, box, click), "photo_cameras"
  std::vector<Artifact> reads;
  std::vector<std::string> writes;            // file patterns
  std::function<bool(const Input&)> applies;  // whether a run with this input has the stage
  bool published = false;                     // its files are copied to the configuration's `output`

  /// A fresh options struct with its defaults, as options to set and as a function that runs the stage with
  /// them.
  struct Instance {
    std::vector<Option> options;
    std::function<void(StageRun&)> run;
  };
  std::function<Instance()> instantiate;
};

/// Ties a struct of options and an adapter to a row of the table.
template <class Options>
[[nodiscard]] std::function<Stage::Instance()> stage_body(void (*run)(const Options&, StageRun&)) {
  return [run] {
    auto options = std::make_shared<Options>();
    Stage::Instance instance;
    instance.options = options_of(*options);
    instance.run = [options, run](StageRun& stage_run) { run(*options, stage_run); };
    return instance;
  };
}

}  // namespace drape::pipeline
