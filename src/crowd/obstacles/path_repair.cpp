// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "crowd/obstacles/path_repair.h"

#include <cmath>

#include "world/place.h"

// Repairs a path piece by piece: for each stretch that obstacles cover, a bounded search for a
// detour; a full search only if that fails. Time: a move along each piece, and kMaxNodes nodes for
// each detour at most.
namespace throng::crowd {
namespace {

constexpr uint64_t kMaxNodes = 1000;  // of a detour's search

class PathRepair {
 public:
  PathRepair(const world::WorldData& world, path::GroundFinder& live, const StrideGround& ground)
      : world_(world), live_(live), ground_(ground) {}

  [[nodiscard]] bool is_open(const Place& from, const Place& to) const {
    StrideGround::Landing end;
    return ground_.move(from.level1 - 1, 0, point(from), point(to), end) &&
           end.level == to.level1 - 1;
  }
  [[nodiscard]] bool is_whole(const std::vector<Place>& points) const {
    for (size_t i = 1; i < points.size(); ++i) {
      if (!is_open(points[i - 1], points[i])) return false;
    }
    return true;
  }

  // Replaces the covered part of the points by detours. False: these would be too long.
  bool insert_detours(std::vector<Place>& points, double& length, RepairScratch& scratch) const {
    const std::vector<Place>& old = points;
    std::vector<Place>& mended = scratch.points;
    Path& detour = scratch.detour;
    mended.assign(1, old[0]);
    length = 0;
    double covered = 0;  // length that is left out
    for (size_t i = 1; i < old.size(); ++i) {
      const Place& from = mended.back();
      const Place& to = old[i];
      covered += distance(old[i - 1], to);
      if (is_open(from, to)) {
        length += distance(from, to);
        mended.push_back(to);
        covered = 0;
        continue;
      }
      // A covered corner is left out: the path leads around it to the next.
      if (!live_.is_free(to)) continue;
      live_.find(from, to, detour, kMaxNodes);
      if (detour.end != PathEnd::kReached || detour.length > covered + kMaxRepairDetour)
        return false;
      mended.insert(mended.end(), detour.points.begin() + 1, detour.points.end());
      length += detour.length;
      covered = 0;
    }
    if (covered > 0) return false;  // the goal itself
    points.swap(mended);
    return true;
  }

 private:
  [[nodiscard]] world::GroundPoint point(const Place& place) const {
    return world::to_ground(world_, place.position.x, place.position.z);
  }
  static double distance(const Place& a, const Place& b) {
    const double dx = a.position.x - b.position.x, dz = a.position.z - b.position.z;
    return std::sqrt(dx * dx + dz * dz);
  }

  const world::WorldData& world_;
  path::GroundFinder& live_;
  const StrideGround& ground_;
};

}  // namespace

void lead_around(const world::WorldData& world, path::GroundFinder& live,
                 const StrideGround& ground, const SearchBudget& budget, Path& path,
                 RepairScratch& scratch) {
  if (path.points.size() < 2) return;
  const PathRepair repair(world, live, ground);
  if (repair.is_whole(path.points)) return;
  const Place from = path.points.front(), to = path.points.back();
  if (repair.insert_detours(path.points, path.length, scratch)) {
    path.segments.assign(path.points.size() - 1, SegmentKind::kWalk);
    return;
  }
  live.find(from, to, path, budget);
}

}  // namespace throng::crowd
