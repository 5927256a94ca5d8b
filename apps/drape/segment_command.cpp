#include <fmt/core.h>

#include "commands.hpp"
#include "drape/base/error.hpp"
#include "drape/pipeline/config.hpp"
#include "drape/stages/segment_files.hpp"
#include "photo_arguments.hpp"

namespace drape::app {
void segment_command(const SegmentArguments& arguments, const std::atomic<bool>& stop) {
  segmentation::SegmentOptions options;
  if (!arguments.method.empty()) {
    pipeline::ConfigNode section = pipeline::parse_yaml("{}", "--method");
    pipeline::set_value(section, "method", arguments.method);
    std::vector<std::string> problems;
    pipeline::assign_options(options_of(options), section, "segment", problems);
    if (!problems.empty()) throw config_error("{}", problems.front());
  }
  pipeline::PhotoInput input;
  input.image = arguments.photo;
  input.mask = arguments.mask;
  input.scribbles = arguments.scribbles;
  input.background = arguments.background;
  input.box_px = numbers_of<4>(arguments.box);
  input.click_px = numbers_of<2>(arguments.click);
  const std::filesystem::path folder = photo_folder(arguments.output, arguments.photo, "-segments");
  ProgressDisplay display(arguments.progress);
  const Progress progress(
      [&](double fraction, std::string_view what) { display.show("segment", fraction, what); }, &stop);
  const segmentation::Segmentation found = stages::write_segment_files(input, options, 1, folder, progress);
  fmt::print("{} (confidence {:.2f})\n{}\n", found.how, found.confidence, (folder / "stencil.png").string());
}

}  // namespace drape::app
