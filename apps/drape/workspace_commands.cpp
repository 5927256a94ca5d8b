// Commands on what earlier runs made: gc, diff, adopt.
#include <fmt/core.h>

#include <algorithm>
#include <ctime>

#include "commands.hpp"
#include "drape/base/error.hpp"
#include "drape/base/files.hpp"
#include "drape/base/numbers.hpp"
#include "drape/io/mesh_files.hpp"
#include "drape/io/photo.hpp"
#include "drape/io/records.hpp"
#include "drape/meshing/simplify.hpp"
#include "drape/pipeline/adoption.hpp"
#include "drape/pipeline/file_lock.hpp"
#include "drape/pipeline/garbage.hpp"
#include "drape/stages/comparison_report.hpp"
#include "drape/stages/stage_table.hpp"
#include "run_selection.hpp"

namespace drape::app {
namespace fs = std::filesystem;
namespace {

// "20GB", "500 MB", "1.5TB", or bytes.
std::uint64_t bytes_of(std::string text) {
  double factor = 1;
  for (const auto& [unit, bytes] : {std::pair{"KB", 1e3}, {"MB", 1e6}, {"GB", 1e9}, {"TB", 1e12}})
    if (text.size() > 2 && text.substr(text.size() - 2) == unit) {
      factor = bytes;
      text.resize(text.size() - 2);
      break;
    }
  while (!text.empty() && text.back() == ' ') text.pop_back();
  const auto number = parse_double(text);
  if (!number || !(*number >= 0) || *number * factor > 1e18)
    throw config_error("--max-size {}: must be a size such as 20GB or 500MB", text);
  return static_cast<std::uint64_t>(*number * factor);
}

double gigabytes(std::uint64_t bytes) {
  return static_cast<double>(bytes) / 1e9;
}

// What a stage's file is, so that another format can stand for it.
bool is_mesh(const std::string& file) {
  return extension(file) == "ply";
}

// The adopted file as the stage would have written it. Error{input} if it is not what it is meant to be.
void write_as(const fs::path& source, const std::string& file, const fs::path& target, const fs::path& own) {
  if (is_mesh(file)) {
    const TriangleMesh mesh = io::read_mesh(source);
    if (mesh.faces.empty()) throw input_error("{}: has no faces; it is no mesh", source.string());
    // Its bytes are kept where they can be: a reader of the format loses nothing.
    if (extension(source) == "ply")
      write_file(target, read_file(source));
    else
      io::write_mesh_ply(target, mesh);
    return;
  }
  if (extension(file) == "png") {
    const Image8 picture = io::read_photo(source).rgb;
    if (fs::exists(own)) {
      const Image8 before = io::read_photo(own).rgb;
      if (before.width() != picture.width() || before.height() != picture.height())
        throw input_error("{}: is {} x {}; the stage's own {} is {} x {}", source.string(), picture.width(),
                          picture.height(), file, before.width(), before.height());
    }
    if (extension(source) != "png") throw input_error("{}: must be a PNG, as {} is", source.string(), file);
  } else if (file == "cameras.json") {
    static_cast<void>(io::read_cameras(source));
  } else if (extension(source) != extension(file)) {
    throw input_error("{}: cannot stand for {}", source.string(), file);
  }
  write_file(target, read_file(source));
}

// The stage's file that the user's stands for: of the same name, else the only one of its kind.
std::string meant_file(const pipeline::StageRecord& own, const AdoptArguments& arguments) {
  std::string names;
  std::vector<std::string> same_kind;
  const std::string kind = extension(arguments.file);
  const bool mesh = kind == "obj" || kind == "stl" || kind == "off" || kind == "ply";
  for (const pipeline::StageFile& file : own.files) {
    names += (names.empty() ? "" : ", ") + file.name;
    if (file.name == arguments.as) return file.name;
    if (arguments.as.empty() && fs::path(file.name).filename() == arguments.file.filename())
      same_kind.insert(same_kind.begin(), file.name);
    else if (mesh ? is_mesh(file.name) : extension(file.name) == kind)
      same_kind.push_back(file.name);
  }
  const bool by_name = !same_kind.empty() && fs::path(same_kind[0]).filename() == arguments.file.filename();
  const auto of_name = std::count_if(same_kind.begin(), same_kind.end(), [&](const std::string& name) {
    return fs::path(name).filename() == arguments.file.filename();
  });
  if (arguments.as.empty() && ((by_name && of_name == 1) || same_kind.size() == 1)) return same_kind[0];
  throw config_error("{}: which of the stage's files does it stand for? Say it with --as: {}",
                     arguments.file.string(), names);
}

}  // namespace

void gc_command(const GcArguments& arguments) {
  const pipeline::Workspace workspace(workspace_of(arguments.where));
  std::optional<std::uint64_t> most;
  if (!arguments.max_size.empty()) most = bytes_of(arguments.max_size);
  const double min_age_s = arguments.min_age_hours * 3600;
  const pipeline::Garbage garbage = arguments.remove ? pipeline::remove_garbage(workspace, most, min_age_s)
                                                     : pipeline::find_garbage(workspace, most, min_age_s);
  for (const pipeline::Garbage::Item& item : garbage.items)
    fmt::print("{:>10.3f} MB  {}  ({})\n", static_cast<double>(item.bytes) / 1e6,
               item.path.lexically_relative(workspace.folder()).string(), item.why);
  fmt::print("{} {:.3f} GB in {} results; {:.3f} GB that runs link to stay, and {:.3f} GB without a run\n",
             arguments.remove ? "removed" : "would remove", gigabytes(garbage.garbage_bytes),
             garbage.items.size(), gigabytes(garbage.linked_bytes), gigabytes(garbage.kept_bytes));
  if (!arguments.remove && !garbage.items.empty()) fmt::print("nothing was removed: say --delete to do it\n");
}

void diff_command(const DiffArguments& arguments) {
  const SelectedRun a = select_run(arguments.a, arguments.workspace);
  const SelectedRun b = select_run(arguments.b, arguments.workspace);
  const std::size_t count =
      stages::write_run_comparison({a.workspace, a.record}, {b.workspace, b.record}, arguments.output);
  fmt::print("{} options, files or versions differ\nreport   {}\n", count, arguments.output.string());
}

void adopt_command(const AdoptArguments& arguments) {
  const SelectedRun run = select_run(arguments.run, arguments.workspace);
  const std::string& name = run.record.name;
  const auto lock =
      pipeline::FileLock::try_acquire(run.workspace.run_lock(name), pipeline::FileLock::Kind::exclusive);
  if (!lock) throw Error(ErrorCode::try_again, "run " + name + " is at work; try again when it is done");
  if (arguments.forget) {
    const std::size_t count = pipeline::forget_adoptions(run.workspace, name, arguments.stage);
    if (count == 0) throw config_error("run {} has adopted nothing for stage {}", name, arguments.stage);
    fmt::print("stage {} makes its own files again\nnext: drape run {}\n", arguments.stage,
               run.record.config_file);
    return;
  }
  const auto stage = std::find_if(run.record.stages.begin(), run.record.stages.end(),
                                  [&](const pipeline::RunStage& s) { return s.stage == arguments.stage; });
  const auto own =
      stage == run.record.stages.end() ? std::nullopt : run.workspace.find(stage->stage, stage->key);
  if (!own) throw config_error("run {} has no result of a stage {}; run it first", name, arguments.stage);
  const std::string file = meant_file(*own, arguments);
  const fs::path own_folder = run.workspace.stage_folder(stage->stage, stage->key);
  const fs::path scratch = run.workspace.run_folder(name) / "adopting";
  make_folder(scratch);
  const auto take = [&](const std::string& as, const fs::path& written) {
    pipeline::adopt(run.workspace, name, arguments.stage, as, written, fs::absolute(arguments.file).string());
    fmt::print("{}/{} is now {}\n", arguments.stage, as, arguments.file.string());
  };
  const fs::path written = scratch / ("adopted." + extension(file));
  write_as(arguments.file, file, written, own_folder / file);
  take(file, written);
  // Texturing takes the simplified mesh: it must be that of the adopted one.
  if (arguments.stage == "fill" && file == "mesh.ply") {
    std::size_t faces = io::read_mesh(own_folder / "mesh_simplified.ply").faces.size();
    if (const std::size_t whole = io::read_mesh(own_folder / "mesh.ply").faces.size(); faces == whole)
      faces = 0;
    const TriangleMesh mesh = io::read_mesh(written);
    const fs::path simplified = scratch / "simplified.ply";
    io::write_mesh_ply(simplified, faces == 0 ? mesh : meshing::simplified(mesh, {faces, 0}));
    take("mesh_simplified.ply", simplified);
  }
  fs::remove_all(scratch);
  fmt::print("next: drape run {}\n", run.record.config_file);
}

}  // namespace drape::app
