#include "rotation_grid.hpp"

#include <array>
#include <cmath>
#include <cstdint>
#include <map>

namespace drape::alignment {
namespace {

constexpr double resolution = 1e-9;

// Rotation matrices of different angles differ by rounding where the rotations are the same.
std::array<std::int64_t, 9> key_of(const EulerAngles& angles) {
  const Eigen::Matrix3d matrix = angles.matrix();
  std::array<std::int64_t, 9> key{};
  for (std::size_t i = 0; i < key.size(); ++i) key[i] = std::llround(matrix.data()[i] / resolution);
  return key;
}

std::array<std::int64_t, 3> key_of_angles(double pitch_deg, double yaw_deg, double roll_deg) {
  const auto wrapped = [](double deg) {
    const double full = std::fmod(deg, 360.0);
    return std::llround((full < 0 ? full + 360 : full) / resolution) % std::llround(360 / resolution);
  };
  return {wrapped(pitch_deg), wrapped(yaw_deg), wrapped(roll_deg)};
}

}  // namespace

RotationGrid rotation_grid(double step_deg) {
  RotationGrid grid;
  const int steps = static_cast<int>(std::ceil(360 / step_deg - 1e-9));
  std::map<std::array<std::int64_t, 9>, std::size_t> rotations;
  std::map<std::array<std::int64_t, 3>, std::size_t> earlier;
  for (int pitch = 0; pitch < steps; ++pitch)
    for (int yaw = 0; yaw < steps; ++yaw)
      for (int roll = 0; roll < steps; ++roll) {
        const EulerAngles cell{pitch * step_deg, yaw * step_deg, roll * step_deg};
        const std::size_t index = grid.cells.size();
        grid.same_rotation.push_back(rotations.emplace(key_of(cell), index).first->second);
        grid.has_earlier_twin.push_back(
            earlier.contains(key_of_angles(cell.pitch_deg + 180, 180 - cell.yaw_deg, cell.roll_deg + 180)));
        earlier.emplace(key_of_angles(cell.pitch_deg, cell.yaw_deg, cell.roll_deg), index);
        grid.cells.push_back(cell);
      }
  return grid;
}

}  // namespace drape::alignment
