// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "recast_bake.h"
#include "throng/bake.h"

// Our bake beside Recast's on one world: the same triangles, cells and body, in one process, in
// alternating runs; medians, spreads and their ratios. Reading and writing files is outside.
namespace throng::bench {
namespace {

using Json = nlohmann::ordered_json;

struct Options {
  std::string file;
  double cell = 0.1;
  double cell_height = 0.1;
  int runs = 5;
  std::string tiling = "none";
  bool far_triangle = false;
  bool bytes = false;
  bool one_sided = false;
};

double milliseconds(const std::function<void()>& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start)
      .count();
}

struct Times {
  std::vector<double> ms;

  [[nodiscard]] double at(double share) const {
    std::vector<double> sorted = ms;
    std::sort(sorted.begin(), sorted.end());
    return sorted[static_cast<size_t>(share * static_cast<double>(sorted.size() - 1) + 0.5)];
  }
  [[nodiscard]] Json json() const { return {{"median", at(0.5)}, {"min", at(0)}, {"max", at(1)}}; }
};

[[noreturn]] void stop(const std::string& message) {
  fmt::print(stderr, "bench_recast: {}\n", message);
  std::exit(2);
}

World bake_ours(const Scene& scene, const Options& options, int32_t workers,
                std::vector<AvatarClass> classes, BakeReport* report = nullptr) {
  Context context;
  Result<World> world = bake_world(scene,
                                   {.cell = options.cell,
                                    .resolution = options.cell_height,
                                    .one_sided = options.one_sided,
                                    .classes = std::move(classes),
                                    .workers = workers},
                                   context, report);
  if (!world) stop(world.error().message);
  return *std::move(world);
}

// Recast leaves the tile's side to its user: give it the one that it likes best here.
RecastConfig best_tiling(const RecastInput& input, RecastConfig config) {
  RecastConfig best = config;
  double best_ms = 0;
  for (const int32_t tile : {64, 96, 128, 192, 256}) {
    config.tile = tile;
    const TileTriangles tiles = sort_into_tiles(input, config);
    const double ms = milliseconds([&] { (void)recast_bake(input, config, tiles); });
    if (best_ms == 0 || ms < best_ms) {
      best = config;
      best_ms = ms;
    }
  }
  return best;
}

RecastConfig recast_config(const Options& options, const RecastInput& input) {
  RecastConfig config{.cell = static_cast<float>(options.cell),
                      .cell_height = static_cast<float>(options.cell_height),
                      .avatar = AvatarClass{},
                      .tile = 0};
  if (options.tiling == "best") return best_tiling(input, config);
  if (options.tiling != "none") config.tile = std::stoi(options.tiling);
  return config;
}

Json compare_speed(const Scene& scene, const Options& options) {
  const RecastInput input = make_recast_input(scene);
  const RecastConfig config = recast_config(options, input);
  const TileTriangles tiles = sort_into_tiles(input, config);
  Times recast;
  Times one;
  Times two;
  Times ratio_one;
  Times ratio_two;
  RecastResult found;
  BakeReport report;
  // Each twice, of which the second is timed: a core that slept while another was at work takes
  // some milliseconds until it is at full speed.
  const auto warm_milliseconds = [](auto work) {
    work();
    return milliseconds(work);
  };
  for (int run = 0; run < options.runs; ++run) {
    recast.ms.push_back(warm_milliseconds([&] { found = recast_bake(input, config, tiles); }));
    one.ms.push_back(
        warm_milliseconds([&] { (void)bake_ours(scene, options, 1, {AvatarClass{}}, &report); }));
    two.ms.push_back(
        warm_milliseconds([&] { (void)bake_ours(scene, options, 2, {AvatarClass{}}); }));
    ratio_one.ms.push_back(recast.ms.back() / one.ms.back());
    ratio_two.ms.push_back(recast.ms.back() / two.ms.back());
  }
  const double cell_area = options.cell * options.cell;
  return {{"recast_tile", config.tile},
          {"recast_ms", recast.json()},
          {"throng_1_ms", one.json()},
          {"throng_2_ms", two.json()},
          {"ratio_1", ratio_one.json()},
          {"ratio_2", ratio_two.json()},
          {"recast_walkable_m2", static_cast<double>(found.walkable) * cell_area},
          {"throng_walkable_m2", report.walkable_area.front()}};
}

Json compare_bytes(const Scene& scene, const Options& options) {
  const RecastInput input = make_recast_input(scene);
  RecastConfig config = recast_config(options, input);
  const TileTriangles tiles = sort_into_tiles(input, config);
  uint64_t bytes = 0;
  uint64_t walkable = 0;
  for (const AvatarClass& avatar : default_classes()) {
    config.avatar = avatar;
    const RecastResult found = recast_bake(input, config, tiles);
    bytes += found.bytes;
    if (walkable == 0) walkable = found.walkable;
  }
  BakeReport report;
  (void)bake_ours(scene, options, 0, default_classes(), &report);
  const double recast_area = static_cast<double>(walkable) * options.cell * options.cell;
  const double area = report.walkable_area.front();
  return {{"classes", default_classes().size()},
          {"recast_bytes", bytes},
          {"recast_walkable_m2", recast_area},
          {"recast_bytes_per_m2", recast_area > 0 ? static_cast<double>(bytes) / recast_area : 0},
          {"throng_bytes", report.bytes},
          {"throng_walkable_m2", area},
          {"throng_bytes_per_m2", area > 0 ? static_cast<double>(report.bytes) / area : 0}};
}

// How far the floors of a world move when a triangle is added 2 km below it.
struct Shift {
  uint64_t floors = 0;
  uint64_t lost = 0;   // Floors whose column has none any more.
  uint64_t moved = 0;  // By more than a millimetre and, for Recast, more than a cell's height.
  double largest = 0;  // [m]
};

Json shift_json(const Shift& shift) {
  return {{"floors", shift.floors},
          {"lost", shift.lost},
          {"moved", shift.moved},
          {"largest_m", shift.largest}};
}

using Floors = std::map<std::pair<int32_t, int32_t>, std::vector<double>>;

Shift compare_floors(const Floors& before, const Floors& after, double tolerance) {
  Shift shift;
  for (const auto& [column, heights] : before) {
    const auto found = after.find(column);
    for (const double height : heights) {
      ++shift.floors;
      if (found == after.end()) {
        ++shift.lost;
        continue;
      }
      double nearest = INFINITY;
      for (const double other : found->second) {
        nearest = std::min(nearest, std::abs(other - height));
      }
      if (nearest > tolerance) ++shift.moved;
      shift.largest = std::max(shift.largest, nearest);
    }
  }
  return shift;
}

Floors recast_floors(const Scene& scene, const Options& options) {
  const RecastInput input = make_recast_input(scene);
  const RecastConfig config = recast_config(options, input);
  std::vector<RecastFloor> list;
  (void)recast_bake(input, config, sort_into_tiles(input, config), &list);
  Floors floors;
  for (const RecastFloor& floor : list) floors[{floor.x, floor.z}].push_back(floor.height);
  return floors;
}

Floors our_floors(const Scene& scene, const Options& options) {
  const World world = bake_ours(scene, options, 0, {AvatarClass{}});
  const WorldSummary summary = world.summary();
  Floors floors;
  for (uint32_t i = 0; i < world.level_tile_count(); ++i) {
    const LevelTileContent tile = world.level_tile(i);
    for (int32_t cell = 0; cell < kTileCells * kTileCells; ++cell) {
      const auto index = static_cast<size_t>(cell);
      if (tile.floor[index] == kNoFloor || tile.clearance.front()[index] == 0) continue;
      const int32_t x = tile.tile_x * kTileCells + cell % kTileCells;
      const int32_t z = tile.tile_z * kTileCells + cell / kTileCells;
      floors[{x, z}].push_back(summary.origin.y + tile.floor[index] * 0.001);
    }
  }
  return floors;
}

Json compare_far_triangle(const Scene& scene, const Options& options) {
  Scene far = scene;
  const Box3d box = scene.bounds();
  const double y = box.min.y - 2000;
  far.add_triangle({box.min.x, y, box.min.z}, {box.min.x, y, box.min.z + 1},
                   {box.min.x + 1, y, box.min.z});
  const Shift recast = compare_floors(recast_floors(scene, options), recast_floors(far, options),
                                      options.cell_height * 1.001);
  const Shift ours = compare_floors(our_floors(scene, options), our_floors(far, options), 0.001);
  return {{"recast", shift_json(recast)}, {"throng", shift_json(ours)}};
}

std::string text(const Json& json) {
  std::string out;
  for (const auto& [key, value] : json.items()) out += fmt::format("{}: {}\n", key, value.dump());
  return out;
}

}  // namespace
}  // namespace throng::bench

int main(int argc, char** argv) {
  using namespace throng;
  using namespace throng::bench;
  CLI::App parser{"Our bake beside Recast's", "bench_recast"};
  Options options;
  bool json = false;
  parser.add_option("file", options.file, "Model")->required();
  parser.add_option("--cell", options.cell, "Side of a cell [m]")->capture_default_str();
  parser
      .add_option("--cell-height", options.cell_height, "Our resolution, Recast's cell height [m]")
      ->capture_default_str();
  parser.add_option("--runs", options.runs, "Alternating runs")->capture_default_str();
  parser.add_option("--tiling", options.tiling, "Recast's tiles: none, best, or a side in cells")
      ->capture_default_str();
  parser.add_flag("--bytes", options.bytes, "Compare bytes for the four default classes");
  parser.add_flag("--one-sided", options.one_sided,
                  "Ours takes for floor only what faces up, as Recast does");
  parser.add_flag("--far-triangle", options.far_triangle, "Add a triangle 2 km below and compare");
  parser.add_flag("--json", json, "One JSON object");
  CLI11_PARSE(parser, argc, argv);

  Context context;
  SceneConfig config;
  config.sources.push_back({.path = options.file, .up = {}, .scale = {}, .transform = {}});
  const Result<Scene> scene = load_scene(config, context);
  if (!scene) stop(scene.error().message);
  Json result = {{"file", options.file},
                 {"triangles", scene->triangles.size()},
                 {"cell", options.cell},
                 {"cell_height", options.cell_height}};
  if (options.far_triangle) {
    result["far_triangle"] = compare_far_triangle(*scene, options);
  } else if (options.bytes) {
    result["bytes"] = compare_bytes(*scene, options);
  } else {
    result["speed"] = compare_speed(*scene, options);
  }
  fmt::print("{}", json ? result.dump() + "\n" : text(result));
  return 0;
}
