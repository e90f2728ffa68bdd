// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>

#include "core/parallel.h"
#include "throng/path.h"
#include "throng/verify.h"
#include "verify/claims.h"
#include "verify/cylinder.h"
#include "verify/triangle_tree.h"

// The oracle of flyers: whole cylinders, from the feet to the head, where the world says that a
// body may fly and wherever it is on the paths that the finder returns.
namespace throng {
namespace {

using verify::Cylinder;

constexpr uint64_t kMaxFaults = 8;
constexpr uint64_t kFlightBatch = 4096;
constexpr uint64_t kPairsSalt = 0x7061697273;
constexpr double kReach = 0.05;  // of the feet of a place on the ground [m]

struct Record {
  bool reached = false;
  uint64_t segments = 0, positions = 0, entered = 0;
  Vec3d at;
  uint32_t triangle = 0;
};

class FlightJudge {
 public:
  FlightJudge(const verify::TriangleTree& tree, const AvatarClass& avatar)
      : tree_(tree), avatar_(avatar), spacing_(std::min(avatar.radius / 2, avatar.height / 4)) {}

  // Does a solid meet the body whose feet go from `low` to `high` at one place?
  bool meets(Vec3d low, double high, Record& record) const {
    const Cylinder body{
        .x = low.x, .z = low.z, .low = low.y, .high = high, .radius = avatar_.radius};
    return tree_.find(body.bounds(), [&](uint32_t triangle, const verify::Corners& corners) {
      if (!verify::meets(body, corners)) return false;
      record.at = low;
      record.triangle = triangle;
      return true;
    });
  }

  void judge_point(Vec3d feet, Record& record) const {
    if (meets(feet, feet.y + avatar_.height, record)) ++record.entered;
  }

  void judge_path(const Path& path, Record& record) const {
    for (size_t i = 1; i < path.points.size(); ++i) {
      const Vec3d a = path.points[i - 1].position, b = path.points[i].position;
      const SegmentKind kind = path.segments[i - 1];
      if (kind == SegmentKind::kWalk) continue;  // legal moves: verify_world tests these
      ++record.segments;
      if (kind != SegmentKind::kFly) {  // straight up or down: all that it passes at once
        const Vec3d& ground = kind == SegmentKind::kTakeOff ? a : b;
        const Vec3d& air = kind == SegmentKind::kTakeOff ? b : a;
        ++record.positions;
        const Vec3d low{air.x, std::min(ground.y + body_bottom(avatar_), air.y), air.z};
        if (meets(low, air.y + avatar_.height, record)) ++record.entered;
        continue;
      }
      const Vec3d segment = b - a;
      const double length =
          std::sqrt(segment.x * segment.x + segment.y * segment.y + segment.z * segment.z);
      const auto steps = static_cast<uint64_t>(std::ceil(length / spacing_)) + 1;
      bool entered = false;
      for (uint64_t s = 0; s <= steps; ++s) {
        const double t = static_cast<double>(s) / static_cast<double>(steps);
        const Vec3d feet{a.x + t * segment.x, a.y + t * segment.y, a.z + t * segment.z};
        ++record.positions;
        entered = entered || meets(feet, feet.y + avatar_.height, record);
      }
      if (entered) ++record.entered;
    }
  }

 private:
  const verify::TriangleTree& tree_;
  const AvatarClass& avatar_;
  double spacing_;
};

}  // namespace

Result<FlightReport> verify_flight(const World& world, const Scene& source,
                                   const VerifyConfig& config, Context& context) {
  const auto start = std::chrono::steady_clock::now();
  if (auto sound = verify::check_source(source, config); !sound) return sound.error();
  auto finder = PathFinder::create(
      world,
      {.avatar_class = config.avatar_class, .workers = config.workers, .space = PathSpace::kAir},
      context);
  if (!finder) return finder.error();
  const AvatarClass avatar = world.summary().classes[static_cast<size_t>(config.avatar_class)];
  const verify::TriangleTree tree(source, config.workers);
  const FlightJudge judge(tree, avatar);

  FlightReport report;
  report.points = config.samples;
  report.pairs = config.samples / 10;
  struct Worker {
    PathFinder finder;
    Path path;
  };
  std::vector<std::unique_ptr<Worker>> workers;
  for (int32_t i = 0; i < worker_count(config.workers); ++i) {
    workers.push_back(std::make_unique<Worker>(Worker{*finder, {}}));
  }
  // Half of the ends are on the ground, where there is any.
  const auto end_of = [&](PathFinder& from, uint64_t n, uint64_t which) {
    if ((n >> which & 1) != 0) {
      const Place place =
          world.random_place(config.avatar_class, config.seed ^ kPairsSalt, 2 * n + which);
      if (place) return std::optional<Vec3d>(place.position);
    }
    return from.random_point(config.seed ^ kPairsSalt, 2 * n + which);
  };
  const auto judge_one = [&](uint64_t i, Worker& worker, Record& record) {
    if (i < report.points) {
      const auto point = worker.finder.random_point(config.seed, i);
      if (point) judge.judge_point(*point, record);
      return;
    }
    const uint64_t n = i - report.points;
    const auto from = end_of(worker.finder, n, 0), to = end_of(worker.finder, n, 1);
    if (!from || !to) return;
    worker.finder.find({.from = *from, .to = *to, .tolerance = kReach, .nearest = false},
                       worker.path);
    record.reached = worker.path.end == PathEnd::kReached;
    if (record.reached) judge.judge_path(worker.path, record);
  };
  const uint64_t all = report.points + report.pairs;
  std::vector<Record> records;
  for (uint64_t begin = 0; begin < all; begin += kFlightBatch) {
    if (context.on_progress) context.on_progress({"verify", begin, all});
    records.assign(std::min(kFlightBatch, all - begin), {});
    parallel_for_worker(records.size(), config.workers, [&](size_t i, int32_t w) {
      if (!context.cancel) judge_one(begin + i, *workers[static_cast<size_t>(w)], records[i]);
    });
    if (context.cancel) return Error{Errc::kCancelled, "verify: cancelled"};
    for (const Record& record : records) {
      report.reached += record.reached ? 1 : 0;
      report.segments += record.segments;
      report.positions += record.positions;
      report.entered += record.entered;
      if (record.entered > 0 && report.faults.size() < kMaxFaults) {
        report.faults.push_back({"entered", record.at, record.triangle});
      }
    }
  }
  report.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return report;
}

}  // namespace throng
