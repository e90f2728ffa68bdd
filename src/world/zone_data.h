// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "throng/base.h"
#include "throng/world.h"
#include "world/level_view.h"
#include "world/manifest_generated.h"
#include "world/zone_file.h"
#include "world/zone_generated.h"

/// Zones in memory: mapped from files, or owned by a world that was baked in memory.
namespace throng::world {

inline constexpr uint32_t kZoneVersion = 2;
inline constexpr uint32_t kManifestVersion = 2;
inline constexpr int32_t kMaxSlope =
    1 << 23;  // of a plane [1/1024 mm per cell]: no overflow in 64 cells

inline constexpr uint8_t kLastAreaKind = 63;  // that cells may be of; all its bits are set

inline constexpr double kMaxHeight = 1'000'000;  // [m]: differences are whole mm in 32 bits

/// A zone's bytes after the verifier and the checks of its offsets.
class Zone : public ZoneFile<Zone> {
 public:
  [[nodiscard]] const format::Zone& root() const { return *root_; }
  [[nodiscard]] uint32_t level_count() const { return level_count_; }
  [[nodiscard]] const format::Level& level(uint32_t index) const { return levels_[index]; }
  [[nodiscard]] LevelView view(uint32_t index) const;
  /// Levels of a tile of the zone: [first, last).
  [[nodiscard]] std::pair<uint32_t, uint32_t> tile_levels(uint32_t tile) const {
    return {tile_first_[tile], tile_first_[tile + 1]};
  }
  [[nodiscard]] const format::Clearance& clearance(uint32_t level, uint32_t avatar_class) const {
    return clearance_[static_cast<size_t>(level) * class_count_ + avatar_class];
  }
  /// Sets and values in blocks, for the functions of world/cell_blocks.h.
  [[nodiscard]] const uint64_t* words(uint32_t offset) const { return words_ + offset; }

 private:
  friend class ZoneFile<Zone>;
  Result<void> attach(const std::string& name);

  const format::Zone* root_ = nullptr;
  const uint32_t* tile_first_ = nullptr;
  const format::Level* levels_ = nullptr;
  const format::Clearance* clearance_ = nullptr;
  const uint64_t* words_ = nullptr;
  uint32_t level_count_ = 0;
  uint32_t class_count_ = 0;
};

/// Legal cells of a class before each level of the world: made at the first use.
struct ClassIndex {
  std::once_flag once;
  std::vector<uint64_t> cells_before;  // levels + 1
};

struct AirData;

/// Zones [x0, x1) x [z0, z1).
struct ZoneRect {
  int32_t x0 = 0, z0 = 0, x1 = 0, z1 = 0;
  [[nodiscard]] bool contains(int32_t x, int32_t z) const {
    return x >= x0 && x < x1 && z >= z0 && z < z1;
  }
};

/// What World points to.
struct WorldData {
  // Of a zone's memory: not there, or given back; there, but not used since the hand last came by;
  // used since.
  enum class Use : uint8_t { kAway, kIdle, kUsed };
  struct Slot : ZoneSlot<Zone> {
    format::ZoneEntry entry;
    uint32_t first_level = 0;  // of the world
    mutable std::atomic<Use> use{Use::kAway};
  };

  WorldSummary summary;
  int32_t width = 0, depth = 0;  // cells
  uint32_t tiles_per_zone = 0;
  int32_t zones_x = 0, zones_z = 0;
  std::string path;                   // empty: baked in memory
  std::optional<ZoneRect> part;       // WorldConfig::part; none: all zones are there
  uint64_t manifest_hash = 0;         // XXH3 of the manifest, if it was read from a folder
  std::vector<int32_t> slot_of_zone;  // zones_x * zones_z, -1: no levels there
  std::vector<std::unique_ptr<Slot>> slots;
  std::vector<format::ZoneInput> inputs;  // of the zones that were baked
  uint32_t level_count = 0;
  std::vector<std::unique_ptr<ClassIndex>> class_index;  // per class
  std::shared_ptr<const AirData> air;                    // null: baked without

  // Zones in memory. Those beyond the budget are given back, by a clock's hand over the slots.
  uint64_t budget = 0;  // [bytes], 0: none
  mutable std::mutex residency;
  mutable uint64_t resident_bytes = 0, resident_zones = 0;
  mutable size_t hand = 0;  // the slot that it tests next

  /// The zone of a slot, opened and checked at its first touch; null if it cannot be used. It stays
  /// where it is for as long as the world: what a budget gives back comes from its file again.
  [[nodiscard]] const Zone* zone(size_t slot) const {
    const Slot& entry = *slots[slot];
    return entry.use.load(std::memory_order_acquire) == Use::kUsed ? entry.zone.get() : touch(slot);
  }
  /// Slot that holds a level of the world. [level < level_count]
  [[nodiscard]] size_t slot_of_level(uint32_t level) const;
  /// Levels of the world over a tile: [first, last), and the zone; {0, 0} where there are none.
  struct TileLevels {
    const Zone* zone = nullptr;
    uint32_t first = 0, last = 0;  // levels of the world
    uint32_t zone_first = 0;       // first as a level of the zone
  };
  [[nodiscard]] TileLevels tile_levels(int32_t tile_x, int32_t tile_z) const;

 private:
  const Zone* touch(size_t slot) const;
  void open_zone(const Slot& entry) const;
  void make_room(size_t for_slot) const;
};

std::string zone_file_name(int32_t x, int32_t z);

/// Fills everything but the zones from a manifest's bytes. Fails with kBadFile and `name`.
Result<std::shared_ptr<WorldData>> read_manifest(std::span<const uint8_t> bytes,
                                                 const std::string& name);
std::vector<uint8_t> write_manifest(const WorldData& world);

}  // namespace throng::world
