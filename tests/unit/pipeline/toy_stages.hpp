// A table of small text stages, to test the engine with: words come in, get changed, counted, and published.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "drape/base/files.hpp"
#include "drape/pipeline/engine.hpp"
#include "support.hpp"

namespace drape::test {

/// `read` copies input.mesh's text (cut to option `words` words), `change` writes it in capitals or not,
/// `count` writes how many letters it has; it reads `read` only. `publish` joins both. `change` fails if
/// option `fail` is set.
[[nodiscard]] std::vector<pipeline::Stage> toy_stages();

/// A folder with text.txt and toy.yaml for these stages.
class ToyProject {
 public:
  ToyProject();
  void write_text(const std::string& text) const { write_file(folder_ / "text.txt", text); }
  void write_config(const std::string& sections) const;
  [[nodiscard]] pipeline::Config load(const std::vector<std::string>& sets = {}) const;
  /// Runs and returns the names of the stages that were made, in order, separated by spaces.
  std::string run(const std::vector<std::string>& sets = {}, pipeline::RunOptions options = {});
  [[nodiscard]] std::filesystem::path operator/(const std::string& name) const { return folder_ / name; }

  pipeline::RunResult last;

 private:
  ScratchFolder folder_;
  std::vector<pipeline::Stage> table_ = toy_stages();
};

}  // namespace drape::test
