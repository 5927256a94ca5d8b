#include "input_paths.hpp"

namespace drape::pipeline {
namespace {

void make_absolute(ConfigNode& node, const std::filesystem::path& folder) {
  if (node.kind == ConfigNode::Kind::scalar && !node.text.empty())
    node.text = (folder / node.text).lexically_normal().string();
  if (node.kind == ConfigNode::Kind::sequence)
    for (ConfigNode& item : node.items) make_absolute(item, folder);
  // A scan of which more is known: {file: ..., ...}.
  for (std::size_t i = 0; i < node.keys.size(); ++i)
    if (node.keys[i].name == "file") make_absolute(node.items[i], folder);
}

}  // namespace

void make_input_paths_absolute(ConfigNode& root, const std::filesystem::path& folder) {
  const auto member = [](ConfigNode& node, const char* key) {
    return const_cast<ConfigNode*>(static_cast<const ConfigNode&>(node).find(key));
  };
  ConfigNode* input = member(root, "input");
  if (input == nullptr || input->kind != ConfigNode::Kind::map) return;
  for (const char* key : {"scans", "poses", "mesh", "cameras"})
    if (ConfigNode* node = member(*input, key)) make_absolute(*node, folder);
  ConfigNode* photos = member(*input, "photos");
  if (photos == nullptr) return;
  if (photos->kind == ConfigNode::Kind::scalar) make_absolute(*photos, folder);
  for (ConfigNode& photo : photos->items) {
    if (photo.kind == ConfigNode::Kind::scalar) make_absolute(photo, folder);
    if (photo.kind != ConfigNode::Kind::map) continue;
    for (const char* key : {"image", "mask", "scribbles", "background"})
      if (ConfigNode* node = member(photo, key)) make_absolute(*node, folder);
  }
}

}  // namespace drape::pipeline
