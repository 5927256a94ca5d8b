// What a run would do, as text.
#pragma once

#include <string>
#include <vector>

#include "drape/pipeline/engine.hpp"

namespace drape::app {

/// Prints the stages with reasons and expected times; only `stage` if it is not empty. Error{config} if there
/// is no such stage.
void print_forecast(const std::vector<pipeline::Forecast>& forecasts, const std::string& stage);

}  // namespace drape::app
