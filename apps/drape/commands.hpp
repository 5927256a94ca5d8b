// What each subcommand does. main.cpp parses the command line into these arguments, and turns errors into
// exit codes.
#pragma once

#include <atomic>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "progress_display.hpp"

namespace drape::app {

struct RunArguments {
  std::filesystem::path config;
  std::vector<std::string> sets;
  std::optional<std::string> from;
  std::optional<std::string> until;
  std::optional<std::string> only;
  std::optional<std::filesystem::path> workspace;
  std::string name;
  std::string fixes;     // a file; "none": forget those of before; empty: those of before
  bool dry_run = false;  // say what would run and how long it may take
  ProgressMode progress = ProgressMode::automatic;
  bool quiet = false;
  std::string command;  // the command line as it was typed
};
void run_command(const RunArguments& arguments, const std::atomic<bool>& stop);

struct ExplainArguments {
  std::filesystem::path config;
  std::string stage;  // empty: all
  std::vector<std::string> sets;
  std::optional<std::filesystem::path> workspace;
  std::string name;
};
void explain_command(const ExplainArguments& arguments);

struct GcArguments {
  std::filesystem::path where = ".";  // a workspace, a folder with one, or a configuration
  bool remove = false;
  std::string max_size;      // empty: everything without a run
  double min_age_hours = 1;  // younger results stay
};
void gc_command(const GcArguments& arguments);

struct ReportArguments {
  std::string what;  // a run, as select_run names it; a sweep's configuration; a batch's manifest or folder
  std::optional<std::filesystem::path> workspace;
};
/// Writes the page anew from what is there; runs nothing.
void report_command(const ReportArguments& arguments);

/// Runs are named as select_run says.
struct DiffArguments {
  std::string a;
  std::string b;
  std::optional<std::filesystem::path> workspace;
  std::filesystem::path output = "diff.html";
};
void diff_command(const DiffArguments& arguments);

struct AdoptArguments {
  std::string run;
  std::string stage;
  std::filesystem::path file;
  std::string as;       // the stage's file that it stands for; empty: told by name or kind
  bool forget = false;  // the stage makes its own again
  std::optional<std::filesystem::path> workspace;
};
void adopt_command(const AdoptArguments& arguments);

struct ValidateArguments {
  std::filesystem::path config;
  std::vector<std::string> sets;
};
void validate_command(const ValidateArguments& arguments);

/// `where`: a workspace, or a configuration, whose workspace is meant.
void status_command(const std::filesystem::path& where);

struct NewArguments {
  std::vector<std::filesystem::path> scans;
  std::vector<std::filesystem::path> photos;
  std::filesystem::path output;
  bool force = false;  // write over an existing file
};
void new_command(const NewArguments& arguments);

/// What is in scan files, meshes, photos and files of poses.
struct InfoArguments {
  std::vector<std::filesystem::path> files;
};
void info_command(const InfoArguments& arguments);

/// One scan file as another format, which the extension of `output` tells.
struct ConvertArguments {
  std::filesystem::path input;
  std::filesystem::path output;
};
void convert_command(const ConvertArguments& arguments);
/// new_command, then run_command: everything goes into one folder.
struct MakeArguments {
  NewArguments create;  // output: the folder
  RunArguments run;
};
void make_command(const MakeArguments& arguments, const std::atomic<bool>& stop);

/// Writes the reference page; with `check` only compares, and says whether it is as the code makes it.
[[nodiscard]] bool reference_command(const std::filesystem::path& file, bool check);

struct SimulateArguments {
  std::filesystem::path spec;
  std::filesystem::path output;
  std::vector<std::string> sets;
  ProgressMode progress = ProgressMode::automatic;
};
void simulate_command(const SimulateArguments& arguments, const std::atomic<bool>& stop);

struct SegmentArguments {
  std::filesystem::path photo;
  std::string method;         // as segment.method; empty: its default
  std::vector<double> box;    // x, y, width, height; or empty
  std::vector<double> click;  // x, y; or empty
  std::filesystem::path mask;
  std::filesystem::path scribbles;
  std::filesystem::path background;
  std::filesystem::path output;  // empty: <photo>-segments beside the photo
  ProgressMode progress = ProgressMode::automatic;
};
/// Finds the object in one photo: segments.png, segments.json and stencil.png.
void segment_command(const SegmentArguments& arguments, const std::atomic<bool>& stop);

struct AlignArguments {
  std::filesystem::path mesh;
  std::filesystem::path photo;
  std::string evidence;       // as align.evidence; empty: its default
  std::vector<double> box;    // x, y, width, height; or empty
  std::vector<double> click;  // x, y; or empty
  std::filesystem::path mask;
  std::filesystem::path output;  // empty: <photo>-aligned beside the photo
  ProgressMode progress = ProgressMode::automatic;
};
/// Finds the camera of one photo of a mesh: cameras.json, stencil.png and overlay.png, and the segments that
/// were found on the way.
void align_command(const AlignArguments& arguments, const std::atomic<bool>& stop);

struct RelightArguments {
  std::filesystem::path model;  // a PLY, textured or plain, another mesh, or the folder of an exported model
  // Directions: counter-clockwise seen from above, 0 at the front (-y for z up, z for y up).
  double azimuth_deg = 40;
  double elevation_deg = 45;
  double intensity = 1;
  double ambient = 0.15;
  double softness_deg = 1;
  double view_azimuth_deg = 0;
  double view_elevation_deg = 18;
  int size_px = 960;
  char up = 'z';
  std::filesystem::path output;  // empty: <model>-relit.png beside it
};
/// A picture of a model under a new light; of its albedo, if <model>_albedo.ply lies beside it.
void relight_command(const RelightArguments& arguments);

/// drape, its compiler, and the libraries: name and version.
[[nodiscard]] std::vector<std::pair<std::string, std::string>> versions();

}  // namespace drape::app
