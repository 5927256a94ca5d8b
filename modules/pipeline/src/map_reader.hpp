// Reading a map of known keys in the `input:` section.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "drape/pipeline/config.hpp"
#include "input_section.hpp"

namespace drape::pipeline {

/// One pass over a map of known keys; complains about the others.
class MapReader {
 public:
  MapReader(const ConfigNode& node, std::string path, const std::vector<InputKey>& keys,
            InputProblems& problems);

  [[nodiscard]] const ConfigNode* find(const std::string& key) const;

  void wrong(const ConfigNode& value, const std::string& key, const std::string& what);

  // The texts of a scalar, or of a sequence of scalars.
  [[nodiscard]] std::vector<std::string> texts(const ConfigNode& value, const std::string& key);

  [[nodiscard]] std::vector<double> numbers(const std::string& key, std::size_t least, std::size_t most);

  [[nodiscard]] std::filesystem::path file(const std::string& key, const std::filesystem::path& folder);

  [[nodiscard]] std::vector<std::filesystem::path> files(const std::string& key,
                                                         const std::filesystem::path& folder);

 private:
  [[nodiscard]] std::filesystem::path existing(const ConfigNode& value, const std::string& key,
                                               const std::string& text, const std::filesystem::path& folder);

  const ConfigNode& node_;
  std::string path_;
  const std::vector<InputKey>& keys_;
  InputProblems& problems_;
};

/// A photo of `input.photos`: a file name alone, or a map.
[[nodiscard]] PhotoInput read_photo_input(const ConfigNode& node, const std::string& path,
                                          const std::filesystem::path& folder, InputProblems& problems);

}  // namespace drape::pipeline
