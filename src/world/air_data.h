// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <flatbuffers/flatbuffers.h>

#include <cstdint>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <vector>

#include "throng/avatar.h"
#include "throng/base.h"
#include "world/air_generated.h"
#include "world/air_tree.h"
#include "world/zone_file.h"

/// The air of a world: which cells over and between its zones' solids are free.
namespace throng::world {

struct WorldData;

inline constexpr uint32_t kAirVersion = 1;
inline constexpr int32_t kMaxAirLayers = 1 << 21;  // above height 0, and below it

/// One air file, after the verifier and the checks of its tree.
class AirZone : public ZoneFile<AirZone> {
 public:
  [[nodiscard]] const format::AirZone& root() const { return *root_; }
  [[nodiscard]] const AirTree& tree() const { return tree_; }

 private:
  friend class ZoneFile<AirZone>;
  Result<void> attach(const std::string& name);

  const format::AirZone* root_ = nullptr;
  AirTree tree_;
};

/// Bytes of an air file.
flatbuffers::DetachedBuffer air_zone_bytes(int32_t x, int32_t z, uint64_t input,
                                           const AirTreeData& tree);

/// The attributes in the number of a free cube: every cell up to `width` cells beside it (x and z)
/// is free, and every cell up to `height` layers over that. Never more than is true; at most 15.
struct AirClearance {
  int32_t width = 0, height = 0;
};
constexpr uint32_t air_clearance_number(AirClearance clearance) {
  return static_cast<uint32_t>(clearance.width | clearance.height << 4);
}
constexpr AirClearance air_clearance(uint32_t number) {
  return {static_cast<int32_t>(number & 15), static_cast<int32_t>(number >> 4 & 15)};
}
inline constexpr int32_t kMaxAirClearance = 15;  // cells

/// A flyer's body in air cells: what must be free around the cell of its feet, wherever in that
/// cell they are.
struct AirBody {
  int32_t reach = 0;                // rows to either side
  int32_t up = 0;                   // layers above that of the feet
  std::vector<int32_t> half_width;  // per row distance 0 to reach: cells to either side along x
};

/// What may be flown in, and where it is kept.
struct AirShape {
  int32_t multiple = 1;            // cells of the world along a side of an air cell
  int32_t cell = 0;                // side of an air cell [mm]
  int32_t origin_y = 0;            // height of layer 0 [mm]
  int32_t floor = 0, ceiling = 0;  // layers [floor, ceiling); above them is open sky
  uint32_t flies = 0;              // bit c: class c flies
  bool points = false;             // bodies are points
};

/// What WorldData::air points to.
struct AirData {
  struct Slot : ZoneSlot<AirZone> {
    format::AirEntry entry;
  };

  AirShape shape;
  int32_t zone_side = 0;         // air cells
  int32_t width = 0, depth = 0;  // of the world [air cells]
  int32_t zones_x = 0, zones_z = 0;
  std::string path;                         // empty: baked in memory
  uint64_t bytes = 0;                       // of all files
  static constexpr int32_t kNotThere = -2;  // WorldConfig::part leaves it out
  std::vector<int32_t> slot_of_zone;        // -1: nothing but air
  std::vector<std::unique_ptr<Slot>> slots;

  /// What of a zone is free, opened and checked at its first touch.
  struct ZoneAir {
    bool usable = false;            // false: its file is damaged; nothing of it may be flown in
    const AirTree* tree = nullptr;  // null: all of it is free
  };
  [[nodiscard]] ZoneAir zone(int32_t x, int32_t z) const;
  /// False: WorldConfig::part leaves the zone out; none of it is free.
  [[nodiscard]] bool is_there(int32_t x, int32_t z) const {
    return slot_of_zone[static_cast<size_t>(z * zones_x + x)] != kNotThere;
  }
  /// Is a cell of the world free? Sky is; what lies under the floor or beside the world is not.
  [[nodiscard]] bool is_free(int32_t x, int32_t y, int32_t z) const;
  /// May a body's feet be anywhere in this cell?
  [[nodiscard]] bool is_legal(const AirBody& body, int32_t x, int32_t y, int32_t z) const;
  /// Sizes and look-ups of a world; `shape` is set.
  void fit(const WorldData& world);
};

AirBody air_body(const AvatarClass& avatar, const AirShape& shape);

std::string air_file_name(int32_t x, int32_t z);
inline constexpr const char* kAirManifest = "air.thm";

/// Fails with kBadFile if the world knows of no air though its folder holds some: its index is
/// gone.
Result<void> check_air_index(const WorldData& world);

/// Everything but the zones. `world_hash` is that of the world's manifest. Fails with kBadFile.
Result<std::shared_ptr<AirData>> read_air_manifest(std::span<const uint8_t> bytes,
                                                   const std::string& name, const WorldData& world,
                                                   uint64_t world_hash);
std::vector<uint8_t> write_air_manifest(const AirData& air, uint64_t world_hash);

}  // namespace throng::world
