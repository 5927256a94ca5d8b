// The command line of `drape batch ...` and `drape sweep`.
#pragma once

#include <CLI/CLI.hpp>
#include <atomic>
#include <functional>

#include "batch_command.hpp"

namespace drape::app {

/// Adds the commands; the one that was called puts what it will do into `action`. The references must outlive
/// `app`.
void add_batch_commands(CLI::App& app, BatchArguments& arguments, std::function<int()>& action,
                        const std::atomic<bool>& stop);

}  // namespace drape::app
