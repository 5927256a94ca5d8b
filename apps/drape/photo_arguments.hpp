// What the command line says of one photo.
#pragma once

#include <algorithm>
#include <array>
#include <filesystem>
#include <optional>
#include <vector>

#include "drape/base/error.hpp"

namespace drape::app {

/// Nothing if none was given; their number was checked with the command line.
template <std::size_t count>
std::optional<std::array<double, count>> numbers_of(const std::vector<double>& given) {
  if (given.empty()) return std::nullopt;
  std::array<double, count> numbers{};
  std::copy_n(given.begin(), count, numbers.begin());
  return numbers;
}

/// `given`, or <photo><ending> beside the photo; made where it is not there. Error{io} where that fails.
inline std::filesystem::path photo_folder(const std::filesystem::path& given,
                                          const std::filesystem::path& photo, const char* ending) {
  const std::filesystem::path folder =
      given.empty() ? photo.parent_path() / (photo.stem().string() + ending) : given;
  std::error_code failed;
  std::filesystem::create_directories(folder, failed);
  if (failed)
    throw Error(ErrorCode::io, fmt::format("{}: cannot be made: {}", folder.string(), failed.message()));
  return folder;
}

}  // namespace drape::app
