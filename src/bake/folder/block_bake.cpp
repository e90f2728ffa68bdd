// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "bake/folder/block_bake.h"

#include <algorithm>
#include <bit>
#include <iterator>
#include <numeric>
#include <utility>

#ifdef __GLIBC__
#include <malloc.h>
#endif

#include "bake/folder/zone_baker.h"
#include "core/hash.h"

// The grid is that of the whole scene, so zones have the bytes of one bake whatever block they are
// baked in.
namespace throng::bake {
namespace {

// Of the scene of a block, its bins and the codes of its triangles, for one triangle. [bytes]
constexpr uint64_t kBytesATriangle = 160;

// Gives back to the system what the blocks before have left.
void trim_memory() {
#ifdef __GLIBC__
  malloc_trim(0);
#endif
}

template <class T>
void append(std::vector<T>& to, std::vector<T> more) {
  to.insert(to.end(), std::make_move_iterator(more.begin()), std::make_move_iterator(more.end()));
}

}  // namespace

BlockBake::BlockBake(const SceneRegions& scene, const BakeConfig& config,
                     const world::WorldData* old_world, std::unique_ptr<Scene> none, WorldBake grid)
    : scene_(scene),
      config_(config),
      old_world_(old_world),
      none_(std::move(none)),
      grid_(std::move(grid)) {}

Result<void> BlockBake::check(const SceneRegions& scene, const BakeConfig& config) {
  if (auto ok = check_settings(config); !ok) return ok;
  if (config.block_bytes == 0) {
    return Error{Errc::kBadConfig, "bake: block_bytes must be above 0"};
  }
  if (scene.facts().triangles == 0) {
    return Error{Errc::kBadInput, "bake: the scene has no triangles"};
  }
  return {};
}

Result<BlockBake> BlockBake::begin(const SceneRegions& scene, const BakeConfig& config,
                                   const world::WorldData* old_world) {
  auto none = std::make_unique<Scene>();
  auto grid = WorldBake::begin_block(*none, config, nullptr, scene.facts().bounds, {});
  if (!grid) return grid.error();
  BlockBake bake(scene, config, old_world, std::move(none), *std::move(grid));
  const auto part = bake.grid_.part();
  if (!part) return part.error();
  bake.part_ = *part;
  bake.split(bake.grid_.all_zones());
  return bake;
}

uint64_t BlockBake::input_hash() const {
  const auto& facts = scene_.facts();
  std::vector<uint64_t> words{grid_.input_hash(), facts.triangles, facts.patches,
                              facts.patch_triangles, config_.block_bytes};
  for (const Vec3d& corner : {facts.bounds.min, facts.bounds.max}) {
    for (const double at : {corner.x, corner.y, corner.z}) {
      words.push_back(std::bit_cast<uint64_t>(at));
    }
  }
  return hash_span(std::span<const uint64_t>(words));
}

// Halves a rectangle of zones across its longer side until its triangles fit.
void BlockBake::split(const world::ZoneRect& zones) {
  if (is_left_out(zones)) return;
  const int32_t width = zones.x1 - zones.x0, depth = zones.z1 - zones.z0;
  const bool fits = scene_.estimate(grid_.box(zones)) <= config_.block_bytes / kBytesATriangle;
  if (fits || (width == 1 && depth == 1)) {
    blocks_.push_back(zones);
    return;
  }
  world::ZoneRect first = zones, second = zones;
  if (width > depth) {
    first.x1 = second.x0 = zones.x0 + width / 2;
  } else {
    first.z1 = second.z0 = zones.z0 + depth / 2;
  }
  split(first);
  split(second);
}

bool BlockBake::is_left_out(const world::ZoneRect& zones) const {
  const bool touches =
      zones.x0 < part_.x1 && zones.x1 > part_.x0 && zones.z0 < part_.z1 && zones.z1 > part_.z0;
  return !touches && old_world_ == nullptr;
}

Result<BlockMade> BlockBake::bake(const world::ZoneRect& block, WorldFolder& folder,
                                  Context& context) const {
  BlockMade made;
  {
    auto region = scene_.region(grid_.box(block), context);
    if (!region) return region.error();
    const Scene& scene = region->scene;
    if (auto ok = check_triangles(scene); !ok) return ok.error();
    if (!scene.triangles.empty()) {
      auto begun = WorldBake::begin_block(scene, config_, old_world_, scene_.facts().bounds, block);
      if (!begun) return begun.error();
      ZoneBaker zones(*begun, config_, context, &folder);
      if (auto ok = zones.run(); !ok) return ok.error();
      BakeReport report;
      auto air = begun->bake_air(&folder, context, report);
      if (!air) return air.error();
      made.inputs.assign(begun->zones().begin(), begun->zones().end());
      made.facts = std::move(zones.facts());
      made.air = *std::move(air);
      made.air_reused = report.air_zones_reused;
      made.seconds_air = report.seconds_air;
    }
  }
  trim_memory();
  return made;
}

void BlockBake::enter(BlockMade made) {
  has_own_ = has_own_ ||
             std::any_of(made.inputs.begin(), made.inputs.end(),
                         [&](const auto& input) { return part_.contains(input.x(), input.z()); });
  append(made_.inputs, std::move(made.inputs));
  append(made_.facts, std::move(made.facts));
  append(made_.air, std::move(made.air));
  made_.air_reused += made.air_reused;
  made_.seconds_air += made.seconds_air;
}

// By z, then x, as a bake of the whole scene has its zones.
void BlockBake::sort() {
  std::vector<size_t> order(made_.inputs.size());
  std::iota(order.begin(), order.end(), size_t{0});
  const auto& inputs = made_.inputs;
  std::sort(order.begin(), order.end(), [&](size_t a, size_t b) {
    return std::pair{inputs[a].z(), inputs[a].x()} < std::pair{inputs[b].z(), inputs[b].x()};
  });
  const auto sorted = [&](auto& values) {
    if (values.empty()) return;  // There is no air.
    std::remove_reference_t<decltype(values)> moved;
    for (const size_t i : order) moved.push_back(std::move(values[i]));
    values = std::move(moved);
  };
  sorted(made_.facts);
  sorted(made_.air);
  sorted(made_.inputs);
}

Result<BlockBake::Whole> BlockBake::finish() {
  if (!has_own_) return WorldBake::no_triangles_in_part();
  sort();
  return Whole{std::move(made_.inputs), std::move(made_.facts)};
}

Result<std::shared_ptr<world::WorldData>> BlockBake::world(const Whole& whole,
                                                           BakeReport& report) const {
  return grid_.world(whole.inputs, whole.facts, scene_.facts().triangles, report);
}

void BlockBake::set_air(world::WorldData& world, BakeReport& report) {
  report.air_zones_reused += made_.air_reused;
  report.seconds_air += made_.seconds_air;
  grid_.set_air(std::move(made_.air), world, report);
}

}  // namespace throng::bake
