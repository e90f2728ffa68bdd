// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "validate/plane_crowd.h"
#include "validate/statistics.h"
#include "validate/tests.h"
#include "validate/tracks.h"
#include "validate/walked_path.h"

// Experiments of the laboratory of Juelich simulated: the same walls, and each avatar enters at the
// time and place of one person's first recorded position. Recorded and simulated paths are measured
// in the same manner.
namespace throng::validate {
namespace {

constexpr int64_t kHalf = 4;  // steps: speeds are of 0.8 s, so that swaying heads do not count

struct Experiment {
  const char* file;
  const char* title;
  std::vector<Polygon> walls;
  Point2 low, high;            // of the ground
  Point2 box_low, box_high;    // in which density and speed are measured
  CrossedLine line;            // over which flow is measured, and before which paths are
  Point2 goal_low, goal_high;  // both ends; the target is that of the person's walking direction
  bool has_two_ways = false;
};

// A corridor 1.8 m wide and 8 m long, between an entrance and an exit of their own widths.
Experiment open_corridor(const char* file, const char* title, double in, double out) {
  const double middle = 0.9;
  Experiment e{.file = file,
               .title = title,
               .walls = {},
               .low = {-2, -8},
               .high = {4, 9},
               .box_low = {0, -2},
               .box_high = {1.8, 2},
               .line = {{0, -3.5}, {1.8, -3.5}},
               .goal_low = {middle, -7},
               .goal_high = {middle, -7}};
  for (const auto& [z, width] : {std::pair(3.7, in), std::pair(-4.0, out)}) {
    e.walls.push_back(box(-2, z, middle - width / 2, z + 0.3));
    e.walls.push_back(box(middle + width / 2, z, 4, z + 0.3));
  }
  e.walls.push_back(box(-0.5, -3.7, 0, 3.7));
  e.walls.push_back(box(1.8, -3.7, 2.3, 3.7));
  return e;
}

std::vector<Experiment> experiments() {
  std::vector<Experiment> all{
      open_corridor("uo-050-180-180.txt", "one way, entrance 0.5 m", 0.5, 1.8),
      open_corridor("uo-100-180-180.txt", "one way, entrance 1 m", 1.0, 1.8),
      open_corridor("uo-180-180-180.txt", "one way, open", 1.8, 1.8),
      open_corridor("uo-180-180-070.txt", "one way, exit 0.7 m", 1.8, 0.7)};
  all.push_back({.file = "bi_corr_400_b_03.txt",
                 .title = "two ways, 4 m",
                 .walls = {box(-4.8, -0.5, 4.3, 0), box(-4.8, 4, 4.3, 4.5)},
                 .low = {-9, -1.5},
                 .high = {8, 5.5},
                 .box_low = {-2, 0},
                 .box_high = {2, 4},
                 .line = {{0, 0}, {0, 4}},
                 .goal_low = {-8, 2},
                 .goal_high = {7, 2},
                 .has_two_ways = true});
  all.push_back({.file = "040_c_56_h-.txt",
                 .title = "crowd before a gate of 0.5 m",
                 .walls = {box(-3.3, -1, -2.8, 9), box(2.8, -1, 3.3, 9), box(-2.8, -1, -0.25, 0),
                           box(0.25, -1, 2.8, 0)},
                 .low = {-3.3, -5},
                 .high = {3.3, 9},
                 .box_low = {-1, 0.3},
                 .box_high = {1, 2.3},
                 .line = {{-0.25, -0.5}, {0.25, -0.5}},
                 .goal_low = {0, -4},
                 .goal_high = {0, -4}});
  return all;
}

struct Measured {
  size_t passed = 0;
  double flow = 0, density = 0, speed = 0;
  PathMeasures paths;
};

Measured measure(const std::vector<WalkedPath>& walked_paths, const Experiment& e) {
  Measured out;
  std::vector<double> times;
  for (const WalkedPath& walked_path : walked_paths) {
    if (const double t = crossing_time(walked_path, e.line); t >= 0) times.push_back(t);
  }
  std::sort(times.begin(), times.end());
  out.passed = times.size();
  out.flow = flow_rate(times);
  out.paths = measure_paths(walked_paths, e.line);
  if (times.size() < 20) return out;
  const auto step_of = [](double t) { return static_cast<int64_t>(t / PlaneCrowd::kStep); };
  const int64_t begin = step_of(times[times.size() / 10]),
                end = step_of(times[times.size() - 1 - times.size() / 10]);
  double inside = 0, moved = 0, speeds = 0;
  for (const WalkedPath& walked_path : walked_paths) {
    for (size_t i = 0; i < walked_path.at.size(); ++i) {
      const int64_t step = walked_path.first + static_cast<int64_t>(i);
      const Point2& p = walked_path.at[i];
      const bool here =
          p.x >= e.box_low.x && p.x <= e.box_high.x && p.z >= e.box_low.z && p.z <= e.box_high.z;
      if (step < begin || step >= end || !here) continue;
      inside += 1;
      if (i < kHalf || i + kHalf >= walked_path.at.size()) continue;
      const Point2 &a = walked_path.at[i - kHalf], &b = walked_path.at[i + kHalf];
      speeds += std::hypot(b.x - a.x, b.z - a.z) / (2 * kHalf * PlaneCrowd::kStep);
      moved += 1;
    }
  }
  const double area = (e.box_high.x - e.box_low.x) * (e.box_high.z - e.box_low.z);
  out.density = inside / (area * static_cast<double>(end - begin));
  out.speed = speeds / moved;
  return out;
}

// Simulates the people recorded: each enters as recorded and heads to the end it walked to.
Result<std::vector<WalkedPath>> walk(const Experiment& e, const std::vector<WalkedPath>& recorded,
                                     const ValidationConfig& config, ValidationResult& result,
                                     Context& context) {
  PlaneConfig plane;
  plane.ground = box(e.low.x, e.low.z, e.high.x, e.high.z);
  plane.obstacles = e.walls;
  const AvatarClass body;
  auto crowd = PlaneCrowd::create(plane, body, Routing::kPaths, config, context);
  if (!crowd) return crowd.error();
  std::vector<size_t> outside(recorded.size());
  for (size_t n = 0; n < recorded.size(); ++n) outside[n] = n;
  std::sort(outside.begin(), outside.end(), [&](size_t a, size_t b) {
    return std::pair(recorded[a].first, a) < std::pair(recorded[b].first, b);
  });
  std::vector<WalkedPath> walked_paths(recorded.size());
  std::map<uint32_t, size_t> person_of;  // by slot
  int64_t last = 0;
  for (const WalkedPath& walked_path : recorded) {
    last = std::max(last, walked_path.first + static_cast<int64_t>(walked_path.at.size()));
  }
  for (int64_t step = 0; step < 3 * last && !(outside.empty() && crowd->size() == 0); ++step) {
    std::vector<Point2> starts;
    std::vector<size_t> due;
    for (const size_t n : outside) {
      if (recorded[n].first > step) break;
      due.push_back(n);
      starts.push_back(recorded[n].at.front());
    }
    if (!due.empty()) {
      const auto ids = crowd->add(starts, std::vector<double>(starts.size(), body.speed), context);
      if (!ids) return ids.error();
      for (size_t k = 0; k < due.size(); ++k) {
        if (!(*ids)[k]) continue;
        const WalkedPath& own = recorded[due[k]];
        const bool to_low = !e.has_two_ways || own.at.back().x < own.at.front().x;
        crowd->set_goal((*ids)[k], to_low ? e.goal_low : e.goal_high);
        person_of[(*ids)[k].slot1] = due[k];
        walked_paths[due[k]] = {step, {own.at.front()}};
        std::erase(outside, due[k]);
      }
    }
    crowd->step();
    std::vector<AvatarId> leaving;
    for (const AvatarMotion& s : crowd->avatars()) {
      WalkedPath& walked_path = walked_paths[person_of[s.id.slot1]];
      walked_path.at.push_back({s.x, s.z});
      const bool to_low = !e.has_two_ways || recorded[person_of[s.id.slot1]].at.back().x <
                                                 recorded[person_of[s.id.slot1]].at.front().x;
      const Point2& goal = to_low ? e.goal_low : e.goal_high;
      if (std::hypot(s.x - goal.x, s.z - goal.z) < 2) leaving.push_back(s.id);
    }
    crowd->remove(leaving);
    if (context.cancel) return Error{Errc::kCancelled, "cancelled"};
  }
  crowd->report(result);
  return walked_paths;
}

Result<void> compare(const Experiment& e, const std::string& path, const ValidationConfig& config,
                     ValidationResult& result, Context& context) {
  const auto tracks = load_juelich(path);
  if (!tracks) return tracks.error();
  std::vector<WalkedPath> recorded;
  for (const Track& track : tracks->people) {
    WalkedPath walked_path = resampled(track, tracks->fps);
    if (walked_path.at.empty()) continue;
    recorded.push_back(std::move(walked_path));
  }
  const auto is_outside = [&](const WalkedPath& walked_path) {
    const Point2& p = walked_path.at.front();
    return !(p.x > e.low.x && p.x < e.high.x && p.z > e.low.z && p.z < e.high.z);
  };
  if (recorded.empty() || std::ranges::any_of(recorded, is_outside)) {
    return Error{Errc::kBadFile, path +
                                     ": a person is first recorded outside of the experiment's "
                                     "ground; is it another experiment's file?"};
  }
  const auto walked = walk(e, recorded, config, result, context);
  if (!walked) return walked.error();
  const Measured real = measure(recorded, e), ours = measure(*walked, e);
  const auto add_measure = [&](const char* what, double value, const char* unit) {
    result.measures.push_back(
        {.name = std::string(e.title) + ": " + what, .value = value, .unit = unit});
  };
  add_measure("people recorded over the line", static_cast<double>(real.passed), "");
  add_measure("people walked over the line", static_cast<double>(ours.passed), "");
  add_measure("flow, real", real.flow, "p/s");
  add_measure("flow, throng", ours.flow, "p/s");
  add_measure("density, real", real.density, "1/m2");
  add_measure("density, throng", ours.density, "1/m2");
  add_measure("speed, real", real.speed, "m/s");
  add_measure("speed, throng", ours.speed, "m/s");
  const PathMeasures &a = real.paths, &b = ours.paths;
  add_measure("path by straight line, real", a.detour, "");
  add_measure("path by straight line, throng", b.detour, "");
  add_measure("turns of more than 90 degrees, real", 100 * a.turns, "%");
  add_measure("turns of more than 90 degrees, throng", 100 * b.turns, "%");
  add_measure("change of speed in 0.4 s, real", a.speed_change, "m/s");
  add_measure("change of speed in 0.4 s, throng", b.speed_change, "m/s");
  add_measure("walked away from the line, real", a.walked_away, "m");
  add_measure("walked away from the line, throng", b.walked_away, "m");
  return {};
}

}  // namespace

Result<ValidationResult> laboratory(const std::string& folder, const ValidationConfig& config,
                                    Context& context) {
  ValidationResult result;
  std::string known;
  for (const Experiment& e : experiments()) {
    known += (known.empty() ? "" : ", ") + std::string(e.file);
    const std::string path = (std::filesystem::path(folder) / e.file).string();
    std::error_code none;
    if (!std::filesystem::is_regular_file(path, none)) continue;
    if (auto ok = compare(e, path, config, result, context); !ok) return ok.error();
  }
  if (result.measures.empty()) {
    return Error{Errc::kNotFound, folder + ": it holds none of " + known};
  }
  return result;
}

}  // namespace throng::validate
