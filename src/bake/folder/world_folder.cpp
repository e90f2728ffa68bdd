// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "bake/folder/world_folder.h"

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <cstdio>
#include <cstring>
#include <set>
#include <system_error>

#ifdef __linux__
#include <fcntl.h>
#endif

#include "bake/surface/node_folder.h"
#include "core/files/file_map.h"
#include "core/hash.h"
#include "world/sealed_file.h"

// NAME.part is a whole world in the making: baked zones are written there and those that are reused
// are linked there, so the world NAME stays as it is until both change names. What has been baked
// is listed by a journal in NAME.part, one record a zone, written after the zone's file. A record
// that was cut short or a file that is not what its record says is as good as none.
namespace throng::bake {
namespace fs = std::filesystem;
namespace {

constexpr const char* kManifest = "manifest.thm";
constexpr const char* kJournal = "journal";

// NAME.part and NAME swap their names, or, where that cannot be done at once, NAME.old.
bool exchange(const fs::path& part, const fs::path& target, const fs::path& old) {
  std::error_code error;
  if (!fs::exists(target, error)) {
    fs::rename(part, target, error);
    return !error;
  }
#ifdef RENAME_EXCHANGE
  if (renameat2(AT_FDCWD, part.c_str(), AT_FDCWD, target.c_str(), RENAME_EXCHANGE) == 0) {
    fs::remove_all(part, error);
    return true;
  }
#endif
  fs::remove_all(old, error);
  fs::rename(target, old, error);
  if (!error) fs::rename(part, target, error);
  if (error) return false;
  fs::remove_all(old, error);
  return true;
}

void empty_folder(const fs::path& folder) {
  std::error_code error;
  std::vector<fs::path> content;
  for (const auto& file : fs::directory_iterator(folder, error)) content.push_back(file.path());
  for (const fs::path& file : content) fs::remove_all(file, error);
}

std::string without_slash(std::string path) {
  while (path.size() > 1 && path.back() == '/') path.pop_back();
  return path;
}

}  // namespace

// A record of the journal.
struct WorldFolder::Done {
  int32_t x = 0, z = 0;
  uint32_t levels = 0, tiles = 0;
  uint64_t input = 0;
  uint64_t bytes = 0;
  uint64_t hash = 0;
  uint64_t check = 0;  // XXH3 of what stands before it

  [[nodiscard]] uint64_t sum() const { return hash_bytes(this, offsetof(Done, check)); }
};

WorldFolder::WorldFolder(std::string path) : path_(std::move(path)), part_(path_ + ".part") {}

WorldFolder::WorldFolder(WorldFolder&& other) noexcept
    : path_(std::move(other.path_)),
      part_(std::move(other.part_)),
      is_owner_(std::exchange(other.is_owner_, false)),
      is_joined_(other.is_joined_),
      part_lock_(std::move(other.part_lock_)),
      old_lock_(std::move(other.old_lock_)),
      old_(std::move(other.old_)),
      sources_(std::move(other.sources_)) {}

WorldFolder::~WorldFolder() {
  std::error_code ignored;
  if (is_owner_) fs::remove_all(part_, ignored);
}

Result<WorldFolder> WorldFolder::begin(std::string path, OldZones old_zones) {
  path = without_slash(path);
  const fs::path target(path), old(path + ".old");
  std::error_code error;
  if (fs::exists(target, error)) {
    const bool ours = fs::is_directory(target, error) &&
                      (fs::exists(target / kManifest, error) || fs::is_empty(target, error));
    if (!ours) {
      return Error{Errc::kIo, path + ": exists and is not a baked world; choose another name"};
    }
  }
  WorldFolder folder(path);
  auto part_lock = FolderLock::create(folder.part(), path);
  if (!part_lock) {
    folder.leave();
    return part_lock.error();
  }
  folder.part_lock_ = *std::move(part_lock);
  if (!fs::exists(target, error) && fs::exists(old / kManifest, error)) {
    fs::rename(old, target, error);  // Killed between two names.
  }
  auto old_lock = FolderLock::take(path, FolderLock::Kind::kAlone, path);
  if (!old_lock) {
    fs::remove(folder.part_, error);  // Unless a killed bake has left something in it.
    folder.leave();
    return old_lock.error();
  }
  folder.old_lock_ = *std::move(old_lock);
  if (old_zones == OldZones::kBakeAgain) empty_folder(folder.part_);
  if (old_zones == OldZones::kKeep) folder.read_old();
  // Without what a killed bake wrote in part, so that further records are aligned.
  const std::vector<Done> records = folder.read_part();
  const auto written =
      write_file((folder.part_ / kJournal).string(),
                 {reinterpret_cast<const uint8_t*>(records.data()), records.size() * sizeof(Done)});
  if (!written) return written.error();
  return folder;
}

WorldFolder WorldFolder::join(const std::string& path, OldZones old_zones) {
  WorldFolder folder(without_slash(path));
  folder.is_owner_ = false;
  folder.is_joined_ = true;
  if (old_zones == OldZones::kKeep) folder.read_old();
  folder.read_part();
  return folder;
}

std::shared_ptr<world::WorldData> WorldFolder::read_world(const std::string& path) {
  const std::string name = (fs::path(path) / kManifest).string();
  const auto map = FileMap::open(name);
  if (!map) return nullptr;
  auto world = world::read_manifest(map->bytes(), name);
  if (!world::unsealed(map->bytes(), name)) return nullptr;
  return world ? std::move(*world) : nullptr;
}

Result<void> WorldFolder::check_part(const BakeConfig& config) const {
  std::error_code ignored;
  const bool is_there = fs::exists(fs::path(path_) / kManifest, ignored);
  if (!config.part || !is_there || (old_ != nullptr && !old_->inputs.empty())) return {};
  return Error{Errc::kBadFile,
               path_ +
                   ": cannot be read, so its zones beside the part cannot be kept; bake all of "
                   "it, or choose another name"};
}

void WorldFolder::read_old() {
  old_ = read_world(path_);
  if (old_ == nullptr) return;
  std::map<std::pair<int32_t, int32_t>, format::ZoneEntry> entries;
  for (const auto& slot : old_->slots) entries[{slot->entry.z(), slot->entry.x()}] = slot->entry;
  for (const format::ZoneInput& input : old_->inputs) {
    const auto found = entries.find({input.z(), input.x()});
    const bool empty = found == entries.end();
    sources_.insert(
        {{input.z(), input.x()},
         {.input = input.hash(),
          .entry = empty ? format::ZoneEntry(input.x(), input.z(), 0, 0, 0, 0) : found->second}});
  }
}

// The whole records of the journal, which are sources from then on.
std::vector<WorldFolder::Done> WorldFolder::read_part() {
  std::vector<Done> records;
  const auto map = FileMap::open((part_ / kJournal).string());
  if (!map) return records;
  const auto bytes = map->bytes();
  for (size_t at = 0; at + sizeof(Done) <= bytes.size(); at += sizeof(Done)) {
    Done done;
    std::memcpy(&done, bytes.data() + at, sizeof done);
    if (done.check != done.sum()) break;
    records.push_back(done);
    sources_.insert({{done.z, done.x},
                     {.is_part = true,
                      .input = done.input,
                      .entry = {done.x, done.z, done.levels, done.tiles, done.bytes, done.hash}}});
  }
  return records;
}

std::optional<WorldFolder::Reused> WorldFolder::reuse(int32_t x, int32_t z, uint64_t input) const {
  const auto [first, last] = sources_.equal_range({z, x});
  for (auto source = last; source != first;) {
    --source;
    const format::ZoneEntry& entry = source->second.entry;
    if (source->second.input != input) continue;
    if (entry.bytes() == 0) return Reused{nullptr, entry};
    const std::string file = world::zone_file_name(x, z);
    const fs::path from = (source->second.is_part ? part_ : fs::path(path_)) / file;
    auto map = FileMap::open(from.string());
    if (!map || map->bytes().size() != entry.bytes() ||
        hash_bytes(map->bytes().data(), map->bytes().size()) != entry.hash()) {
      continue;
    }
    auto zone = world::Zone::from_file(std::move(*map), from.string());
    if (!zone) continue;
    if (!source->second.is_part) {
      std::error_code error;
      fs::remove(part_ / file, error);
      fs::create_hard_link(from, part_ / file, error);
      if (error && !write_file((part_ / file).string(), (*zone)->bytes())) continue;
    }
    return Reused{std::move(*zone), entry};
  }
  return std::nullopt;
}

Result<void> WorldFolder::write_zone(const std::string& path, const format::ZoneEntry& entry,
                                     std::span<const uint8_t> bytes) {
  if (bytes.empty()) return {};
  const fs::path part(without_slash(path) + ".part");
  return write_file((part / world::zone_file_name(entry.x(), entry.z())).string(), bytes);
}

Result<void> WorldFolder::add(const format::ZoneEntry& entry, uint64_t input) {
  if (is_joined_) return {};
  Done done{.x = entry.x(),
            .z = entry.z(),
            .levels = entry.levels(),
            .tiles = entry.tiles(),
            .input = input,
            .bytes = entry.bytes(),
            .hash = entry.hash()};
  done.check = done.sum();
  const std::string name = (part_ / kJournal).string();
  std::FILE* journal = std::fopen(name.c_str(), "ab");
  const bool written = journal != nullptr && std::fwrite(&done, sizeof done, 1, journal) == 1;
  const bool closed = journal != nullptr && std::fclose(journal) == 0;
  if (!written || !closed) {
    return Error{Errc::kIo, name + ": cannot be written: " + std::strerror(errno)};
  }
  return {};
}

Result<void> WorldFolder::take_over(const std::string& from, const format::ZoneEntry& entry,
                                    uint64_t input) {
  const int32_t x = entry.x(), z = entry.z();
  const std::string zone = world::zone_file_name(x, z);
  for (const std::string& name : {zone, world::air_file_name(x, z), world::region_file_name(x, z),
                                  world::link_file_name(x, z)}) {
    const fs::path file = fs::path(from) / name;
    std::error_code error;
    if (!fs::exists(file, error)) {
      if (name != zone || entry.bytes() == 0) continue;
      return Error{Errc::kBadFile, file.string() + ": is missing; bake that world again"};
    }
    fs::remove(part_ / name, error);
    fs::create_hard_link(file, part_ / name, error);
    if (error) fs::copy_file(file, part_ / name, fs::copy_options::overwrite_existing, error);
    if (error) {
      return Error{Errc::kIo, file.string() + ": cannot be copied to " + part_.string() + ": " +
                                  error.message()};
    }
  }
  if (auto ok = add(entry, input); !ok) return ok;
  sources_.insert({{z, x}, {.is_part = true, .input = input, .entry = entry}});
  return {};
}

template <class File>
std::unique_ptr<File> WorldFolder::reuse_file(const std::string& name, uint64_t input) const {
  for (const bool is_part : {true, false}) {
    if (!is_part && old_ == nullptr) continue;  // Nothing of it is to be reused.
    const fs::path from = (is_part ? part_ : fs::path(path_)) / name;
    auto map = FileMap::open(from.string());
    if (!map) continue;
    auto file = File::from_file(std::move(*map), from.string());
    if (!file || (*file)->root().input() != input) continue;
    if (!is_part) {
      std::error_code error;
      fs::remove(part_ / name, error);
      fs::create_hard_link(from, part_ / name, error);
      if (error && !write_file((part_ / name).string(), (*file)->bytes())) continue;
    }
    return std::move(*file);
  }
  return nullptr;
}

std::unique_ptr<world::AirZone> WorldFolder::reuse_air(int32_t x, int32_t z, uint64_t input) const {
  return reuse_file<world::AirZone>(world::air_file_name(x, z), input);
}

std::unique_ptr<world::RegionZone> WorldFolder::reuse_regions(int32_t x, int32_t z,
                                                              uint64_t input) const {
  return reuse_file<world::RegionZone>(world::region_file_name(x, z), input);
}

std::unique_ptr<world::LinkZone> WorldFolder::reuse_links(int32_t x, int32_t z,
                                                          uint64_t input) const {
  return reuse_file<world::LinkZone>(world::link_file_name(x, z), input);
}

Result<void> WorldFolder::write_file_of_zone(const std::string& name,
                                             std::span<const uint8_t> bytes) const {
  return write_file((part_ / name).string(), bytes);
}

Result<void> WorldFolder::complete(const world::WorldData& world, const world::GraphData& graph,
                                   bool carry_nodes) {
  std::set<std::string> names;
  if (world.air != nullptr) {
    for (const auto& slot : world.air->slots) {
      names.insert(world::air_file_name(slot->entry.x(), slot->entry.z()));
    }
  }
  for (const auto& slot : world.slots) {
    const int32_t x = slot->entry.x(), z = slot->entry.z();
    for (const std::string& name : {world::zone_file_name(x, z), world::region_file_name(x, z),
                                    world::link_file_name(x, z)}) {
      names.insert(name);
    }
  }
  std::error_code error;
  std::vector<fs::path> stale;  // Of killed bakes of other scenes, and what they left half written.
  for (const auto& file : fs::directory_iterator(part_, error)) {
    const std::string name = file.path().filename().string();
    if (name != kJournal && !names.contains(name)) stale.push_back(file.path());
  }
  for (const fs::path& file : stale) fs::remove_all(file, error);
  const std::vector<uint8_t> manifest = world::write_manifest(world);
  const uint64_t hash = hash_bytes(manifest.data(), manifest.size());
  if (world.air != nullptr) {
    const auto air = world::write_air_manifest(*world.air, hash);
    if (auto ok = write_file((part_ / world::kAirManifest).string(), world::sealed(air)); !ok)
      return ok.error();
  }
  const auto index = world::write_graph_index(graph, hash);
  if (auto ok = write_file((part_ / world::kGraphIndexName).string(), world::sealed(index)); !ok) {
    return ok.error();
  }
  const auto whole = world::sealed(manifest);
  if (auto ok = write_file((part_ / kManifest).string(), whole); !ok) return ok.error();
  if (carry_nodes && old_ != nullptr) {
    const auto before = FileMap::open((fs::path(path_) / kManifest).string());
    const bool is_same = before && std::ranges::equal(before->bytes(), whole);
    const auto old_air = FileMap::open((fs::path(path_) / world::kAirManifest).string());
    const auto air = FileMap::open((part_ / world::kAirManifest).string());
    const bool is_same_air =
        bool(old_air) == bool(air) && (!air || std::ranges::equal(old_air->bytes(), air->bytes()));
    throng::bake::carry_nodes(path_, part_.string(), is_same, is_same_air);
  }
  return {};
}

Result<FolderLock> WorldFolder::finish() {
  if (!exchange(part_, path_, path_ + ".old")) {
    return Error{Errc::kIo, path_ + ": cannot be written: " + std::strerror(errno)};
  }
  is_owner_ = false;
  std::error_code error;
  fs::remove(fs::path(path_) / kJournal, error);
  part_lock_.share();
  return std::move(part_lock_);
}

}  // namespace throng::bake
