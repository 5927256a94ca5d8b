#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "commands.hpp"
#include "drape/base/error.hpp"
#include "drape/base/files.hpp"
#include "drape/io/photo.hpp"
#include "drape/io/scan_files.hpp"
#include "drape/stages/units.hpp"
#include "mesh_info.hpp"

namespace drape::app {
namespace fs = std::filesystem;
namespace {

std::string quoted(const fs::path& path) {
  std::string text = "\"";
  for (const char c : path.generic_string())
    text += (c == '"' || c == '\\') ? std::string("\\") + c : std::string(1, c);
  return text + "\"";
}

// What a look at the first file says.
struct Look {
  bool is_mesh = false;
  BoundingBox box;
};

Look look_at(const fs::path& file) {
  Look look;
  if (const std::optional<TriangleMesh> mesh = mesh_in(file)) {
    look.is_mesh = true;
    look.box = bounding_box(mesh->vertices);
    return look;
  }
  for (const RangeScan& scan : io::read_scans(file)) look.box.extend(bounding_box(scan.cloud.positions));
  return look;
}

struct Sources {
  std::vector<fs::path> scans;
  fs::path poses;
};

Sources sources_of(const std::vector<fs::path>& files) {
  Sources sources;
  for (const fs::path& file : files) {
    if (!fs::exists(file)) throw input_error("{}: no such file", file.string());
    if (io::is_pose_file(file))
      sources.poses = file;
    else
      sources.scans.push_back(file);
  }
  if (sources.scans.empty()) throw config_error("no scan was given, only poses");
  return sources;
}

std::string photo_lines(const fs::path& file, const fs::path& relative) {
  const io::Photo photo = io::read_photo(file);
  std::string yaml = fmt::format("    - image: {}  # {} x {} pixels", quoted(relative), photo.rgb.width(),
                                 photo.rgb.height());
  if (photo.focal_px_prior)
    yaml += fmt::format(", EXIF says a focal length of {:.0f} px", *photo.focal_px_prior);
  return yaml +
         "\n      # mask: \"mask.png\"           # if you have one: white where the object is\n"
         "      # box_px: [x, y, width, height]  # else a box round the object helps\n";
}

// The text of a configuration that will lie in `folder`.
std::string configuration(const NewArguments& arguments, const fs::path& folder) {
  const auto relative = [&](const fs::path& file) {
    return fs::absolute(file).lexically_normal().lexically_relative(folder);
  };
  const Sources sources = sources_of(arguments.scans);
  // Several files of one kind may hold faces too (a scanner's own meshes); only a single one is taken for a
  // finished mesh.
  const Look first = look_at(sources.scans.front());
  const bool is_mesh = first.is_mesh && sources.scans.size() == 1;

  std::string yaml = "# Every key that is not here has its default; config/REFERENCE.md lists all.\ninput:\n";
  if (is_mesh) {
    yaml += fmt::format("  mesh: {}\n", quoted(relative(sources.scans.front())));
  } else {
    yaml += "  scans:\n";
    for (const fs::path& scan : sources.scans) yaml += fmt::format("    - {}\n", quoted(relative(scan)));
    if (!sources.poses.empty()) yaml += fmt::format("  poses: {}\n", quoted(relative(sources.poses)));
  }
  const stages::UnitGuess guess = stages::guess_units(first.box);
  yaml += fmt::format("  units: {}  # guessed: {}; correct it if that is wrong\n", guess.name, guess.reason);
  yaml += "  up: z      # the axis that points up\n";
  if (!arguments.photos.empty()) yaml += "  photos:\n";
  for (const fs::path& file : arguments.photos) yaml += photo_lines(file, relative(file));
  return yaml;
}

}  // namespace

void new_command(const NewArguments& arguments) {
  if (!arguments.force && fs::exists(arguments.output))
    throw config_error("{}: is there already; --force writes over it", arguments.output.string());
  write_file(arguments.output, configuration(arguments, fs::absolute(arguments.output).parent_path()));
  fmt::print("{}\nnext: drape run {}\n", arguments.output.string(), arguments.output.string());
}

void make_command(const MakeArguments& arguments, const std::atomic<bool>& stop) {
  const fs::path folder = fs::absolute(arguments.create.output).lexically_normal();
  const fs::path file = folder / "drape.yaml";
  const std::string yaml = configuration(arguments.create, folder) + "output: model\n";
  if (fs::exists(file) && read_file(file) != yaml)
    throw config_error("{}: is there already, and says something else; run that with: drape run {}",
                       file.string(), file.string());
  make_folder(folder);
  write_file(file, yaml);
  RunArguments run = arguments.run;
  run.config = file;
  run_command(run, stop);
}

}  // namespace drape::app
