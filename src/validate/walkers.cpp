// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <limits>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "steer/social_force.h"
#include "throng/papers.h"
#include "validate/plane_crowd.h"
#include "validate/tests.h"
#include "validate/tracks.h"

// Predictions of the positions of people in a street for 4.8 s, from their present position and
// velocity, beside their recorded positions: constant velocity, [HM95], [CAACD] and our crowd. No
// prediction has destinations.
namespace throng::validate {
namespace {

constexpr double kSample = 0.4;  // [s] between positions in the scenes
constexpr size_t kHorizon = 12;  // samples
constexpr int kStepsASample = 4;
constexpr double kStanding = 0.05;  // [m/s] A slower person stands.

enum Model : size_t { kReal, kOurs, kConstant, kForce, kCurves, kModels };
constexpr std::array<const char*, kModels> kNames{"real", "throng", "constant velocity",
                                                  "social force [HM95]", "[CAACD]"};

struct Walker {
  Point2 begin;
  double vx = 0, vz = 0;
  std::array<Point2, kHorizon> real = {};
  bool is_complete = false;  // Recorded for the whole time.
};

// The scene by sample: positions by person.
struct Recording {
  std::vector<std::map<int64_t, Point2>> samples;
  Point2 low{1e9, 1e9}, high{-1e9, -1e9};
};

Recording recording_of(const Tracks& tracks) {
  int64_t first = std::numeric_limits<int64_t>::max(), gap = first;
  for (const Track& track : tracks.people) {
    first = std::min(first, track.points.front().frame);
    for (size_t i = 1; i < track.points.size(); ++i) {
      gap = std::min(gap, track.points[i].frame - track.points[i - 1].frame);
    }
  }
  Recording recording;
  for (const Track& track : tracks.people) {
    for (const TrackPoint& p : track.points) {
      const auto k = static_cast<size_t>((p.frame - first) / gap);
      if (recording.samples.size() <= k) recording.samples.resize(k + 1);
      recording.samples[k][track.person] = {p.x, p.z};
      recording.low = {std::min(recording.low.x, p.x), std::min(recording.low.z, p.z)};
      recording.high = {std::max(recording.high.x, p.x), std::max(recording.high.z, p.z)};
    }
  }
  return recording;
}

std::vector<Walker> walkers_at(const Recording& recording, size_t k) {
  std::vector<Walker> walkers;
  for (const auto& [person, now] : recording.samples[k]) {
    const auto before = recording.samples[k - 1].find(person);
    if (before == recording.samples[k - 1].end()) continue;
    Walker w;
    w.begin = now;
    w.vx = (now.x - before->second.x) / kSample;
    w.vz = (now.z - before->second.z) / kSample;
    w.is_complete = true;
    for (size_t i = 0; i < kHorizon; ++i) {
      const auto then = recording.samples[k + 1 + i].find(person);
      if (then == recording.samples[k + 1 + i].end()) {
        w.is_complete = false;
        break;
      }
      w.real[i] = then->second;
    }
    walkers.push_back(w);
  }
  return walkers;
}

using Positions = std::vector<std::array<Point2, kHorizon>>;  // by walker

Positions predict_constant(const std::vector<Walker>& walkers) {
  Positions positions(walkers.size());
  for (size_t n = 0; n < walkers.size(); ++n) {
    for (size_t i = 0; i < kHorizon; ++i) {
      const double t = kSample * static_cast<double>(i + 1);
      positions[n][i] = {walkers[n].begin.x + walkers[n].vx * t,
                         walkers[n].begin.z + walkers[n].vz * t};
    }
  }
  return positions;
}

Positions predict_by_forces(const std::vector<Walker>& walkers) {
  std::vector<steer::ForceWalker> moved;
  for (const Walker& w : walkers) moved.push_back({w.begin.x, w.begin.z, w.vx, w.vz, w.vx, w.vz});
  Positions positions(walkers.size());
  for (size_t i = 0; i < kHorizon; ++i) {
    for (int step = 0; step < kStepsASample; ++step)
      steer::step_social_force(moved, PlaneCrowd::kStep, {});
    for (size_t n = 0; n < walkers.size(); ++n) positions[n][i] = {moved[n].x, moved[n].z};
  }
  return positions;
}

// [CAACD] as printed, in its own units: a repulsive field as large as our body, and its frames so
// long that its greatest speed is an adult's. All targets lie far ahead, so that no body brakes.
constexpr double kUnit = 0.19 / 5;                       // [m]
constexpr double kFramesASecond = 1.34 / (0.4 * kUnit);  // of 0.4 units each
constexpr int kFramesASample = 36;

Positions predict_by_curves(const std::vector<Walker>& walkers) {
  const double per_frame = 1 / (kUnit * kFramesASecond);
  const double dt = kSample * kFramesASecond / kFramesASample;  // [frames]
  std::vector<caacd::Body> bodies;
  std::vector<caacd::Model> models(walkers.size());
  std::vector<Vec3d> targets;
  for (size_t n = 0; n < walkers.size(); ++n) {
    const Walker& w = walkers[n];
    const double speed = std::hypot(w.vx, w.vz);
    const bool stands = speed < kStanding;
    caacd::Body body;
    body.position = Vec3d{w.begin.x, 0, w.begin.z} * (1 / kUnit);
    if (!stands) body.velocity = Vec3d{w.vx, 0, w.vz} * per_frame;
    body.forward = caacd::heading_of(body.velocity, {1, 0, 0});
    body.fields = {5, 7.5, 12};
    body.id = static_cast<uint32_t>(n);
    models[n].max_speed = std::max(kStanding, speed) * per_frame;
    targets.push_back(body.position + body.velocity * (stands ? 0 : 100 * kFramesASecond));
    bodies.push_back(body);
  }
  Positions positions(walkers.size());
  std::vector<Vec3d> steer(walkers.size());
  for (size_t i = 0; i < kHorizon; ++i) {
    for (int frame = 0; frame < kFramesASample; ++frame) {
      for (size_t n = 0; n < bodies.size(); ++n) {
        const auto threat = caacd::greatest_threat(bodies[n], bodies, {}, models[n]);
        steer[n] = threat.state != caacd::State::kTolerable
                       ? caacd::avoidance(bodies[n], threat, models[n])
                       : caacd::path_amendment(bodies[n], targets[n], 0, models[n]);
      }
      for (size_t n = 0; n < bodies.size(); ++n) {
        caacd::Body& body = bodies[n];
        body.velocity = caacd::steered(body.velocity, steer[n], dt, models[n]);
        body.forward = caacd::heading_of(body.velocity, body.forward);
        body.position = body.position + body.velocity * dt;
      }
    }
    for (size_t n = 0; n < bodies.size(); ++n) {
      positions[n][i] = {bodies[n].position.x * kUnit, bodies[n].position.z * kUnit};
    }
  }
  return positions;
}

// Simulates our crowd; an avatar that does not fit is marked as not complete.
Result<Positions> walk_crowd(PlaneCrowd& crowd, std::vector<Walker>& walkers, Context& context) {
  std::vector<Point2> starts;
  std::vector<double> speeds;
  for (const Walker& w : walkers) {
    starts.push_back(w.begin);
    speeds.push_back(std::max(kStanding, std::hypot(w.vx, w.vz)));
  }
  const auto ids = crowd.add(starts, speeds, context);
  if (!ids) return ids.error();
  std::vector<AvatarId> walking;
  std::vector<Vec3d> velocities;
  std::map<uint32_t, size_t> walker_of;  // by slot
  for (size_t n = 0; n < walkers.size(); ++n) {
    if (!(*ids)[n]) {
      walkers[n].is_complete = false;
      continue;
    }
    walker_of[(*ids)[n].slot1] = n;
    walking.push_back((*ids)[n]);
    const bool stands = std::hypot(walkers[n].vx, walkers[n].vz) < kStanding;
    velocities.push_back(stands ? Vec3d{} : Vec3d{walkers[n].vx, 0, walkers[n].vz});
  }
  crowd.set_velocities(walking, velocities);
  Positions positions(walkers.size());
  for (size_t i = 0; i < kHorizon; ++i) {
    for (int step = 0; step < kStepsASample; ++step) crowd.step();
    for (const AvatarMotion& s : crowd.avatars()) positions[walker_of[s.id.slot1]][i] = {s.x, s.z};
  }
  crowd.remove(walking);
  return positions;
}

// Sums over all starts.
struct Score {
  double mean_error = 0, last_error = 0;
  std::vector<double> nearest;  // min distance to another scored person, of each [m]
};

double apart(const Point2& a, const Point2& b) { return std::hypot(a.x - b.x, a.z - b.z); }

void add(Score& score, const std::vector<Walker>& walkers, const Positions& positions) {
  for (size_t n = 0; n < walkers.size(); ++n) {
    if (!walkers[n].is_complete) continue;
    double sum = 0, nearest = std::numeric_limits<double>::infinity();
    for (size_t i = 0; i < kHorizon; ++i) {
      sum += apart(positions[n][i], walkers[n].real[i]);
      for (size_t m = 0; m < walkers.size(); ++m) {
        if (m == n || !walkers[m].is_complete) continue;
        nearest = std::min(nearest, apart(positions[n][i], positions[m][i]));
      }
    }
    score.mean_error += sum / static_cast<double>(kHorizon);
    score.last_error += apart(positions[n].back(), walkers[n].real.back());
    if (nearest < std::numeric_limits<double>::infinity()) score.nearest.push_back(nearest);
  }
}

double quantile(std::vector<double> sorted, double part) {
  if (sorted.empty()) return std::nan("");
  return sorted[static_cast<size_t>(part * static_cast<double>(sorted.size() - 1) + 0.5)];
}

ValidationChart distances(const std::string& scene, const std::array<Score, kModels>& scores) {
  ValidationChart chart;
  chart.name = "walkers_" + scene;
  chart.chart.title = "Least distance to another within 4.8 s, " + scene;
  chart.chart.x_title = "distance, m";
  chart.chart.y_title = "share of people below, %";
  for (double x = 0; x <= 3.001; x += 0.1) chart.chart.x.push_back(x);
  for (size_t m = 0; m < kModels; ++m) {
    ChartLine line{.name = kNames[m],
                   .kind = m == kReal   ? LineKind::kDashed
                           : m == kOurs ? LineKind::kStrong
                                        : LineKind::kPlain};
    for (const double x : chart.chart.x) {
      const auto below = std::ranges::count_if(scores[m].nearest, [&](double d) { return d < x; });
      line.values.push_back(100.0 * static_cast<double>(below) /
                            static_cast<double>(std::max<size_t>(1, scores[m].nearest.size())));
    }
    chart.chart.lines.push_back(std::move(line));
  }
  return chart;
}

Result<void> walk_scene(const std::string& scene, const std::string& path,
                        const ValidationConfig& config, ValidationResult& result,
                        Context& context) {
  const auto tracks = load_obsmat(path);
  if (!tracks) return tracks.error();
  const Recording recording = recording_of(*tracks);
  // No avatar gets farther than this from the recorded positions within 4.8 s.
  constexpr double kMargin = 20;
  const Point2& low = recording.low;
  const Point2& high = recording.high;
  if (high.x - low.x > 300 || high.z - low.z > 300) {
    return Error{Errc::kBadFile, path +
                                     ": its people are more than 300 m apart; metres are "
                                     "expected"};
  }
  PlaneConfig plane;
  plane.ground = box(low.x - kMargin, low.z - kMargin, high.x + kMargin, high.z + kMargin);
  auto crowd = PlaneCrowd::create(plane, {}, Routing::kStraight, config, context);
  if (!crowd) return crowd.error();
  std::array<Score, kModels> scores;
  size_t count = 0, not_placed = 0;
  const size_t every = config.brief ? 10 * kHorizon : kHorizon;
  for (size_t k = 1; k + kHorizon < recording.samples.size(); k += every) {
    std::vector<Walker> walkers = walkers_at(recording, k);
    const auto complete = [&] {
      return static_cast<size_t>(std::ranges::count_if(walkers, &Walker::is_complete));
    };
    const size_t recorded = complete();
    if (recorded == 0) continue;
    const auto ours = walk_crowd(*crowd, walkers, context);
    if (!ours) return ours.error();
    if (context.cancel) return Error{Errc::kCancelled, "cancelled"};
    count += complete();
    not_placed += recorded - complete();
    Positions real;
    for (const Walker& w : walkers) real.push_back(w.real);
    add(scores[kReal], walkers, real);
    add(scores[kOurs], walkers, *ours);
    add(scores[kConstant], walkers, predict_constant(walkers));
    add(scores[kForce], walkers, predict_by_forces(walkers));
    add(scores[kCurves], walkers, predict_by_curves(walkers));
  }
  crowd->report(result);
  if (count == 0) {
    return Error{Errc::kBadFile,
                 path + ": no person is recorded for 5.2 s on end; it is too short"};
  }
  const auto people = static_cast<double>(count);
  const auto add_measure = [&](const std::string& what, double value, const std::string& unit) {
    result.measures.push_back({.name = scene + ": " + what, .value = value, .unit = unit});
  };
  add_measure("people predicted", people, "");
  add_measure("left out, nearer to another than two bodies", static_cast<double>(not_placed), "");
  for (size_t m = kOurs; m < kModels; ++m) {
    add_measure(std::string("mean error, ") + kNames[m], scores[m].mean_error / people, "m");
    add_measure(std::string("error after 4.8 s, ") + kNames[m], scores[m].last_error / people, "m");
  }
  for (size_t m = 0; m < kModels; ++m) {
    std::ranges::sort(scores[m].nearest);
    const auto below = std::ranges::count_if(
        scores[m].nearest, [](double d) { return d < 2 * AvatarClass{}.radius - 1e-6; });
    add_measure(std::string("min distance, 5 % of people, ") + kNames[m],
                quantile(scores[m].nearest, 0.05), "m");
    add_measure(std::string("min distance, half of people, ") + kNames[m],
                quantile(scores[m].nearest, 0.5), "m");
    add_measure(std::string("bodies overlap, ") + kNames[m],
                100 * static_cast<double>(below) /
                    static_cast<double>(std::max<size_t>(1, scores[m].nearest.size())),
                "% of people");
  }
  result.charts.push_back(distances(scene, scores));
  return {};
}

}  // namespace

Result<ValidationResult> walkers(const std::string& folder, const ValidationConfig& config,
                                 Context& context) {
  namespace fs = std::filesystem;
  std::error_code failed;
  std::vector<std::pair<std::string, std::string>> scenes;
  const fs::path root(folder);
  if (fs::is_regular_file(root / "obsmat.txt", failed)) {
    scenes.emplace_back(fs::weakly_canonical(root, failed).filename().string(),
                        (root / "obsmat.txt").string());
  }
  for (fs::directory_iterator it(root, failed), end; !failed && it != end; it.increment(failed)) {
    const fs::path file = it->path() / "obsmat.txt";
    std::error_code none;
    if (!fs::is_regular_file(file, none)) continue;
    scenes.emplace_back(it->path().filename().string(), file.string());
  }
  std::sort(scenes.begin(), scenes.end());
  if (scenes.empty()) {
    return Error{Errc::kNotFound, folder + ": neither it nor a folder in it holds an obsmat.txt"};
  }
  ValidationResult result;
  for (const auto& [scene, path] : scenes) {
    if (auto ok = walk_scene(scene, path, config, result, context); !ok) return ok.error();
  }
  return result;
}

}  // namespace throng::validate
