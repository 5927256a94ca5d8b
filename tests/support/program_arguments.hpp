// The command line of the programs that measure.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "drape/base/options.hpp"

namespace drape::test {

/// A program asks for what it knows; what is left when it has asked for everything is a mistake:
///
///   const int poses = arguments.integer("poses").value_or(20);  // --poses 20, --poses=20 or poses=20
///   const bool all = arguments.flag("all");                     // --all or all
///   arguments.read(options);                                    // name=value, as in a configuration
///   const std::vector<std::string> files = arguments.words();
///   arguments.finish();
///
/// Error{config} for a value that is none.
class ProgramArguments {
 public:
  explicit ProgramArguments(std::vector<std::string> texts) : texts_(std::move(texts)) {}

  [[nodiscard]] bool flag(const std::string& name);
  [[nodiscard]] std::optional<std::string> text(const std::string& name);
  [[nodiscard]] std::optional<int> integer(const std::string& name);
  /// Separated by commas; empty if not given.
  [[nodiscard]] std::vector<std::string> list(const std::string& name);
  /// What is neither a name nor a value; call it after all the others.
  [[nodiscard]] std::vector<std::string> words();

  /// Every `name=value` that is an option of the struct, by its describe().
  template <class Struct>
  void read(Struct& options) {
    read(options_of(options));
  }
  void read(const std::vector<Option>& options);

  /// Error{config} for the first text that nothing asked for.
  void finish() const;

 private:
  std::vector<std::string> texts_;
  std::vector<std::string> known_;
};

/// Runs `body` on a main's arguments. A drape::Error is printed: 64 for a wrong command line, else 1.
int measuring_main(int count, char** texts, const std::function<void(ProgramArguments&)>& body);

/// CPU seconds that the process has used, of all its threads.
[[nodiscard]] double cpu_seconds();

}  // namespace drape::test
