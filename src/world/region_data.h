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

#include "throng/base.h"
#include "throng/world.h"
#include "world/region_groups.h"
#include "world/regions_generated.h"
#include "world/zone_data.h"
#include "world/zone_file.h"

/// The accessibility graph in memory: files of zones, mapped, or owned after they were made, and
/// what is known of the whole world. See docs/design/003-graph.md.
namespace throng::world {

inline constexpr uint32_t kGraphVersion = 3;
inline constexpr const char* kGraphIndexName = "graph.thm";

/// Regions of one zone and what links them within it.
struct RegionTables {
  uint32_t classes = 0;         // of the world
  std::vector<uint32_t> first;  // levels + 1
  std::vector<format::Region> regions;
  GroupTables groups;
  std::vector<format::RegionLink> links;
};

/// A connected component within a zone, for one class.
struct ZoneComponent {
  uint32_t avatar_class = 0;
  uint32_t regions = 0;
  uint64_t cells = 0;         // legal
  uint32_t first_region = 0;  // its key is a place of the component
  uint32_t level = 0;         // of the zone: that region's
  uint32_t tile = 0;          // within the zone
  int32_t feet = 0;           // over the middle of the key [mm]
};

/// A file of regions after the verifier and the checks of its numbers.
class RegionZone : public ZoneFile<RegionZone> {
 public:
  [[nodiscard]] const format::ZoneRegions& root() const { return *root_; }
  [[nodiscard]] uint32_t level_count() const { return static_cast<uint32_t>(first_.size()) - 1; }
  [[nodiscard]] uint32_t class_count() const { return root_->classes(); }
  [[nodiscard]] std::span<const format::Region> regions() const { return regions_; }
  /// Regions of a level of the zone: [first, last).
  [[nodiscard]] std::pair<uint32_t, uint32_t> level_regions(uint32_t level) const {
    return {first_[level], first_[level + 1]};
  }
  [[nodiscard]] const RegionGroups& groups() const { return groups_; }
  [[nodiscard]] uint32_t component_count() const { return component_count_; }
  /// All of them, by first region, then class. Reads the whole file.
  [[nodiscard]] std::vector<ZoneComponent> components() const;
  [[nodiscard]] std::span<const format::RegionLink> links() const { return links_; }
  /// Component of a region for a class that has a part in it.
  [[nodiscard]] uint32_t component(uint32_t region, uint32_t avatar_class) const {
    return groups_.component(regions_[region].group(), avatar_class);
  }

 private:
  friend class ZoneFile<RegionZone>;
  Result<void> attach(const std::string& name);
  [[nodiscard]] const char* fault() const;
  [[nodiscard]] bool is_sound(const format::RegionLink& link,
                              std::span<const uint32_t> begins_in) const;

  const format::ZoneRegions* root_ = nullptr;
  std::span<const uint32_t> first_;
  std::span<const format::Region> regions_;
  RegionGroups groups_;
  std::span<const format::RegionLink> links_;
  uint32_t component_count_ = 0;
};

/// A file of links over the eastern and the southern border of a zone, after the checks that it
/// allows by itself: fits() is the rest.
class LinkZone : public ZoneFile<LinkZone> {
 public:
  [[nodiscard]] const format::ZoneLinks& root() const { return *root_; }
  [[nodiscard]] std::span<const format::RegionLink> east() const { return east_; }
  [[nodiscard]] std::span<const format::RegionLink> south() const { return south_; }
  /// Do all links lead from regions of `own` to regions of its neighbours, for classes that both
  /// have? A neighbour that is not there is null.
  [[nodiscard]] bool fits(const RegionZone& own, const RegionZone* east,
                          const RegionZone* south) const;

 private:
  friend class ZoneFile<LinkZone>;
  Result<void> attach(const std::string& name);

  const format::ZoneLinks* root_ = nullptr;
  std::span<const format::RegionLink> east_, south_;
};

/// A connected component of the world, for one class.
struct GraphComponent {
  uint64_t cells = 0;  // legal
  uint32_t regions = 0;
  uint32_t level = 0;              // of the world, of its place
  int32_t cell_x = 0, cell_z = 0;  // of the grid: its place is the middle of this cell
  int32_t feet = 0;                // there [mm]
};

/// What Graph points to. Its zones are those of the world, slot by slot.
struct GraphData {
  struct Slot : ZoneSlot<RegionZone> {
    format::GraphZone entry;
  };

  World world;
  std::string path;  // of the folder; empty: in memory
  std::vector<std::unique_ptr<Slot>> slots;
  std::vector<uint32_t> class_first;             // classes + 1
  std::vector<GraphComponent> components;        // per class the largest first
  std::vector<uint32_t> component_of;            // of components of zones: within their class
  std::vector<uint8_t> class_of;                 // of these
  std::vector<std::vector<Component>> by_class;  // `components` as they are shown
  GraphSummary summary;

  /// The regions of a slot, opened and checked at the first touch; null if they cannot be used.
  [[nodiscard]] const RegionZone* zone(const WorldData& of_world, size_t slot) const;
  /// Opens and checks the links of a slot, and the regions that they join. Fails with kBadFile.
  [[nodiscard]] Result<void> check_links(const WorldData& of_world, size_t slot) const;
  /// Fills `by_class` and the summary's counts from the rest.
  void show(const WorldData& of_world);
};

/// True if regions are of this zone of the world, by their counts and coordinates.
bool is_of_slot(const RegionZone& regions, const WorldData& world, size_t slot);

/// Slot of a zone of the world, or -1.
int32_t slot_at(const WorldData& world, int32_t x, int32_t z);

std::string region_file_name(int32_t x, int32_t z);
std::string link_file_name(int32_t x, int32_t z);

flatbuffers::DetachedBuffer region_zone_bytes(int32_t x, int32_t z, uint64_t input,
                                              const RegionTables& tables);
flatbuffers::DetachedBuffer link_zone_bytes(int32_t x, int32_t z, uint64_t input,
                                            const std::vector<format::RegionLink>& east,
                                            const std::vector<format::RegionLink>& south);

/// `world_hash` is that of the world's manifest.
std::vector<uint8_t> write_graph_index(const GraphData& graph, uint64_t world_hash);
/// Everything but the zones, for a world whose manifest has this hash. Fails with kBadFile and
/// `name`.
Result<std::shared_ptr<GraphData>> read_graph_index(std::span<const uint8_t> bytes,
                                                    const std::string& name, const WorldData& world,
                                                    uint64_t world_hash);

}  // namespace throng::world
