// Starts drape as a user does, and catches what it says.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace drape::test {

struct Outcome {
  int exit_code = -1;  // 128 + signal if one ended it
  std::string out;
  std::string err;
};

/// Runs the program with these arguments in `folder`, and waits for it.
[[nodiscard]] Outcome run_drape(const std::vector<std::string>& arguments,
                                const std::filesystem::path& folder = std::filesystem::temp_directory_path());

/// The same, but sends `signal` as soon as the file or folder `begun` is there.
[[nodiscard]] Outcome run_drape_and_signal(const std::vector<std::string>& arguments,
                                           const std::filesystem::path& folder, int signal,
                                           const std::filesystem::path& begun);

/// Names of the stages that made their result in this run, in order, by its plain progress lines ("[2/8]
/// register: ...").
[[nodiscard]] std::vector<std::string> stages_that_ran(const Outcome& outcome);

}  // namespace drape::test
