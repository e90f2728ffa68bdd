// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/files/folder_lock.h"
#include "throng/bake.h"
#include "throng/base.h"
#include "world/air_data.h"
#include "world/region_data.h"
#include "world/zone_data.h"

/// The folder of a world while it is baked: zones are taken over from the world that is there and
/// from a bake that was killed, and the new world replaces the old one at once.
namespace throng::bake {

class WorldFolder {
 public:
  /// Begins NAME.part beside the world `path`, and holds both against other bakes. Fails with kIo,
  /// also if `path` is something else or another bake is at work there; then all is as it was.
  static Result<WorldFolder> begin(std::string path, OldZones old_zones);
  /// The folder that another process has begun: zones can be reused and their files written, what
  /// is added counts once that process adds it.
  static WorldFolder join(const std::string& path, OldZones old_zones);
  WorldFolder(WorldFolder&& other) noexcept;
  WorldFolder& operator=(WorldFolder&&) = delete;
  /// Removes what was begun and not finished, but for one that was joined.
  ~WorldFolder();

  /// The world at `path`, without its zones; null if there is none that can be read. For ranks that
  /// do not own the folder.
  static std::shared_ptr<world::WorldData> read_world(const std::string& path);
  /// Writes the file of a baked zone, if a class can stand there; `add` makes it count.
  static Result<void> write_zone(const std::string& path, const format::ZoneEntry& entry,
                                 std::span<const uint8_t> bytes);
  /// Adds a zone whose file is written. From one thread at a time. Fails with kIo.
  Result<void> add(const format::ZoneEntry& entry, uint64_t input);
  /// Adds a zone of another world with its files: links them where that can be done, else copies
  /// them. From one thread at a time. Fails with kIo or kBadFile.
  Result<void> take_over(const std::string& from, const format::ZoneEntry& entry, uint64_t input);
  /// Leaves what was begun for the next bake.
  void leave() { is_owner_ = false; }

  /// The world that is there, without its zones; null if there is none that can be read.
  [[nodiscard]] const world::WorldData* old_world() const { return old_.get(); }

  /// Fails with kBadFile if a part is to be baked into a world that cannot be read, or that does
  /// not say what it was baked from: its other zones would be lost.
  [[nodiscard]] Result<void> check_part(const BakeConfig& config) const;

  // Reused zones and files of zones: from several threads, of different zones.

  /// A zone that need not be baked; it is then in the new world. `zone` is null where no class
  /// stands.
  struct Reused {
    std::unique_ptr<world::Zone> zone;
    format::ZoneEntry entry;
  };
  std::optional<Reused> reuse(int32_t x, int32_t z, uint64_t input) const;

  /// A file of a zone (of its air, regions or links) that need not be made, from the killed bake or
  /// the old world; it is then in the new world. These files carry their input and a sum, so no
  /// journal names them. Null if there is none with this input.
  std::unique_ptr<world::AirZone> reuse_air(int32_t x, int32_t z, uint64_t input) const;
  std::unique_ptr<world::RegionZone> reuse_regions(int32_t x, int32_t z, uint64_t input) const;
  std::unique_ptr<world::LinkZone> reuse_links(int32_t x, int32_t z, uint64_t input) const;
  /// Adds such a file. Fails with kIo.
  Result<void> write_file_of_zone(const std::string& name, std::span<const uint8_t> bytes) const;
  /// The folder of the world in the making: the files of all zones added are there.
  [[nodiscard]] std::string part() const { return part_.string(); }
  [[nodiscard]] const std::string& path() const { return path_; }

  /// Writes the manifest, and that of the air if there is any, and the index of the graph: then
  /// part() is a world that can be opened. `carry_nodes`: see BakeConfig. Fails with kIo.
  Result<void> complete(const world::WorldData& world, const world::GraphData& graph,
                        bool carry_nodes);
  /// Puts the complete world in its place. What it returns keeps other bakes out, but those that
  /// make nodes of it. Fails with kIo.
  Result<FolderLock> finish();

 private:
  struct Done;
  struct Source {
    bool is_part = false;  // the killed bake's folder, not the old world's
    uint64_t input = 0;
    format::ZoneEntry entry;
  };

  explicit WorldFolder(std::string path);
  void read_old();
  std::vector<Done> read_part();
  template <class File>
  std::unique_ptr<File> reuse_file(const std::string& name, uint64_t input) const;

  std::string path_;
  std::filesystem::path part_;
  bool is_owner_ = true;  // not: finished, left, joined or moved from
  bool is_joined_ = false;
  FolderLock part_lock_, old_lock_;
  std::shared_ptr<world::WorldData> old_;
  std::multimap<std::pair<int32_t, int32_t>, Source> sources_;  // by zone, the newest last
};

}  // namespace throng::bake
