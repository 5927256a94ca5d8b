// Corrections that a person made to runs, collected in one file:
//   fixes:
//     - object: can-17            # of a batch; a file for one run may leave it out
//       photos:
//         front.jpg: {box_px: [120, 80, 400, 600]}   # any key of that photo in input.photos
//         blurred.jpg: {drop: true}
//       set: {fill.max_hole_size_spacings: 100}      # any option
// Photos are named, not numbered, so that fixes still fit after other photos came or went.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "drape/pipeline/config_node.hpp"

namespace drape::pipeline {

struct ObjectFixes {
  std::string object;  // empty: not said
  ConfigNode photos;   // a map by base name, or null
  ConfigNode set;      // a map by dotted name, or null
  Location where;
};

/// Error{config} for what is no such file. Masks and other pictures are taken relative to it, and made
/// absolute.
[[nodiscard]] std::vector<ObjectFixes> read_fixes(const std::filesystem::path& file);
void write_fixes(const std::filesystem::path& file, const std::vector<ObjectFixes>& fixes);

/// Puts the fixes into the configuration. Error{config} for a photo that it does not have.
void apply_fixes(ConfigNode& root, const ObjectFixes& fixes);

/// What `newer` says goes over what `older` says of the same object; other objects are added.
[[nodiscard]] std::vector<ObjectFixes> joined(std::vector<ObjectFixes> older,
                                              const std::vector<ObjectFixes>& newer);

}  // namespace drape::pipeline
