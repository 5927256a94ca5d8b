#include <fmt/core.h>

#include "commands.hpp"
#include "drape/base/error.hpp"
#include "drape/io/mesh_files.hpp"
#include "drape/pipeline/config.hpp"
#include "drape/stages/align_files.hpp"
#include "drape/stages/segment_files.hpp"
#include "photo_arguments.hpp"

namespace drape::app {
namespace {

alignment::AlignOptions options_with(const std::string& evidence) {
  alignment::AlignOptions options;
  if (evidence.empty()) return options;
  pipeline::ConfigNode section = pipeline::parse_yaml("{}", "--evidence");
  pipeline::set_value(section, "evidence", evidence);
  std::vector<std::string> problems;
  pipeline::assign_options(options_of(options), section, "align", problems);
  if (!problems.empty()) throw config_error("{}", problems.front());
  return options;
}

}  // namespace

void align_command(const AlignArguments& arguments, const std::atomic<bool>& stop) {
  const alignment::AlignOptions options = options_with(arguments.evidence);
  pipeline::Input input;
  pipeline::PhotoInput told;
  told.image = arguments.photo;
  told.mask = arguments.mask;
  told.box_px = numbers_of<4>(arguments.box);
  told.click_px = numbers_of<2>(arguments.click);
  input.photos = {told};
  const TriangleMesh mesh = io::read_mesh(arguments.mesh);
  stages::PhotoToAlign photo;
  photo.photo = io::read_photo(told.image);
  const std::filesystem::path folder = photo_folder(arguments.output, arguments.photo, "-aligned");

  ProgressDisplay display(arguments.progress);
  const Progress progress(
      [&](double fraction, std::string_view what) { display.show("align", fraction, what); }, &stop);
  const segmentation::Segmentation segmented =
      stages::write_segment_files(told, {}, 1, folder, progress.part(0, 0.3));
  photo.stencil = segmented.stencil;
  photo.stencil_confidence = segmented.confidence;
  photo.segments = segmented.labels;
  stages::AlignedPhoto aligned =
      stages::write_alignment_files(mesh, photo, input, options, 1, folder, progress.part(0.3, 1));
  aligned.record.stencil = "stencil.png";
  // The cameras are of the mesh as its file has it: neither scaled nor shifted.
  io::CamerasRecord record;
  record.cameras = {aligned.record};
  io::write_cameras(folder / "cameras.json", record);
  fmt::print("{} by its {}", to_string(aligned.record.verdict), aligned.record.evidence);
  for (const std::string& reason : aligned.record.reasons) fmt::print("; {}", reason);
  fmt::print("\n{}\n{}\n", (folder / "cameras.json").string(), (folder / "overlay.png").string());
}

}  // namespace drape::app
