// The `input:` section of a configuration: which files there are, and what is known of them.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace drape::pipeline {

/// Known intrinsics of a photo, for upright pixels.
struct PhotoCamera {
  std::optional<double> focal_px;
  std::optional<std::array<double, 9>> K;  // row by row
  std::vector<double> distortion;          // k1 k2 p1 p2 [k3], as OpenCV
  // About where it is, for the search to start from, in the input's coordinates and upright pixels:
  std::optional<std::array<double, 12>> initial;  // 3x4 projection matrix, row by row, or
  std::vector<std::array<double, 5>> points;      // x, y in the photo and X, Y, Z on the object
};

/// A line that a person drew over the photo.
struct PhotoStroke {
  bool object = true;  // else background
  double width_px = 1;
  std::vector<std::array<double, 2>> points_px;
};

struct PhotoInput {
  std::filesystem::path image;
  std::filesystem::path mask;                     // empty: none
  std::filesystem::path scribbles;                // marks of object and background; empty: none
  std::filesystem::path background;               // the same view without the object; empty: none
  std::optional<std::array<double, 4>> box_px;    // x, y, width, height
  std::optional<std::array<double, 2>> click_px;  // a point inside the object
  std::vector<PhotoStroke> strokes;
  std::vector<double> segments;  // labels of those that are the object; empty: not said
  PhotoCamera camera;
};

enum class Units { guess, metres, centimetres, millimetres, inches, feet };

struct ScanInput {
  std::filesystem::path file;
  std::optional<double> metres_per_unit;  // of this file, where it differs from `input.units`
  std::optional<std::array<double, 16>>
      world_from_scan;  // row by row, in the input's units; takes the file's place
};

/// What depth pictures among the scans mean.
struct DepthInput {
  std::array<double, 2> focal_px{};
  std::optional<std::array<double, 2>> center_px;
  double values_per_unit = 1;
  bool along_ray = false;
};

struct Input {
  std::vector<ScanInput> scans;      // globs expanded, sorted within a glob
  std::vector<std::string> columns;  // of scans as text; empty: guessed
  std::optional<DepthInput> depth;
  int max_points_per_scan = 50'000'000;  // 0: any number
  std::filesystem::path poses;           // empty: none
  Units units = Units::guess;            // of the scans or the mesh
  char up = 'z';                         // 'x', 'y' or 'z': the input's axis that points up
  std::filesystem::path mesh;            // instead of scans; empty: none
  std::filesystem::path cameras;         // known cameras; empty: none
  std::filesystem::path
      cameras_beside;  // the file that belongs to it: COLMAP's cameras.txt, Bundler's list.txt
  std::vector<PhotoInput> photos;
};

/// 1, 0.01, 0.001, 0.0254, 0.3048; nothing for `guess`.
[[nodiscard]] std::optional<double> metres_per_unit(Units units);

}  // namespace drape::pipeline
