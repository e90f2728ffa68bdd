// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "bake/old_nodes.h"

#include <algorithm>
#include <filesystem>
#include <system_error>
#include <tuple>

#include "core/file_map.h"
#include "core/hash.h"
#include "world/sealed_file.h"

namespace throng {
namespace fs = std::filesystem;

OldNodes::OldNodes(const std::string& world_path) {
  if (world_path.empty()) return;
  for (const char* folder : {kNodeFolder, kOldNodeFolder}) {
    const std::string path = (fs::path(world_path) / folder).string();
    const std::string name = path + "/" + kNodeIndexName;
    const auto map = FileMap::open(name);
    if (!map) continue;
    auto index = read_node_index(map->bytes(), name);
    if (!index || !unsealed(map->bytes(), name)) continue;
    (*index)->path = path;
    folders_.push_back(std::move(*index));
  }
}

std::optional<std::unique_ptr<NodeData::Slot>> OldNodes::keep(int32_t x, int32_t z,
                                                              uint64_t input) const {
  for (const auto& index : folders_) {
    const auto& inputs = index->inputs;
    const auto found =
        std::lower_bound(inputs.begin(), inputs.end(), std::pair{z, x},
                         [](const format::NodeInput& i, std::pair<int32_t, int32_t> at) {
                           return std::pair{i.z(), i.x()} < at;
                         });
    if (found == inputs.end() || found->x() != x || found->z() != z || found->hash() != input) {
      continue;
    }
    const size_t place = index->slot_at(x, z);
    if (place == index->slots.size()) return nullptr;
    const format::NodeZoneEntry& entry = index->slots[place]->entry;
    auto zone = open_listed<NodeZone>({.name = index->path + "/" + node_file_name(x, z),
                                       .bytes = entry.bytes(),
                                       .hash = entry.hash(),
                                       .whose = "the index's"});
    if (!zone || (*zone)->nodes().size() != entry.nodes()) continue;
    auto slot = std::make_unique<NodeData::Slot>();
    slot->entry = entry;
    slot->zone = std::move(*zone);
    return slot;
  }
  return std::nullopt;
}

void carry_nodes(const std::string& from, const std::string& to, bool is_same_world) {
  std::error_code error;
  for (const char* folder : {kNodeFolder, kOldNodeFolder}) {
    const fs::path source = fs::path(from) / folder;
    if (!fs::exists(source / kNodeIndexName, error)) continue;
    const bool is_own = is_same_world && folder == std::string_view(kNodeFolder);
    const fs::path target = fs::path(to) / (is_own ? kNodeFolder : kOldNodeFolder);
    fs::remove_all(target, error);
    fs::create_directory(target, error);
    for (const auto& file : fs::directory_iterator(source, error)) {
      std::error_code failed;
      fs::create_hard_link(file.path(), target / file.path().filename(), failed);
      if (failed) fs::copy_file(file.path(), target / file.path().filename(), failed);
    }
    return;
  }
}

}  // namespace throng
