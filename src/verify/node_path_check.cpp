// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/parallel.h"
#include "core/stopwatch.h"
#include "throng/path.h"
#include "throng/verify.h"
#include "verify/check_limits.h"
#include "verify/claims.h"
#include "verify/turned_body.h"

// Every path that the finder returns is walked: along each segment by the parameters of its patch,
// or straight and turning evenly where it crosses from one to the next, and everywhere the class's
// exact cylinder stands along the axis against all triangles.
namespace throng {
namespace {

constexpr double kSeam = 0.12;       // between neighbours' edges [m]
constexpr double kMaxPoses = 20000;  // of a segment

struct NodeWalk {
  bool exists = false, reached = false, together = false;
  uint64_t segments = 0, links = 0, hole_links = 0, poses = 0, entered = 0, unsupported = 0,
           broken = 0;
  std::array<uint64_t, kLinkKinds> kinds{};
  double length = 0, straight = 0, seconds = 0;
  Vec3d at, entered_at, unsupported_at, broken_at;
  uint32_t triangle = 0;
};

// The triangles of a scene and of prisms.
Scene with_obstacles(const Scene& source, std::span<const Prism> prisms) {
  Scene scene;
  if (prisms.empty()) return scene;
  scene.positions = source.positions;
  scene.triangles = source.triangles;
  scene.area = source.area;
  for (const Prism& prism : prisms) {
    const auto first = static_cast<uint32_t>(scene.positions.size());
    const auto count = static_cast<uint32_t>(prism.corners.size());
    for (const double y : {prism.low, prism.high}) {
      for (const auto& [x, z] : prism.corners) scene.positions.push_back({x, y, z});
    }
    for (uint32_t k = 0; k < count; ++k) {
      const uint32_t a = first + k, b = first + (k + 1) % count;
      scene.triangles.push_back({a, b, b + count});
      scene.triangles.push_back({a, b + count, a + count});
      if (k + 2 >= count) continue;
      scene.triangles.push_back({first, first + k + 1, first + k + 2});
      scene.triangles.push_back({first + count, first + count + k + 1, first + count + k + 2});
    }
  }
  scene.area.resize(scene.triangles.size(), kAreaBlocked);
  return scene;
}

class Follower {
 public:
  Follower(const Nodes& nodes, const Scene& scene, const VerifyConfig& config)
      : nodes_(nodes),
        config_(config),
        built_(with_obstacles(scene, config.obstacles)),
        tree_(config.obstacles.empty() ? scene : built_, config.workers),
        avatar_(nodes.summary().classes[static_cast<size_t>(config.avatar_class)]) {
    (void)nodes.components(config.avatar_class, &part_);
    // What leads one way joins no parts, but leads from one into another.
    const auto bit = static_cast<uint16_t>(1u << config.avatar_class);
    for (uint32_t n = 0; n < nodes.node_count(); ++n) {
      if (part_[n] == UINT32_MAX) continue;
      for (const NodeArc& arc : nodes.arcs(n)) {
        if ((arc.classes & bit) != 0 && part_[arc.to] != part_[n]) {
          out_of_.insert({part_[n], part_[arc.to]});
        }
      }
    }
  }

  NodeWalk go(PathFinder& finder, Path& path, uint64_t n) const {
    NodeWalk walked;
    const NodePlace from = nodes_.random_place(config_.avatar_class, config_.seed, 2 * n);
    const NodePlace to = nodes_.random_place(config_.avatar_class, config_.seed, 2 * n + 1);
    if (!from || !to) return walked;
    walked.exists = true;
    walked.at = from.feet;
    walked.together = leads(part_[from.node1 - 1], part_[to.node1 - 1]);
    const auto start = Clock::now();
    finder.find({.from = from, .to = to}, path);
    walked.seconds = seconds_since(start);
    // A place inside an added obstacle is no place.
    if (!config_.obstacles.empty() && path.end == PathEnd::kNoPlace) {
      walked.exists = false;
      return walked;
    }
    walked.reached = path.end == PathEnd::kReached;
    // A path that ends short of the goal must be legal, too.
    walked.length = walked.reached ? path.length : 0;
    walked.straight = walked.reached ? length(to.feet - from.feet) : 0;
    if (path.points.empty()) return walked;
    if (length(path.points.front().position - from.feet) > verify::kSameLength ||
        (walked.reached && length(path.points.back().position - to.feet) > verify::kSameLength)) {
      mark_broken(walked, from.feet);
    }
    for (const PathLink& link : path.links) {
      ++walked.links;
      ++walked.kinds[static_cast<size_t>(link.kind)];
      walked.hole_links += link.over_hole ? 1 : 0;
    }
    size_t next = 0;
    for (size_t i = 1; i < path.points.size(); ++i) {
      while (next < path.links.size() && path.links[next].point < i) ++next;
      const bool linked = next < path.links.size() && path.links[next].point == i;
      // (Where a body begins to fall it is in the air.)
      const bool in_air = !path.node_places[i];
      const bool over_hole = in_air || (linked && path.links[next].over_hole);
      if (linked && path.links[next].kind == LinkKind::kDrop) {
        check_drop(path.node_places, i, walked);
      }
      // What an off-mesh link crosses is not tested.
      if (linked && path.links[next].kind == LinkKind::kOffMesh) continue;
      segment(path.node_places[i - 1], path.node_places[i], path.segments[i - 1], over_hole,
              walked);
    }
    return walked;
  }

 private:
  // Do arcs lead from one part to another, in their directions?
  [[nodiscard]] bool leads(uint32_t from, uint32_t to) const {
    std::vector<uint32_t> reached{from};
    for (size_t i = 0; i < reached.size(); ++i) {
      if (reached[i] == to) return true;
      for (auto next = out_of_.lower_bound({reached[i], 0});
           next != out_of_.end() && next->first == reached[i]; ++next) {
        if (std::find(reached.begin(), reached.end(), next->second) == reached.end()) {
          reached.push_back(next->second);
        }
      }
    }
    return false;
  }

  // Level out, upright, and straight down, as far as the class lets itself down and no farther.
  void check_drop(const std::vector<NodePlace>& places, size_t landing, NodeWalk& walked) const {
    const NodePlace &over = places[landing - 1], &to = places[landing];
    const bool sound = landing >= 2 && !over && over.axis.y == 1 &&
                       places[landing - 2].feet.y == over.feet.y && over.feet.x == to.feet.x &&
                       over.feet.z == to.feet.z && over.feet.y > to.feet.y &&
                       over.feet.y - to.feet.y <= avatar_.max_drop + verify::kSameLength;
    if (!sound) mark_broken(walked, to.feet);
  }

  static void mark_broken(NodeWalk& walked, Vec3d at) {
    if (walked.broken++ == 0) walked.broken_at = at;
  }

  void segment(const NodePlace& from, const NodePlace& to, SegmentKind kind, bool over_hole,
               NodeWalk& walked) const {
    const bool on_surface = kind == SegmentKind::kWalk;
    ++walked.segments;
    const double moved = length(to.feet - from.feet) + avatar_.height * length(to.axis - from.axis);
    const int parts =
        1 + static_cast<int>(std::min(kMaxPoses, std::ceil(4 * moved / avatar_.radius)));
    // From one level tile to the next there may be a step.
    const Vec3d seam = to.feet - from.feet;
    if (!on_surface && !over_hole &&
        (std::hypot(seam.x, seam.z) > kSeam ||
         std::fabs(seam.y) > std::max(kSeam, avatar_.step_height + verify::kSameLength))) {
      mark_broken(walked, to.feet);
    }
    bool entered = false, unsupported = false, broken = false;
    for (int k = 0; k <= parts; ++k) {
      const double f = static_cast<double>(k) / parts;
      verify::Pose pose;
      if (on_surface) {
        const auto along = [&](double a, double b) { return k == parts ? b : a + (b - a) * f; };
        const NodePlace place = nodes_.place(config_.avatar_class, from.node1 - 1,
                                             along(from.s, to.s), along(from.t, to.t));
        broken |= !place || (k == 0 && length(place.feet - from.feet) > verify::kSameLength) ||
                  (k == parts && length(place.feet - to.feet) > kSeam);
        if (!place) break;
        pose = {place.feet, place.axis};
      } else {
        const Vec3d axis = from.axis * (1 - f) + to.axis * f;
        pose = {from.feet * (1 - f) + to.feet * f, axis * (1 / length(axis))};
      }
      ++walked.poses;
      if (const auto triangle = verify::turned_intruder(tree_, avatar_, pose)) {
        if (walked.entered == 0 && !entered) {
          walked.entered_at = pose.feet;
          walked.triangle = *triangle;
        }
        entered = true;
      }
      // (A climber on a link over a hole has no ground there.)
      if (!over_hole && !verify::turned_support(tree_, avatar_, pose.feet)) {
        if (walked.unsupported == 0 && !unsupported) walked.unsupported_at = pose.feet;
        unsupported = true;
      }
    }
    walked.entered += entered ? 1 : 0;
    walked.unsupported += unsupported ? 1 : 0;
    if (broken) mark_broken(walked, from.feet);
  }

  const Nodes& nodes_;
  const VerifyConfig& config_;
  const Scene built_;  // with what was put up, if anything was
  const verify::TriangleTree tree_;
  AvatarClass avatar_;
  std::vector<uint32_t> part_;
  std::set<std::pair<uint32_t, uint32_t>> out_of_;  // parts, and those that arcs lead to from them
};

}  // namespace

Result<NodePathReport> verify_node_paths(const Nodes& nodes, const Scene& source,
                                         const VerifyConfig& config, Context& context) {
  const auto start = Clock::now();
  if (auto sound = verify::check_source(source, config); !sound) return sound.error();
  PathConfig settings{.avatar_class = config.avatar_class,
                      .workers = config.workers,
                      .space = PathSpace::kNodes,
                      .nodes = nodes};
  for (const Prism& prism : config.obstacles) {
    if (auto added = settings.edits.add_obstacle(prism); !added) return added.error();
  }
  const auto finder = PathFinder::create(nodes.world(), settings, context);
  if (!finder) return finder.error();
  const Follower follower(nodes, source, config);
  NodePathReport report;
  report.make_seconds = finder->summary().seconds;
  report.finder_bytes = finder->summary().bytes;
  std::vector<PathFinder> finders(static_cast<size_t>(worker_count(config.workers)), *finder);
  std::vector<Path> paths(finders.size());
  std::vector<NodeWalk> walked;
  for (uint64_t begin = 0; begin < config.samples; begin += verify::kPairBatch) {
    if (context.cancel) return Error{Errc::kCancelled, "verify: cancelled"};
    if (context.on_progress) context.on_progress({"verify", begin, config.samples});
    walked.assign(std::min<uint64_t>(verify::kPairBatch, config.samples - begin), {});
    parallel_for_worker(walked.size(), config.workers, [&](size_t i, int32_t worker) {
      const auto w = static_cast<size_t>(worker);
      walked[i] = follower.go(finders[w], paths[w], begin + i);
    });
    for (const NodeWalk& g : walked) {
      if (!g.exists) continue;
      const auto count = [&](uint64_t bad, uint64_t& counter, const char* what, Vec3d at) {
        if (bad == 0) return;
        if (counter < verify::kFaultsOfAKind) report.faults.push_back({what, at, g.triangle});
        counter += bad;
      };
      ++report.pairs;
      report.reached += g.reached ? 1 : 0;
      report.disconnected += !g.reached && !g.together ? 1 : 0;
      const bool is_blocked = g.together && !g.reached && !config.obstacles.empty();
      report.blocked += is_blocked ? 1 : 0;
      count(g.reached != g.together && !is_blocked ? 1 : 0, report.disagree, "disagree", g.at);
      count(g.entered, report.entered, "entered", g.entered_at);
      count(g.unsupported, report.unsupported, "unsupported", g.unsupported_at);
      count(g.broken, report.broken, "broken", g.broken_at);
      report.segments += g.segments;
      report.links += g.links;
      report.hole_links += g.hole_links;
      report.poses += g.poses;
      report.length += g.length;
      report.straight += g.straight;
      report.search_seconds += g.seconds;
      for (size_t k = 0; k < kLinkKinds; ++k) report.links_of_kind[k] += g.kinds[k];
    }
  }
  report.seconds = seconds_since(start);
  return report;
}

}  // namespace throng
