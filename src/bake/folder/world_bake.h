// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <flatbuffers/flatbuffers.h>

#include <array>
#include <cstdint>
#include <memory>
#include <span>

#include "bake/folder/world_folder.h"
#include "bake/folder/zone_bake.h"
#include "throng/bake.h"
#include "throng/base.h"
#include "throng/scene.h"
#include "world/zone_data.h"

/// A world's bake as zones that know nothing of each other: what a bake by one process and one by
/// many share.
namespace throng::bake {

/// Fails with kBadConfig or kBadInput.
Result<void> check_bake(const Scene& scene, const BakeConfig& config);

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

class WorldBake {
 public:
  /// Scene and config must outlive it. `old_world` may be null; without `hashed` no zone can be
  /// kept. Fails with kLimit.
  static Result<WorldBake> begin(const Scene& scene, const BakeConfig& config,
                                 const world::WorldData* old_world, bool hashed);
  WorldBake(WorldBake&& other) noexcept;
  WorldBake& operator=(WorldBake&&) = delete;
  ~WorldBake();

  /// The zones that have triangles, by z, then x.
  [[nodiscard]] std::span<const format::ZoneInput> zones() const;
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

  /// The world of all zones, in their order, and what its bake did but for the time it took. Fails
  /// with kLimit.
  [[nodiscard]] Result<std::shared_ptr<world::WorldData>> world(std::span<const ZoneFacts> facts,
                                                                BakeReport& report) const;
  /// The air of a world of all zones, if the config requires any: into the folder, or into memory
  /// if it is null. Fails with kIo, kLimit or kCancelled.
  Result<void> add_air(WorldFolder* folder, world::WorldData& world, Context& context,
                       BakeReport& report) const;

 private:
  struct Plan;
  explicit WorldBake(std::unique_ptr<Plan> plan);

  std::unique_ptr<Plan> plan_;
};

}  // namespace throng::bake
