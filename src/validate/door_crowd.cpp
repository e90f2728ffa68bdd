// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "validate/door_crowd.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "core/random.h"

// The people wait in a half circle around the door, and walk on to places beyond it.
namespace throng::validate {
namespace {

constexpr double kRoomLong = 12, kRoomWide = 12;  // [m] before the bottleneck
constexpr double kExitLength = 8;                 // [m] behind it
constexpr double kWallThickness = 1;              // [m] of the wall: how long the bottleneck is
constexpr double kStart = 3.3;                    // [1/m2] of the people that wait
constexpr double kLine = kRoomLong + kWallThickness / 2;

PlaneConfig door_plane(double width) {
  PlaneConfig plane;
  const double all = kRoomLong + kWallThickness + kExitLength;
  plane.ground = box(-0.5, -0.5, all + 0.5, kRoomWide + 0.5);
  const double low = (kRoomWide - width) / 2, high = (kRoomWide + width) / 2;
  plane.obstacles = {box(kRoomLong, -0.5, kRoomLong + kWallThickness, low),
                     box(kRoomLong, high, kRoomLong + kWallThickness, kRoomWide + 0.5),
                     box(-0.5, -0.5, 0, kRoomWide + 0.5), box(0, -0.5, kRoomLong, 0),
                     box(0, kRoomWide, kRoomLong, kRoomWide + 0.5)};
  return plane;
}

// Start points in a half circle around the door, nearest first.
std::vector<Point2> waiting(const DoorConfig& door, uint64_t seed) {
  const double apart = 1 / std::sqrt(kStart), spare = apart - 2 * AvatarClass{}.radius - 0.004;
  std::vector<Point2> starts;
  for (double x = kRoomLong - 0.8; x > 0.5; x -= apart) {
    for (double z = 0.5; z < kRoomWide - 0.5; z += apart) {
      const uint64_t n = starts.size();
      starts.push_back({x + spare * (random_unit(seed, 1, n) - 0.5),
                        z + spare * (random_unit(seed, 2, n) - 0.5)});
    }
  }
  const auto off = [](const Point2& s) { return std::hypot(s.x - kRoomLong, s.z - kRoomWide / 2); };
  std::sort(starts.begin(), starts.end(),
            [&](const Point2& a, const Point2& b) { return off(a) < off(b); });
  starts.resize(std::min<size_t>(starts.size(), door.people));
  return starts;
}

// Takes down where the avatars are, and which have passed.
class DoorWatch {
 public:
  DoorWatch(std::span<const AvatarId> ids, DoorRun& run) : run_(run) {
    for (size_t i = 0; i < ids.size(); ++i) person_of_[ids[i].slot1] = i;
    run_.paths.resize(ids.size());
    run_.orientations.resize(ids.size());
  }

  void see(const AvatarMotion& s, double time) {
    if (through_.contains(s.id.slot1)) return;  // only the first time counts
    const size_t person = person_of_.at(s.id.slot1);
    run_.paths[person].at.push_back({s.x, s.z});
    run_.orientations[person].push_back({s.heading_x, s.heading_z});
    const double before = s.x - s.vx * PlaneCrowd::kStep;
    if (!(before < kLine && s.x >= kLine)) return;
    through_.insert(s.id.slot1);
    run_.times.push_back(time - (s.x - kLine) / std::max(1e-9, s.vx));
  }

 private:
  DoorRun& run_;
  std::map<uint32_t, size_t> person_of_;  // by slot
  std::set<uint32_t> through_;
};

}  // namespace

Result<DoorRun> pass_door(const DoorConfig& door, const ValidationConfig& config,
                          ValidationResult& result, Context& context) {
  auto crowd = PlaneCrowd::create(door_plane(door.width), {}, Routing::kPaths, config, context);
  if (!crowd) return crowd.error();
  const auto ids = crowd->add_fitting(waiting(door, config.seed), door.speed, context);
  if (!ids) return ids.error();
  for (size_t i = 0; i < ids->size(); ++i) {
    const double z = 1 + (kRoomWide - 2) * random_unit(config.seed, 3, i);
    crowd->set_goal((*ids)[i], {kRoomLong + kWallThickness + kExitLength - 0.5, z});
  }
  DoorRun run;
  run.line = {{kLine, (kRoomWide - door.width) / 2}, {kLine, (kRoomWide + door.width) / 2}};
  DoorWatch watch(*ids, run);
  for (const AvatarMotion& s : crowd->avatars()) watch.see(s, 0);
  const double limit = 60 + 3.0 * door.people / door.width;
  while (crowd->size() > 0 && crowd->time() < limit) {
    crowd->step();
    if (context.cancel) return Error{Errc::kCancelled, "cancelled"};
    std::vector<AvatarId> leaving;
    for (const AvatarMotion& s : crowd->avatars()) {
      watch.see(s, crowd->time());
      if (s.x > kRoomLong + kWallThickness + kExitLength - 2) leaving.push_back(s.id);
    }
    crowd->remove(leaving);
  }
  std::sort(run.times.begin(), run.times.end());
  crowd->report(result);
  return run;
}

std::string at_width(const char* what, double width) {
  return fmt::format("{}, {:.1f} m", what, width);
}

}  // namespace throng::validate
