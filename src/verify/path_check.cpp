// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <chrono>
#include <cmath>
#include <string>
#include <vector>

#include "core/parallel.h"
#include "core/stopwatch.h"
#include "throng/path.h"
#include "throng/verify.h"
#include "throng/world.h"
#include "verify/body_check.h"
#include "verify/check_limits.h"
#include "verify/claims.h"
#include "verify/segment_check.h"
#include "verify/triangle_tree.h"
#include "verify/world_claims.h"

// Every path that the finder of level tiles returns is walked: each segment by the world's own
// moves, and with the exact body against all triangles. The finder searches over rectangles; it is
// compared with cells (moves), triangles, and the graph's components, which do not come from it.
namespace throng {
namespace {

constexpr uint64_t kDraws = 16;           // of a goal in the component of its start
constexpr double kLengthFactor = 1.0001;  // of a path's length, for the rounding of its points

double plan_distance(Vec3d a, Vec3d b) { return std::hypot(b.x - a.x, b.z - a.z); }

struct Walked {
  bool exists = false, reached = false, together = false, illegal = false;
  uint64_t segments = 0;
  double length = 0, straight = 0, seconds = 0;
  Vec3d at, illegal_at;
  verify::SegmentRecord body;
};

class Walker {
 public:
  Walker(const verify::Claims& claims, const Graph& graph, const Scene& scene,
         const VerifyConfig& config)
      : claims_(claims),
        graph_(graph),
        config_(config),
        tree_(scene, config.workers),
        body_(tree_, claims.avatar, claims.cell),
        spacing_(std::min(claims.cell / 2, claims.avatar.radius / 4)) {}

  Walked go(PathFinder& finder, Path& path, uint64_t n) const {
    Walked walked;
    const Place from = claims_.random_place(config_.seed, n * (kDraws + 1));
    if (!from) return walked;
    const int32_t part = part_of(from);
    const Place to = goal_of(n, part);
    walked.exists = true;
    walked.at = from.position;
    walked.together = part >= 0 && part == part_of(to);
    const auto start = Clock::now();
    finder.find({.from = from, .to = to, .nearest = false}, path);
    walked.seconds = seconds_since(start);
    walked.reached = path.end == PathEnd::kReached;
    if (!walked.reached) return walked;
    walked.length = path.length;
    walked.straight = plan_distance(from.position, to.position);
    if (path.points.empty() || !same(path.points.front(), from) || !same(path.points.back(), to)) {
      refuse(walked, from.position);
      return walked;
    }
    double along = 0;
    for (size_t i = 1; i < path.points.size(); ++i) {
      const Place &a = path.points[i - 1], &b = path.points[i];
      ++walked.segments;
      along += plan_distance(a.position, b.position);
      const MoveResult move =
          claims_.move(a, b.position.x - a.position.x, b.position.z - a.position.z);
      if (move.end != MoveEnd::kArrived || !same(move.place, b)) refuse(walked, a.position);
      verify::check_segment(claims_, body_, a, b, spacing_, walked.body);
    }
    // The length is that of the points, which is no shorter than a straight line.
    if (std::fabs(along - walked.length) > (kLengthFactor - 1) * along + claims_.cell / 100 ||
        walked.length * kLengthFactor + claims_.cell / 100 < walked.straight) {
      refuse(walked, from.position);
    }
    return walked;
  }

 private:
  [[nodiscard]] int32_t part_of(const Place& place) const {
    return graph_.component_at(config_.avatar_class, place);
  }

  // Of every second pair one that can be reached, if a few draws find one: in many worlds most of
  // the ground is in small pieces.
  [[nodiscard]] Place goal_of(uint64_t n, int32_t part) const {
    const uint64_t first = n * (kDraws + 1) + 1;
    for (uint64_t k = 0; n % 2 == 1 && k < kDraws; ++k) {
      const Place to = claims_.random_place(config_.seed, first + k);
      if (part_of(to) == part) return to;
    }
    return claims_.random_place(config_.seed, first);
  }

  static bool same(const Place& a, const Place& b) {
    return a.level1 == b.level1 && plan_distance(a.position, b.position) <= verify::kSameLength;
  }

  static void refuse(Walked& walked, Vec3d at) {
    if (!walked.illegal) walked.illegal_at = at;
    walked.illegal = true;
  }

  const verify::Claims& claims_;
  const Graph& graph_;
  const VerifyConfig& config_;
  const verify::TriangleTree tree_;
  const verify::BodyCheck body_;
  double spacing_;  // [m]
};

void add(const Walked& walked, PathReport& report) {
  if (!walked.exists) return;
  const auto count = [&](bool bad, uint64_t& counter, const char* what, Vec3d at) {
    if (!bad) return;
    if (counter++ < verify::kFaultsOfAKind)
      report.faults.push_back({what, at, walked.body.intruder});
  };
  ++report.pairs;
  report.reached += walked.reached ? 1 : 0;
  report.disconnected += !walked.reached && !walked.together ? 1 : 0;
  count(walked.reached != walked.together, report.disagree, "disagree", walked.at);
  count(walked.illegal, report.illegal, "illegal", walked.illegal_at);
  count(walked.body.entered, report.entered, "entered", walked.body.entered_at);
  count(walked.body.unsupported, report.unsupported, "unsupported", walked.body.unsupported_at);
  count(walked.body.broken, report.broken, "broken", walked.body.broken_at);
  report.segments += walked.segments;
  report.bodies += walked.body.bodies;
  report.length += walked.length;
  report.straight += walked.straight;
  report.search_seconds += walked.seconds;
}

}  // namespace

Result<PathReport> verify_paths(const World& world, const Scene& source, const VerifyConfig& config,
                                Context& context) {
  const auto start = Clock::now();
  const auto claims = verify::claims_of(world, config.avatar_class);
  if (!claims) return claims.error();
  if (auto sound = verify::check_source(source, config); !sound) return sound.error();
  const auto graph = Graph::create(world, {.workers = config.workers}, context);
  if (!graph) return graph.error();
  const auto finder = PathFinder::create(
      world,
      {.avatar_class = config.avatar_class, .workers = config.workers, .space = PathSpace::kGround},
      context);
  if (!finder) return finder.error();
  const Walker walker(*claims, *graph, source, config);
  PathReport report;
  report.make_seconds = finder->summary().seconds;
  report.finder_bytes = finder->summary().bytes;
  std::vector<PathFinder> finders(static_cast<size_t>(worker_count(config.workers)), *finder);
  std::vector<Path> paths(finders.size());
  std::vector<Walked> walked;
  for (uint64_t begin = 0; begin < config.samples; begin += verify::kPairBatch) {
    if (context.on_progress) context.on_progress({"verify", begin, config.samples});
    walked.assign(std::min<uint64_t>(verify::kPairBatch, config.samples - begin), {});
    parallel_for_worker(walked.size(), config.workers, [&](size_t i, int32_t worker) {
      if (context.cancel) return;
      const auto w = static_cast<size_t>(worker);
      walked[i] = walker.go(finders[w], paths[w], begin + i);
    });
    if (context.cancel) return Error{Errc::kCancelled, "verify: cancelled"};
    for (const Walked& g : walked) add(g, report);
  }
  report.seconds = seconds_since(start);
  return report;
}

}  // namespace throng
