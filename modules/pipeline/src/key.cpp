#include "drape/pipeline/key.hpp"

#include <fmt/core.h>

#include <algorithm>

#include "drape/base/hash.hpp"
#include "drape/base/options.hpp"

namespace drape::pipeline {
namespace fs = std::filesystem;
namespace {

class Parts {
 public:
  explicit Parts(FileDigests& digests) : digests_(digests) {}

  void add(std::string name, const OptionValue& value) {
    parts.push_back({std::move(name), canonical(value), readable(value)});
  }
  void add(std::string name, std::string text) {
    std::string copy = text;
    parts.push_back({std::move(name), std::move(text), std::move(copy)});
  }
  void add_file(const std::string& name, const fs::path& file) {
    if (file.empty()) return;
    const std::string& digest = digests_.of(file);
    // The base name is part of artifacts (scans.json, cameras.json); the folder is not.
    parts.push_back({name, file.filename().string() + " " + digest, file.filename().string()});
  }
  template <class Numbers>
  void add_numbers(const std::string& name, const Numbers& numbers) {
    add(name, OptionValue(std::vector<double>(numbers.begin(), numbers.end())));
  }

  std::vector<KeyPart> parts;

 private:
  FileDigests& digests_;
};

void add_photo_part(Parts& parts, const std::string& part, const PhotoInput& photo, const std::string& name) {
  if (part == "photos") parts.add_file(name + ".image", photo.image);
  if (part == "photo_regions") {
    parts.add_file(name + ".mask", photo.mask);
    parts.add_file(name + ".scribbles", photo.scribbles);
    parts.add_file(name + ".background", photo.background);
    if (photo.box_px) parts.add_numbers(name + ".box_px", *photo.box_px);
    if (photo.click_px) parts.add_numbers(name + ".click_px", *photo.click_px);
    for (std::size_t i = 0; i < photo.strokes.size(); ++i) {
      const PhotoStroke& stroke = photo.strokes[i];
      std::vector<double> numbers{stroke.object ? 1.0 : 0.0, stroke.width_px};
      for (const auto& point : stroke.points_px) numbers.insert(numbers.end(), point.begin(), point.end());
      parts.add_numbers(fmt::format("{}.strokes[{}]", name, i), numbers);
    }
    if (!photo.segments.empty()) parts.add_numbers(name + ".segments", photo.segments);
  }
  if (part == "photo_cameras") {
    if (photo.camera.focal_px) parts.add(name + ".camera.focal_px", OptionValue(*photo.camera.focal_px));
    if (photo.camera.K) parts.add_numbers(name + ".camera.K", *photo.camera.K);
    if (!photo.camera.distortion.empty())
      parts.add_numbers(name + ".camera.distortion", photo.camera.distortion);
    if (photo.camera.initial) parts.add_numbers(name + ".camera.initial", *photo.camera.initial);
    for (std::size_t i = 0; i < photo.camera.points.size(); ++i)
      parts.add_numbers(fmt::format("{}.camera.points[{}]", name, i), photo.camera.points[i]);
  }
}

void add_scan_part(Parts& parts, const Input& input) {
  for (std::size_t i = 0; i < input.scans.size(); ++i) {
    const ScanInput& scan = input.scans[i];
    const std::string name = fmt::format("input.scans[{}]", i);
    parts.add_file(name, scan.file);
    if (scan.metres_per_unit) parts.add(name + ".units", OptionValue(*scan.metres_per_unit));
    if (scan.world_from_scan) parts.add_numbers(name + ".transform", *scan.world_from_scan);
  }
  for (std::size_t i = 0; i < input.columns.size(); ++i)
    parts.add(fmt::format("input.columns[{}]", i), input.columns[i]);
  if (input.depth) {
    parts.add_numbers("input.depth.focal_px", input.depth->focal_px);
    if (input.depth->center_px) parts.add_numbers("input.depth.center_px", *input.depth->center_px);
    parts.add("input.depth.values_per_unit", OptionValue(input.depth->values_per_unit));
    parts.add("input.depth.depth", std::string(input.depth->along_ray ? "range" : "z"));
  }
  parts.add("input.max_points_per_scan", OptionValue(std::int64_t{input.max_points_per_scan}));
}

void add_input_part(Parts& parts, const std::string& part, const Input& input) {
  if (part == "scans") add_scan_part(parts, input);
  if (part == "poses") parts.add_file("input.poses", input.poses);
  if (part == "mesh") parts.add_file("input.mesh", input.mesh);
  if (part == "cameras") {
    parts.add_file("input.cameras", input.cameras);
    parts.add_file("input.cameras (beside it)", input.cameras_beside);
  }
  if (part == "units") {
    const auto metres = metres_per_unit(input.units);
    parts.add("input.units", metres ? OptionValue(*metres) : OptionValue(std::monostate{}));
  }
  if (part == "up") parts.add("input.up", std::string(1, input.up));
  for (std::size_t i = 0; i < input.photos.size(); ++i)
    add_photo_part(parts, part, input.photos[i], fmt::format("input.photos[{}]", i));
}

}  // namespace

std::vector<KeyPart> key_parts(const ConfiguredStage& configured, const Config& config,
                               const UpstreamDigests& upstream, FileDigests& digests) {
  Parts parts(digests);
  parts.add("version", OptionValue(std::int64_t{configured.stage->version}));
  parts.add("seed", OptionValue(static_cast<std::int64_t>(config.seed)));
  for (const Option& option : configured.instance.options) parts.add("option." + option.name, option.get());
  for (const std::string& part : configured.stage->input_parts) add_input_part(parts, part, config.input);
  for (const auto& [file, digest] : upstream) parts.add("file." + file, digest);
  return parts.parts;
}

std::string key_of(const std::string& stage, const std::vector<KeyPart>& parts) {
  // Lengths before texts: no two different lists of parts give the same bytes.
  Sha256 hash;
  const auto add = [&](const std::string& text) { hash.update(fmt::format("{}:{}\n", text.size(), text)); };
  add("drape stage key 1");
  add(stage);
  for (const KeyPart& part : parts) {
    add(part.name);
    add(part.value);
  }
  return hash.hex().substr(0, 32);
}

std::vector<std::string> differences(const std::string& stage, const std::vector<KeyPart>& before,
                                     const std::vector<KeyPart>& now) {
  const auto find = [](const std::vector<KeyPart>& parts, const std::string& name) -> const KeyPart* {
    const auto found =
        std::find_if(parts.begin(), parts.end(), [&](const KeyPart& p) { return p.name == name; });
    return found == parts.end() ? nullptr : &*found;
  };
  // "option.base" -> "option fill.base"; "file.mesh/mesh.ply" -> "mesh/mesh.ply"
  const auto title = [&](const std::string& name) {
    if (name.rfind("option.", 0) == 0) return fmt::format("option {}.{}", stage, name.substr(7));
    if (name.rfind("file.", 0) == 0) return name.substr(5);
    if (name.rfind("adopted.", 0) == 0) return fmt::format("the adopted {}/{}", stage, name.substr(8));
    if (name == "version") return fmt::format("the version of stage {}", stage);
    return name;
  };
  std::vector<std::string> lines;
  for (const KeyPart& part : now) {
    const KeyPart* old = find(before, part.name);
    if (old == nullptr)
      lines.push_back(fmt::format("{} is new", title(part.name)));
    else if (old->value != part.value && part.name.rfind("file.", 0) == 0)
      lines.push_back(fmt::format("{} has other contents", title(part.name)));
    else if (old->value != part.value && old->readable == part.readable)
      lines.push_back(fmt::format("{} ({}) has other contents", title(part.name), part.readable));
    else if (old->value != part.value)
      lines.push_back(fmt::format("{}: {} -> {}", title(part.name), old->readable, part.readable));
  }
  for (const KeyPart& part : before)
    if (find(now, part.name) == nullptr) lines.push_back(fmt::format("{} is gone", title(part.name)));
  return lines;
}

}  // namespace drape::pipeline
