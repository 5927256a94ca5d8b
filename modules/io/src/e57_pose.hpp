// Poses in the XML section of an E57.
#pragma once

#include <optional>

#include "drape/geometry/rigid3.hpp"
#include "e57_file.hpp"

namespace drape::io {

/// file_from_element of a scan or picture; nothing without a pose. Error{input} if it is no rigid motion.
[[nodiscard]] std::optional<Rigid3> e57_pose(const std::string& file, pugi::xml_node element);

}  // namespace drape::io
