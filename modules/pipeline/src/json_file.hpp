// JSON in and out of the records' files.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <system_error>

#include "drape/base/error.hpp"
#include "drape/base/files.hpp"

namespace drape::pipeline {

using Json = nlohmann::ordered_json;

/// Nothing if there is no such file or it is no JSON: a record that cannot be read is a record that is not
/// there.
inline std::optional<Json> read_json(const std::filesystem::path& file) {
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(file, ignored)) return std::nullopt;
  Json json = Json::parse(read_file(file), nullptr, false);
  if (json.is_discarded()) return std::nullopt;
  return json;
}

inline void write_json(const std::filesystem::path& file, const Json& json) {
  // Bytes that are no UTF-8 (in file names) are replaced: a record must always be writable.
  write_file(file, json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
}

}  // namespace drape::pipeline
