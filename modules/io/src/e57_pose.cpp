#include "e57_pose.hpp"

#include "drape/base/error.hpp"

namespace drape::io {

std::optional<Rigid3> e57_pose(const std::string& file, pugi::xml_node element) {
  const pugi::xml_node pose = element.child("pose");
  if (!pose) return std::nullopt;
  const auto number = [&](const char* section, const char* name, double otherwise) {
    return e57_number(file, pose.child(section), name).value_or(otherwise);
  };
  const Eigen::Quaterniond q(number("rotation", "w", 1), number("rotation", "x", 0),
                             number("rotation", "y", 0), number("rotation", "z", 0));
  Rigid3 motion = Rigid3::Identity();
  motion.translation() = Eigen::Vector3d(number("translation", "x", 0), number("translation", "y", 0),
                                         number("translation", "z", 0));
  if (!(q.norm() > 0.5 && q.norm() < 2) || !motion.translation().allFinite())
    throw input_error("{}: a pose has a quaternion of length {}, not 1", file, q.norm());
  motion.linear() = q.normalized().toRotationMatrix();
  return motion;
}

}  // namespace drape::io
