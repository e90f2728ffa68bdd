// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "bake/surface/node_folder.h"

#include <algorithm>
#include <set>
#include <system_error>
#include <tuple>
#include <utility>

#include "core/files/file_map.h"
#include "core/hash.h"
#include "world/sealed_file.h"

// The nodes' folder of a world: files of earlier bakes that can be reused, and a folder of new ones
// that replaces it at once.
namespace throng::bake {
namespace fs = std::filesystem;
namespace {

// Two names for one file, or two files where that cannot be.
bool link_or_copy(const fs::path& from, const fs::path& to) {
  std::error_code error;
  fs::create_hard_link(from, to, error);
  if (error) fs::copy_file(from, to, error);
  return !error;
}

}  // namespace

OldNodes::OldNodes(const std::string& world_path) {
  if (world_path.empty()) return;
  for (const char* folder : {graph::kNodeFolder, graph::kOldNodeFolder, graph::kPartNodeFolder}) {
    const std::string path = (fs::path(world_path) / folder).string();
    const std::string name = path + "/" + graph::kNodeIndexName;
    const auto map = FileMap::open(name);
    if (!map) continue;
    auto index = graph::read_node_index(map->bytes(), name);
    if (!index || !world::unsealed(map->bytes(), name)) continue;
    (*index)->path = path;
    folders_.push_back(std::move(*index));
    const std::string links_name = path + "/" + graph::kLeafLinkIndexName;
    const auto links_map = FileMap::open(links_name);
    if (!links_map) continue;
    const auto content = world::unsealed(links_map->bytes(), links_name);
    if (!content) continue;
    auto links = graph::read_leaf_link_index(*content, links_name);
    if (links) links_.push_back({path, *std::move(links)});
  }
}

OldNodes::ReusedLinks OldNodes::reuse_links(int32_t x, int32_t z, uint64_t input) const {
  for (const OldLinks& old : links_) {
    const auto& zones = old.index.zones;
    const auto found =
        std::lower_bound(zones.begin(), zones.end(), std::pair{z, x},
                         [](const format::LeafLinkEntry& entry, std::pair<int32_t, int32_t> at) {
                           return std::pair{entry.z(), entry.x()} < at;
                         });
    if (found == zones.end() || found->x() != x || found->z() != z || found->input() != input) {
      continue;
    }
    const std::string file = old.path + "/" + graph::leaf_link_file_name(x, z);
    auto zone = world::open_listed<graph::LeafLinkZone>(
        {.name = file, .bytes = found->bytes(), .hash = found->hash(), .whose = "the index's"});
    if (!zone || (*zone)->input() != input || (*zone)->links().size() != found->links()) continue;
    return {std::move(*zone), *found, file};
  }
  return {};
}

std::optional<OldNodes::Reused> OldNodes::reuse(int32_t x, int32_t z, uint64_t input) const {
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
    if (place == index->slots.size()) return Reused{};
    const format::NodeZoneEntry& entry = index->slots[place]->entry;
    const std::string file = index->path + "/" + graph::node_file_name(x, z);
    auto zone = world::open_listed<graph::NodeZone>(
        {.name = file, .bytes = entry.bytes(), .hash = entry.hash(), .whose = "the index's"});
    if (!zone || (*zone)->nodes().size() != entry.nodes()) continue;
    auto slot = std::make_unique<graph::NodeData::Slot>();
    slot->entry = entry;
    slot->zone = std::move(*zone);
    return Reused{std::move(slot), file};
  }
  return std::nullopt;
}

NodeFolder::NodeFolder(std::string world_path)
    : world_path_(std::move(world_path)), part_(fs::path(world_path_) / graph::kPartNodeFolder) {}

NodeFolder::NodeFolder(NodeFolder&& other) noexcept
    : world_path_(std::move(other.world_path_)),
      part_(std::exchange(other.part_, {})),
      is_own_(other.is_own_),
      links_(std::move(other.links_)),
      world_lock_(std::move(other.world_lock_)),
      part_lock_(std::move(other.part_lock_)) {}

NodeFolder::~NodeFolder() {
  std::error_code error;
  if (is_own_ && !part_.empty()) fs::remove_all(part_, error);
}

// The world's folder is locked as shared: to replace its world, the lock must be exclusive.
Result<NodeFolder> NodeFolder::begin(const std::string& world_path) {
  auto world_lock = FolderLock::take(world_path, FolderLock::Kind::kShared, world_path);
  if (!world_lock) return world_lock.error();
  const std::string part = (fs::path(world_path) / graph::kPartNodeFolder).string();
  auto part_lock = FolderLock::create(part, world_path);
  if (!part_lock) return part_lock.error();
  NodeFolder folder(world_path);
  folder.world_lock_ = *std::move(world_lock);
  folder.part_lock_ = *std::move(part_lock);
  return folder;
}

NodeFolder NodeFolder::join(const std::string& world_path) {
  NodeFolder folder(world_path);
  folder.is_own_ = false;
  return folder;
}

Result<void> NodeFolder::write(const graph::NodeZone& zone) const {
  return write_file((part_ / graph::node_file_name(zone.x(), zone.z())).string(), zone.bytes());
}

namespace {

// Has the file been put under its new name?
bool took_over(const std::string& file, const fs::path& to) {
  if (fs::path(file) == to) return true;
  std::error_code error;
  fs::remove(to, error);
  return link_or_copy(file, to);
}

}  // namespace

Result<void> NodeFolder::take_over(const graph::NodeZone& zone, const std::string& file) const {
  if (took_over(file, part_ / graph::node_file_name(zone.x(), zone.z()))) return {};
  return write(zone);
}

Result<void> NodeFolder::write(const graph::LeafLinkZone& zone) const {
  return write_file((part_ / graph::leaf_link_file_name(zone.x(), zone.z())).string(),
                    zone.bytes());
}

Result<void> NodeFolder::take_over(const graph::LeafLinkZone& zone, const std::string& file) const {
  if (took_over(file, part_ / graph::leaf_link_file_name(zone.x(), zone.z()))) return {};
  return write(zone);
}

Result<void> NodeFolder::list(const graph::NodeData& nodes) const {
  return write_file((part_ / graph::kNodeIndexName).string(),
                    world::sealed(graph::write_node_index(nodes)));
}

Result<void> NodeFolder::finish(const graph::NodeData& nodes) {
  std::set<std::string> names{graph::kNodeIndexName};
  for (const auto& slot : nodes.slots) {
    names.insert(graph::node_file_name(slot->entry.x(), slot->entry.z()));
  }
  if (links_) {
    names.insert(graph::kLeafLinkIndexName);
    for (const format::LeafLinkEntry& entry : links_->zones) {
      names.insert(graph::leaf_link_file_name(entry.x(), entry.z()));
    }
  }
  std::error_code error;
  std::vector<fs::path>
      stale;  // Of killed bakes of something else, and what they left half written.
  for (const auto& file : fs::directory_iterator(part_, error)) {
    if (!names.contains(file.path().filename().string())) stale.push_back(file.path());
  }
  for (const fs::path& file : stale) fs::remove_all(file, error);
  if (auto ok = list(nodes); !ok) return ok;
  if (links_) {
    const auto index = world::sealed(graph::write_leaf_link_index(*links_));
    if (auto ok = write_file((part_ / graph::kLeafLinkIndexName).string(), index); !ok) return ok;
  }
  const fs::path target = fs::path(world_path_) / graph::kNodeFolder;
  fs::remove_all(target, error);
  fs::rename(part_, target, error);
  if (error) return Error{Errc::kIo, target.string() + ": cannot be written: " + error.message()};
  part_.clear();
  fs::remove_all(fs::path(world_path_) / graph::kOldNodeFolder, error);
  return {};
}

namespace {

// Of nodes that are a world's own: links to air that is another's by now would be refused.
void remove_links(const fs::path& folder) {
  std::error_code error;
  const fs::path index = folder / graph::kLeafLinkIndexName;
  if (!fs::exists(index, error)) return;
  std::vector<fs::path> files{index};
  for (const auto& file : fs::directory_iterator(folder, error)) {
    if (file.path().extension() == index.extension()) files.push_back(file.path());
  }
  for (const fs::path& file : files) fs::remove(file, error);
}

// If it has any nodes.
bool reuse_folder(const fs::path& source, const fs::path& target) {
  std::error_code error;
  if (!fs::exists(source / graph::kNodeIndexName, error)) return false;
  fs::remove_all(target, error);
  fs::create_directory(target, error);
  for (const auto& file : fs::directory_iterator(source, error)) {
    link_or_copy(file.path(), target / file.path().filename());
  }
  return true;
}

}  // namespace

void carry_nodes(const std::string& from, const std::string& to, bool is_same_world,
                 bool is_same_air) {
  const fs::path source(from), target(to);
  reuse_folder(source / graph::kPartNodeFolder, target / graph::kPartNodeFolder);
  if (reuse_folder(source / graph::kNodeFolder,
                   target / (is_same_world ? graph::kNodeFolder : graph::kOldNodeFolder))) {
    if (is_same_world && !is_same_air) remove_links(target / graph::kNodeFolder);
    return;
  }
  reuse_folder(source / graph::kOldNodeFolder, target / graph::kOldNodeFolder);
}

}  // namespace throng::bake
