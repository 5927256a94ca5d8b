#include "adopted_parts.hpp"

#include <algorithm>
#include <filesystem>

namespace drape::pipeline {

void add_adopted(std::vector<KeyPart>& parts, const std::vector<Adoption>& adopted) {
  for (const Adoption& adoption : adopted)
    parts.push_back({"adopted." + adoption.file, adoption.digest,
                     std::filesystem::path(adoption.came_from).filename().string()});
}

std::vector<KeyPart> without_adopted(std::vector<KeyPart> parts) {
  std::erase_if(parts, [](const KeyPart& part) { return part.name.rfind("adopted.", 0) == 0; });
  return parts;
}

bool covers(const std::vector<Adoption>& adopted, const Stage& stage) {
  return std::all_of(stage.writes.begin(), stage.writes.end(), [&](const std::string& pattern) {
    return std::any_of(adopted.begin(), adopted.end(),
                       [&](const Adoption& adoption) { return adoption.file == pattern; });
  });
}

}  // namespace drape::pipeline
