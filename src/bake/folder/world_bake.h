// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <flatbuffers/flatbuffers.h>

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "bake/folder/air_bake.h"
#include "bake/folder/world_folder.h"
#include "bake/folder/zone_bake.h"
#include "throng/bake.h"
#include "throng/base.h"
#include "throng/scene.h"
#include "world/air_data.h"
#include "world/zone_data.h"

/// A world's bake as zones that know nothing of each other: what a bake by one process and one by
/// many share.
namespace throng::bake {

/// Fails with kBadConfig or kBadInput.
Result<void> check_bake(const Scene& scene, const BakeConfig& config);
/// The two halves of it; a scene without triangles passes.
Result<void> check_settings(const BakeConfig& config);
Result<void> check_triangles(const Scene& scene);

/// What the world needs of a zone that was baked or reused, without its bytes. Trivial: ranks send
/// it as it is.
struct ZoneFacts {
  format::ZoneEntry entry;
  uint32_t flat_levels = 0;
  bool reused = false;
  uint64_t spans = 0;
  std::array<uint64_t, kMaxAvatarClasses> legal_cells{};
  double seconds_columns = 0, seconds_levels = 0, seconds_clearance = 0, seconds_write = 0;
};

/// The air of zones; null: there is nothing but air.
using AirSlots = std::vector<std::unique_ptr<world::AirData::Slot>>;

class WorldBake {
 public:
  /// Scene and config must outlive it. `old_world` may be null; without `hashed` no zone can be
  /// kept. Fails with kLimit.
  static Result<WorldBake> begin(const Scene& scene, const BakeConfig& config,
                                 const world::WorldData* old_world, bool hashed);
  /// The same for some zones of a scene that is larger. `scene` has at least the triangles of
  /// box(zones), in their order; `bounds` are those of the whole scene. The grid is theirs,
  /// whatever the old world's.
  static Result<WorldBake> begin_block(const Scene& scene, const BakeConfig& config,
                                       const world::WorldData* old_world, const Box3d& bounds,
                                       const world::ZoneRect& zones);
  /// Of zones that are all there, on the grid of `like` and with its bounds: nothing can be baked.
  /// `none` is a scene without triangles.
  static Result<WorldBake> begin_join(const Scene& none, const BakeConfig& config,
                                      const world::WorldData& like,
                                      std::vector<format::ZoneInput> inputs);
  WorldBake(WorldBake&& other) noexcept;
  WorldBake& operator=(WorldBake&&) = delete;
  ~WorldBake();

  /// The zones that have triangles, by z, then x.
  [[nodiscard]] std::span<const format::ZoneInput> zones() const;
  /// What a bake without a zone in BakeConfig::part fails with.
  [[nodiscard]] static Error no_triangles_in_part();
  /// All of the grid's.
  [[nodiscard]] world::ZoneRect all_zones() const;
  /// What the bake of some zones looks at, seen from above. [m]
  [[nodiscard]] Box3d box(const world::ZoneRect& zones) const;
  /// The zones of BakeConfig::part, or all. Fails with kBadConfig.
  [[nodiscard]] Result<world::ZoneRect> part() const;
  /// Zones of the grid, with triangles or without, and which of them `zone` is.
  [[nodiscard]] uint64_t place_count() const;
  [[nodiscard]] uint64_t place(size_t zone) const;
  [[nodiscard]] size_t triangle_count(size_t zone) const;
  /// Of all zones' inputs and the grid: equal where two processes bake the same.
  [[nodiscard]] uint64_t input_hash() const;

  /// False if the context was cancelled. `bytes` are empty where no class can stand.
  bool bake(size_t zone, ZoneScratch& scratch, Context& context, ZoneFacts& facts,
            flatbuffers::DetachedBuffer& bytes) const;
  [[nodiscard]] ZoneFacts facts_of(const WorldFolder::Reused& reused) const;

  /// A world of zones in their order, by z, then x, and what its bake did but for the time it took.
  /// `triangles` are those of the whole scene. Fails with kLimit.
  [[nodiscard]] Result<std::shared_ptr<world::WorldData>> world(
      std::span<const format::ZoneInput> inputs, std::span<const ZoneFacts> facts,
      uint64_t triangles, BakeReport& report) const;
  /// The same of all zones of this bake.
  [[nodiscard]] Result<std::shared_ptr<world::WorldData>> world(std::span<const ZoneFacts> facts,
                                                                BakeReport& report) const;
  /// Does the config require air?
  [[nodiscard]] bool has_air() const;
  /// For the air of zones: one at a time, of several by as many of these.
  [[nodiscard]] AirBaker air_baker(const WorldFolder* folder, int32_t workers) const;
  /// The air of one zone; null: there is nothing but air. Fails with kIo, kLimit or kCancelled.
  [[nodiscard]] Result<std::unique_ptr<world::AirData::Slot>> bake_air(size_t zone, AirBaker& baker,
                                                                       Context& context) const;
  /// The air of the zones, in their order, if the config requires any: into the folder, or into
  /// memory if it is null. Fails with kIo, kLimit or kCancelled.
  [[nodiscard]] Result<AirSlots> bake_air(WorldFolder* folder, Context& context,
                                          BakeReport& report) const;
  /// Gives a world the air of all its zones, if the config requires any.
  void set_air(AirSlots slots, world::WorldData& world, BakeReport& report) const;
  /// The air of a world of all zones of this bake: the two above.
  Result<void> add_air(WorldFolder* folder, world::WorldData& world, Context& context,
                       BakeReport& report) const;

 private:
  struct Plan;
  explicit WorldBake(std::unique_ptr<Plan> plan);
  [[nodiscard]] uint64_t place_of(const format::ZoneInput& input) const;

  std::unique_ptr<Plan> plan_;
};

}  // namespace throng::bake
