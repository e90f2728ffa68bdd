// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <DetourNavMeshQuery.h>
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "detour_mesh.h"
#include "throng/bake.h"
#include "throng/path.h"

// Our paths beside Detour's on one world: the same pairs of places, the same body, one thread, in
// alternating runs. A query is the whole of it: Detour's corridor and straight path, our path with
// all its segments. Finding the polygon, or the level, of an end is outside.
namespace throng::bench {
namespace {

using Json = nlohmann::ordered_json;

struct Options {
  std::string file;
  double cell = 0.1;  // ours; Detour's are 0.3 and 0.2 as usual
  int pairs = 10000;
  int runs = 5;
  bool labels = false;
};

[[noreturn]] void stop(const std::string& message) {
  fmt::print(stderr, "bench_detour: {}\n", message);
  std::exit(2);
}

struct End {
  dtPolyRef polygon = 0;
  float position[3] = {0, 0, 0};
  Place place;
};

struct Found {
  bool reached = false;
  double length = 0;  // in the plane [m]
  std::vector<std::array<double, 2>> points;
};

// Detour's query with the buffers that its users give it.
class Detour {
 public:
  explicit Detour(const dtNavMesh& mesh) {
    constexpr int kNodes = 65535;  // as many as it can have
    if (dtStatusFailed(query_.init(&mesh, kNodes))) stop("Detour's query cannot be made");
  }

  Found find(const End& from, const End& to) {
    Found found;
    int polygons = 0;
    const dtStatus corridor = query_.findPath(from.polygon, to.polygon, from.position, to.position,
                                              &filter_, path_.data(), &polygons, kMax);
    if (dtStatusFailed(corridor) || polygons == 0) return found;
    found.reached = path_[static_cast<size_t>(polygons) - 1] == to.polygon &&
                    !dtStatusDetail(corridor, DT_PARTIAL_RESULT);
    int count = 0;
    query_.findStraightPath(from.position, to.position, path_.data(), polygons, points_.data(),
                            nullptr, nullptr, &count, kMax);
    for (size_t i = 3; i < static_cast<size_t>(count) * 3; i += 3) {
      found.length += std::hypot(points_[i] - points_[i - 3], points_[i + 2] - points_[i - 1]);
    }
    count_ = count;
    return found;
  }

  [[nodiscard]] int count() const { return count_; }
  [[nodiscard]] const float* point(int i) const { return &points_[static_cast<size_t>(i) * 3]; }

  // A random place of the mesh, the same for the same state.
  bool random_end(const dtNavMesh&, float (*random)(), End& end) {
    return dtStatusSucceed(query_.findRandomPoint(&filter_, random, &end.polygon, end.position));
  }

 private:
  static constexpr int kMax = 4096;  // polygons, points
  dtNavMeshQuery query_;
  dtQueryFilter filter_;
  std::vector<dtPolyRef> path_ = std::vector<dtPolyRef>(kMax);
  std::vector<float> points_ = std::vector<float>(static_cast<size_t>(kMax) * 3);
  int count_ = 0;
};

float next_random() {
  static uint64_t state = 1;
  state = state * 6364136223846793005u + 1442695040888963407u;
  return static_cast<float>(state >> 40) / static_cast<float>(1 << 24);
}

double seconds(const std::function<void()>& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

Json spread(const std::vector<double>& values) {
  return {{"median", median(values)},
          {"min", *std::min_element(values.begin(), values.end())},
          {"max", *std::max_element(values.begin(), values.end())}};
}

// Of places of Detour's mesh that are ours, too.
std::vector<std::array<End, 2>> random_pairs(const Options& options, Detour& detour,
                                             const dtNavMesh& mesh, const World& world) {
  std::vector<std::array<End, 2>> pairs;
  uint64_t not_ours = 0;
  while (pairs.size() < static_cast<size_t>(options.pairs)) {
    std::array<End, 2> pair;
    for (End& end : pair) {
      for (;;) {
        if (!detour.random_end(mesh, next_random, end)) stop("Detour's mesh is empty");
        end.place = world.find_place(0, {end.position[0], end.position[1], end.position[2]}, 0.5);
        if (end.place) break;
        if (++not_ours > 100 * static_cast<uint64_t>(options.pairs))
          stop("the two meshes have too little in common");
      }
    }
    pairs.push_back(pair);
  }
  return pairs;
}

Json compare(const Scene& scene, const Options& options) {
  const RecastInput input = make_recast_input(scene);
  const RecastConfig config{.cell = 0.3f, .cell_height = 0.2f, .avatar = AvatarClass{}, .tile = 64};
  DetourSummary summary;
  const NavMesh mesh = make_detour_mesh(input, config, sort_into_tiles(input, config), summary);
  if (mesh == nullptr) stop("Detour's mesh cannot be made");
  Detour detour(*mesh);

  Context context;
  auto world = bake_world(
      scene, {.cell = options.cell, .resolution = 0.1, .classes = {AvatarClass{}}}, context);
  if (!world) stop(world.error().message);
  auto finder = PathFinder::create(
      *world, {.speedup = options.labels ? PathSpeedup::kLabels : PathSpeedup::kNone}, context);
  if (!finder) stop(finder.error().message);

  const std::vector<std::array<End, 2>> pairs = random_pairs(options, detour, *mesh, *world);

  // What both find, and how long it is; and whether Detour's path is legal.
  Path path;
  uint64_t detour_reached = 0, ours_reached = 0, both = 0, detour_legal = 0, missed_legal = 0;
  double detour_length = 0, our_length = 0, worst = 0;
  double legal_detour_length = 0, legal_our_length = 0;
  for (const auto& [from, to] : pairs) {
    const Found d = detour.find(from, to);
    finder->find(from.place, to.place, path);
    const bool ours = path.end == PathEnd::kReached;
    detour_reached += d.reached;
    ours_reached += ours;
    if (!d.reached) continue;
    Place at = from.place;
    bool legal = true;
    for (int i = 1; i < detour.count() && legal; ++i) {
      const float* p = detour.point(i);
      const MoveResult move = world->move(0, at, p[0] - at.position.x, p[2] - at.position.z);
      legal = move.end == MoveEnd::kArrived;
      at = move.place;
    }
    legal = legal && at.level1 == to.place.level1;
    detour_legal += legal;
    missed_legal += legal && !ours;
    if (!ours) continue;
    ++both;
    detour_length += d.length;
    our_length += path.length;
    if (!legal) continue;
    legal_detour_length += d.length;
    legal_our_length += path.length;
    if (d.length > 1) worst = std::max(worst, path.length / d.length);
  }

  std::vector<double> detour_rate, our_rate, ratio;
  for (int run = 0; run < options.runs; ++run) {
    const auto count = static_cast<double>(pairs.size());
    detour_rate.push_back(count / seconds([&] {
                            for (const auto& [from, to] : pairs) (void)detour.find(from, to);
                          }));
    our_rate.push_back(count / seconds([&] {
                         for (const auto& [from, to] : pairs)
                           finder->find(from.place, to.place, path);
                       }));
    ratio.push_back(our_rate.back() / detour_rate.back());
  }
  const PathSummary made = finder->summary();
  return {{"file", options.file},
          {"cell", options.cell},
          {"labels", options.labels},
          {"pairs", pairs.size()},
          {"detour",
           {{"tiles", summary.tiles},
            {"polygons", summary.polygons},
            {"bytes", summary.bytes},
            {"reached", detour_reached},
            {"legal", detour_legal}}},
          {"throng",
           {{"rectangles", made.rectangles},
            {"corners", made.corners},
            {"labels", made.labels},
            {"bytes", made.bytes},
            {"seconds", made.seconds},
            {"reached", ours_reached},
            {"missed_legal", missed_legal}}},
          {"both", both},
          {"mean_length_detour", detour_length / static_cast<double>(both)},
          {"mean_length_throng", our_length / static_cast<double>(both)},
          {"length_ratio", our_length / detour_length},
          {"length_ratio_legal", legal_our_length / legal_detour_length},
          {"length_ratio_worst_legal", worst},
          {"detour_queries_per_s", spread(detour_rate)},
          {"throng_queries_per_s", spread(our_rate)},
          {"ratio", spread(ratio)}};
}

}  // namespace
}  // namespace throng::bench

int main(int argc, char** argv) {
  using namespace throng;
  using namespace throng::bench;
  CLI::App parser{"Our paths beside Detour's", "bench_detour"};
  Options options;
  parser.add_option("file", options.file, "Model")->required();
  parser.add_option("--cell", options.cell, "Side of our cells [m]")->capture_default_str();
  parser.add_option("--pairs", options.pairs, "Random pairs of places")->capture_default_str();
  parser.add_option("--runs", options.runs, "Alternating runs")->capture_default_str();
  parser.add_flag("--labels", options.labels, "Ours by labels");
  CLI11_PARSE(parser, argc, argv);
  Context context;
  SceneConfig config;
  config.sources.push_back({.path = options.file, .up = {}, .scale = {}, .transform = {}});
  const Result<Scene> scene = load_scene(config, context);
  if (!scene) stop(scene.error().message);
  fmt::print("{}\n", compare(*scene, options).dump());
  return 0;
}
