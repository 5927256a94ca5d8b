#include <fmt/format.h>

#include <algorithm>

#include "map_reader.hpp"

namespace drape::pipeline {
namespace fs = std::filesystem;
namespace {

PhotoCamera read_photo_camera(const ConfigNode& node, const std::string& path, InputProblems& problems) {
  MapReader reader(node, path, photo_camera_keys(), problems);
  PhotoCamera camera;
  if (const auto focal = reader.numbers("focal_px", 1, 1); !focal.empty()) {
    if (focal[0] > 0)
      camera.focal_px = focal[0];
    else
      reader.wrong(*reader.find("focal_px"), "focal_px", "must be more than 0");
  }
  if (const auto k = reader.numbers("K", 9, 9); !k.empty()) {
    camera.K.emplace();
    std::copy(k.begin(), k.end(), camera.K->begin());
  }
  camera.distortion = reader.numbers("distortion", 4, 5);
  if (const auto initial = reader.numbers("initial", 12, 12); !initial.empty()) {
    camera.initial.emplace();
    std::copy(initial.begin(), initial.end(), camera.initial->begin());
  }
  const auto points = reader.numbers("points", 20, 5000);
  if (points.size() % 5 != 0)
    reader.wrong(*reader.find("points"), "points", "must be five numbers for each pair");
  for (std::size_t i = 0; i + 4 < points.size(); i += 5)
    camera.points.push_back({points[i], points[i + 1], points[i + 2], points[i + 3], points[i + 4]});
  if (camera.initial && !camera.points.empty())
    reader.wrong(*reader.find("points"), "points", "stand beside initial; leave one of them out");
  return camera;
}

PhotoStroke read_stroke(const ConfigNode& node, const std::string& path, InputProblems& problems) {
  MapReader reader(node, path, stroke_keys(), problems);
  PhotoStroke stroke;
  const ConfigNode* kind = reader.find("is");
  if (kind == nullptr || (kind->text != "object" && kind->text != "background"))
    problems.wrong.push_back(fmt::format("{}: {}.is: must be object or background", node.where.text(), path));
  else
    stroke.object = kind->text == "object";
  if (const auto width = reader.numbers("width_px", 1, 1); !width.empty()) {
    stroke.width_px = width[0];
    if (!(width[0] > 0)) reader.wrong(*reader.find("width_px"), "width_px", "must be more than 0");
  }
  const auto points = reader.numbers("points_px", 2, 100'000);
  if (reader.find("points_px") == nullptr)
    problems.wrong.push_back(fmt::format("{}: {}: has no points_px", node.where.text(), path));
  if (points.size() % 2 != 0)
    reader.wrong(*reader.find("points_px"), "points_px", "must be pairs of x and y");
  for (std::size_t i = 0; i + 1 < points.size(); i += 2)
    stroke.points_px.push_back({points[i], points[i + 1]});
  return stroke;
}

}  // namespace

PhotoInput read_photo_input(const ConfigNode& node, const std::string& path, const fs::path& folder,
                            InputProblems& problems) {
  PhotoInput photo;
  if (node.kind == ConfigNode::Kind::scalar) {  // a file name alone: no more is known of the photo
    ConfigNode map;
    map.kind = ConfigNode::Kind::map;
    map.where = node.where;
    map.keys.push_back({"image", node.where});
    map.items.push_back(node);
    photo.image = MapReader(map, path, photo_keys(), problems).file("image", folder);
    return photo;
  }
  MapReader reader(node, path, photo_keys(), problems);
  photo.image = reader.file("image", folder);
  if (photo.image.empty() && reader.find("image") == nullptr)
    problems.wrong.push_back(fmt::format("{}: {}: has no image", node.where.text(), path));
  photo.mask = reader.file("mask", folder);
  photo.scribbles = reader.file("scribbles", folder);
  photo.background = reader.file("background", folder);
  if (const auto box = reader.numbers("box_px", 4, 4); !box.empty()) {
    if (box[2] > 0 && box[3] > 0)
      photo.box_px = {box[0], box[1], box[2], box[3]};
    else
      reader.wrong(*reader.find("box_px"), "box_px", "width and height must be more than 0");
  }
  if (const auto click = reader.numbers("click_px", 2, 2); !click.empty())
    photo.click_px = {click[0], click[1]};
  if (const ConfigNode* strokes = reader.find("strokes"); strokes != nullptr) {
    if (strokes->kind != ConfigNode::Kind::sequence)
      reader.wrong(*strokes, "strokes", "must be a list");
    else
      for (std::size_t i = 0; i < strokes->items.size(); ++i)
        photo.strokes.push_back(
            read_stroke(strokes->items[i], fmt::format("{}.strokes[{}]", path, i), problems));
  }
  photo.segments = reader.numbers("segments", 1, 100'000);
  if (const ConfigNode* camera = reader.find("camera"); camera != nullptr)
    photo.camera = read_photo_camera(*camera, path + ".camera", problems);
  return photo;
}

}  // namespace drape::pipeline
