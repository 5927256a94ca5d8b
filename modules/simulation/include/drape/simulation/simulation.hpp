// A whole data set from a description: scans, poses, photos, and the truth about them.
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "drape/base/options.hpp"
#include "drape/base/progress.hpp"
#include "drape/simulation/objects.hpp"
#include "drape/simulation/range_scanner.hpp"
#include "drape/simulation/virtual_camera.hpp"

namespace drape::simulation {

enum class FileUnits { metres, millimetres };

struct SimulationSpec {
  ObjectKind object = ObjectKind::teapot;
  double scale = 1;
  double mesh_detail = 1;
  FileUnits units = FileUnits::millimetres;

  Rays rays = Rays::diverging;
  int turntable_steps = 6;
  std::vector<double> scan_elevations_deg = {10, 50};
  double distance_m = 0.7;
  double pitch_m = 0.001;
  std::optional<int> scan_rows;
  std::optional<int> scan_columns;
  double noise_m = 0.0001;
  double max_incidence_deg = 75;
  double mixed_pixel_percent = 20;
  bool scan_intensity = false;
  bool scan_color = false;
  double pose_error_deg = 0.2;
  double pose_error_m = 0.0003;

  std::vector<double> photo_azimuths_deg = {-70};
  std::vector<double> photo_elevations_deg = {20};
  int photo_width = 1280;
  int photo_height = 960;
  double photo_fov_deg = 38;
  double photo_fill_percent = 90;
  double photo_roll_deg = 2;
  Table photo_table = Table::wood;
  bool photo_clutter = true;
  double photo_noise_percent = 1;

  int seed = 1;
};

inline void describe(Binder& b, SimulationSpec& o) {
  b.choice("object", o.object,
           {{"teapot", ObjectKind::teapot},
            {"statue", ObjectKind::statue},
            {"head", ObjectKind::head},
            {"machine_part", ObjectKind::machine_part},
            {"aircraft", ObjectKind::aircraft},
            {"vase", ObjectKind::vase},
            {"chair", ObjectKind::chair}},
           "what is scanned and photographed");
  b.number("scale", o.scale, {0.001, 1000},
           "the object's size: at 1 the teapot is 0.22 m long, the statue 0.33 m high");
  b.number("mesh_detail", o.mesh_detail, {0.8, 4}, "above 1: the object's mesh is that many times coarser");
  b.choice("units", o.units, {{"m", FileUnits::metres}, {"mm", FileUnits::millimetres}},
           "of the scan files, the poses beside them and the true mesh");
  b.choice("rays", o.rays, {{"diverging", Rays::diverging}, {"parallel", Rays::parallel}},
           "of the scanner: from one origin, or along one direction");
  b.number("turntable_steps", o.turntable_steps, {1, 360}, "scans round the object at each elevation");
  b.numbers("scan_elevations_deg", o.scan_elevations_deg, 0, {-90, 90},
            "the scanner's heights over the horizon; every other round starts half a step later");
  b.number("distance_m", o.distance_m, {0.001, 10000}, "from the scanner to the middle of the object");
  b.number("pitch_m", o.pitch_m, {1e-6, 100}, "spacing of the samples across the ray, at that distance");
  b.number("scan_rows", o.scan_rows, {1, 10000}, "lattice rows; auto: what the object needs from that side");
  b.number("scan_columns", o.scan_columns, {1, 10000},
           "lattice columns; auto: what the object needs from that side");
  b.number("noise_m", o.noise_m, {0, 10},
           "standard deviation along the ray at normal incidence; it grows as 1 / cosine");
  b.number("max_incidence_deg", o.max_incidence_deg, {1, 89},
           "surfaces that are more oblique return nothing");
  b.number("mixed_pixel_percent", o.mixed_pixel_percent, {0, 100},
           "of the samples beside a depth edge: they land between front and back");
  b.flag("scan_intensity", o.scan_intensity, "whether scans hold the strength of the return");
  b.flag("scan_color", o.scan_color, "whether scans hold colours");
  b.number("pose_error_deg", o.pose_error_deg, {0, 180},
           "how wrong the given poses are, but for the first scan's");
  b.number("pose_error_m", o.pose_error_m, {0, 1000}, "the same for their places");
  b.numbers("photo_azimuths_deg", o.photo_azimuths_deg, 0, {-360, 360},
            "one photo each: where the camera stands, from +x towards +y (the objects' fronts look to -90)");
  b.numbers("photo_elevations_deg", o.photo_elevations_deg, 0, {0, 90}, "one for each photo, or one for all");
  b.number("photo_width", o.photo_width, {16, 10000}, "in pixels");
  b.number("photo_height", o.photo_height, {16, 10000}, "in pixels");
  b.number("photo_fov_deg", o.photo_fov_deg, {1, 120}, "horizontal field of view");
  b.number("photo_fill_percent", o.photo_fill_percent, {1, 200},
           "how much of the image's shorter side the object's bounding sphere fills");
  b.number("photo_roll_deg", o.photo_roll_deg, {-180, 180}, "how askew the camera is held");
  b.choice("photo_table", o.photo_table, {{"wood", Table::wood}, {"cloth", Table::cloth}},
           "what the object stands on");
  b.flag("photo_clutter", o.photo_clutter, "whether there are other things and patterns in the background");
  b.number("photo_noise_percent", o.photo_noise_percent, {0, 100}, "the sensor's noise, of full scale");
  b.number("seed", o.seed, {0, 1e9}, "other seeds give other noise and other pose errors");
}

/// Writes into `folder` (made if need be):
///  - scans/NNN.ply: binary PLY in floats with range_grid, each in its scanner's own frame
///  - scans/<object>.conf: poses as Stanford's files have them (p_world = R(q)^T p + t), with the errors
///  asked
///    for
///  - photos/NNN.jpg, and NNN_stencil.png: the exact silhouette
///  - truth_mesh.ply: the object, in the scans' units and the world's frame (z up)
///  - truth.json: true poses and cameras, in metres; io::read_poses and io::read_cameras read it.
///
/// The same bytes for any number of threads. Error{config} if the lists of azimuths and elevations do not go
/// together or the scanner would stand inside the object; Error{input} if the folder holds scans or photos
/// that this simulation would not replace.
void simulate(const SimulationSpec& spec, const std::filesystem::path& folder, const Progress& progress = {});

}  // namespace drape::simulation
