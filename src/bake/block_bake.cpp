// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <iterator>
#include <numeric>
#include <utility>
#include <vector>

#ifdef __GLIBC__
#include <malloc.h>
#endif

#include "bake/folder/finish_bake.h"
#include "bake/folder/graph_bake.h"
#include "bake/folder/world_bake.h"
#include "bake/folder/world_folder.h"
#include "bake/folder/zone_baker.h"
#include "core/stopwatch.h"
#include "throng/bake.h"
#include "world/zone_data.h"

// A bake of a scene that is never in memory as a whole: the ground and the air of one block
// after the other, then one graph of all zones, which reads their files alone.
namespace throng {
namespace {

// Of the scene of a block, its bins and the codes of its triangles, for one triangle. [bytes]
constexpr uint64_t kBytesATriangle = 160;

// Gives back to the system what the blocks before have left.
void trim_memory() {
#ifdef __GLIBC__
  malloc_trim(0);
#endif
}

class BlockBaker {
 public:
  BlockBaker(const SceneRegions& scene, const BakeConfig& config, bake::WorldFolder& folder,
             Context& context, BakeReport& report)
      : scene_(scene), config_(config), folder_(folder), context_(context), report_(report) {}

  Result<std::shared_ptr<world::WorldData>> run() {
    const auto progress = std::exchange(context_.on_progress, nullptr);
    if (progress) {  // Steps of a block say nothing about the whole.
      context_.on_progress = [&](const Progress&) {
        progress({"bake", places_done_, place_count_});
      };
    }
    auto world = bake_all();
    context_.on_progress = progress;
    return world;
  }

 private:
  Result<std::shared_ptr<world::WorldData>> bake_all() {
    const Scene none;
    const Box3d& bounds = scene_.facts().bounds;
    const auto grid = bake::WorldBake::begin_block(none, config_, nullptr, bounds, {});
    if (!grid) return grid.error();
    grid_ = &*grid;
    const auto part = grid->part();
    if (!part) return part.error();
    part_ = *part;
    place_count_ = grid->place_count();
    if (auto ok = split(grid->all_zones()); !ok) return ok.error();
    if (!has_own_) return bake::WorldBake::no_triangles_in_part();
    sort();
    auto world = grid->world(inputs_, facts_, scene_.facts().triangles, report_);
    if (!world) return world.error();
    grid->set_air(std::move(air_), **world, report_);
    if (context_.on_progress) context_.on_progress({"bake", place_count_, place_count_});
    return world;
  }

  // Halves a rectangle of zones across its longer side until its triangles fit.
  Result<void> split(const world::ZoneRect& zones) {
    const int32_t width = zones.x1 - zones.x0, depth = zones.z1 - zones.z0;
    if (is_left_out(zones)) {
      places_done_ += static_cast<uint64_t>(width) * static_cast<uint64_t>(depth);
      return {};
    }
    const bool fits = scene_.estimate(grid_->box(zones)) <= config_.block_bytes / kBytesATriangle;
    if (fits || (width == 1 && depth == 1)) return bake(zones);
    world::ZoneRect first = zones, second = zones;
    if (width > depth) {
      first.x1 = second.x0 = zones.x0 + width / 2;
    } else {
      first.z1 = second.z0 = zones.z0 + depth / 2;
    }
    if (auto ok = split(first); !ok) return ok;
    return split(second);
  }

  // Of a bake in part: nothing here is to be baked, and there is nothing to be kept.
  [[nodiscard]] bool is_left_out(const world::ZoneRect& zones) const {
    const bool touches =
        zones.x0 < part_.x1 && zones.x1 > part_.x0 && zones.z0 < part_.z1 && zones.z1 > part_.z0;
    return !touches && folder_.old_world() == nullptr;
  }

  Result<void> bake(const world::ZoneRect& zones) {
    auto region = scene_.region(grid_->box(zones), context_);
    if (!region) return region.error();
    const Scene& scene = region->scene;
    if (auto ok = bake::check_triangles(scene); !ok) return ok;
    if (!scene.triangles.empty()) {
      auto begun = bake::WorldBake::begin_block(scene, config_, folder_.old_world(),
                                                scene_.facts().bounds, zones);
      if (!begun) return begun.error();
      if (auto ok = bake(*begun); !ok) return ok;
    }
    places_done_ +=
        static_cast<uint64_t>(zones.x1 - zones.x0) * static_cast<uint64_t>(zones.z1 - zones.z0);
    region = SceneRegion{};
    trim_memory();
    return {};
  }

  Result<void> bake(const bake::WorldBake& block) {
    bake::ZoneBaker zones(block, config_, context_, &folder_);
    if (auto ok = zones.run(); !ok) return ok;
    auto air = block.bake_air(&folder_, context_, report_);
    if (!air) return air.error();
    const auto inputs = block.zones();
    has_own_ = has_own_ || std::any_of(inputs.begin(), inputs.end(), [&](const auto& input) {
                 return part_.contains(input.x(), input.z());
               });
    inputs_.insert(inputs_.end(), inputs.begin(), inputs.end());
    facts_.insert(facts_.end(), zones.facts().begin(), zones.facts().end());
    std::move(air->begin(), air->end(), std::back_inserter(air_));
    return {};
  }

  // By z, then x, as a bake of the whole scene has its zones.
  void sort() {
    std::vector<size_t> order(inputs_.size());
    std::iota(order.begin(), order.end(), size_t{0});
    std::sort(order.begin(), order.end(), [&](size_t a, size_t b) {
      return std::pair{inputs_[a].z(), inputs_[a].x()} < std::pair{inputs_[b].z(), inputs_[b].x()};
    });
    const auto sorted = [&](auto& values) {
      if (values.empty()) return;  // There is no air.
      std::remove_reference_t<decltype(values)> moved;
      for (const size_t i : order) moved.push_back(std::move(values[i]));
      values = std::move(moved);
    };
    sorted(inputs_);
    sorted(facts_);
    sorted(air_);
  }

  const SceneRegions& scene_;
  const BakeConfig& config_;
  bake::WorldFolder& folder_;
  Context& context_;
  BakeReport& report_;
  const bake::WorldBake* grid_ = nullptr;
  world::ZoneRect part_;
  bool has_own_ = false;
  uint64_t places_done_ = 0, place_count_ = 0;
  std::vector<format::ZoneInput> inputs_;
  std::vector<bake::ZoneFacts> facts_;
  bake::AirSlots air_;
};

Result<void> check(const SceneRegions& scene, const BakeConfig& config) {
  if (auto ok = bake::check_settings(config); !ok) return ok;
  if (config.block_bytes == 0) {
    return Error{Errc::kBadConfig, "bake: block_bytes must be above 0"};
  }
  if (scene.facts().triangles == 0) {
    return Error{Errc::kBadInput, "bake: the scene has no triangles"};
  }
  return {};
}

}  // namespace

Result<BakeReport> bake_world_to(const std::string& path, const SceneRegions& scene,
                                 const BakeConfig& config, Context& context) {
  if (auto ok = check(scene, config); !ok) return ok.error();
  auto folder = bake::WorldFolder::begin(path, config.old_zones);
  if (!folder) return folder.error();
  if (auto ok = folder->check_part(config); !ok) return ok.error();
  BakeReport report;
  const auto start = Clock::now();
  BlockBaker baker(scene, config, *folder, context, report);
  auto world = baker.run();
  if (!world) return world.error();
  const auto graph = bake::bake_graph(*folder, **world, config.workers, context, report);
  if (!graph) return graph.error();
  if (auto ok = bake::finish_bake(*folder, **world, **graph, scene, config, context, report); !ok) {
    return ok.error();
  }
  report.seconds_total = seconds_since(start);
  return report;
}

}  // namespace throng
