// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
// Do all avatars arrive, and without overlaps? One scene; prints a JSON object.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "scenes.h"
#include "throng/bake.h"
#include "throng/crowd.h"
#include "throng/scene.h"

namespace {

using namespace throng;
using namespace throng::bench;
using Json = nlohmann::ordered_json;

struct Options {
  std::string scene;
  uint32_t bodies = 1000;
  double area = 4;
  double near = 60;
  double seconds = 1000, dt = 0.1, cell = 0.1;
  uint64_t seed = 1, check_every = 1;
  int32_t threads = 0;
};

Json fail(const Error& error) { return {{"error", error.message}}; }

// Counts over all steps.
struct Tally {
  uint64_t steps = 0, avatar_steps = 0, checked = 0;
  CrowdCheck faults;
  double seconds = 0;

  void step(Crowd& crowd, const Options& o) {
    seconds += crowd.step().seconds_total;
    avatar_steps += crowd.size();
    if (++steps % o.check_every != 0) return;
    const CrowdCheck found = crowd.check();
    checked += crowd.size();
    faults.overlaps += found.overlaps;
    faults.wall_entries += found.wall_entries;
  }
  [[nodiscard]] Json json() const {
    return {{"steps", steps},
            {"avatar_steps", avatar_steps},
            {"checked_avatar_steps", checked},
            {"overlaps", faults.overlaps},
            {"wall_entries", faults.wall_entries},
            {"ns", avatar_steps > 0 ? 1e9 * seconds / static_cast<double>(avatar_steps) : 0}};
  }
};

Result<World> bake(const Scene& scene, const AvatarClass& avatar, double cell) {
  Context context;
  return bake_world(scene, {.cell = cell, .resolution = 0.1, .classes = {avatar}}, context);
}

// Each avatar walks to its goal, once.
Json run_play(const Play& play, const Options& o) {
  Context context;
  const auto world = bake(play.scene, play.avatar, o.cell);
  if (!world) return fail(world.error());
  auto crowd = Crowd::create(*world, {.dt = o.dt, .seed = o.seed, .workers = o.threads});
  if (!crowd) return fail(crowd.error());
  std::vector<AvatarSpawn> spawns;
  std::vector<Place> goals;
  double longest = 0;
  for (const Walker& w : play.walkers) {
    spawns.push_back({.place = world->find_place(0, w.from, 1), .speed = w.speed});
    goals.push_back(world->find_place(0, w.to, 1));
    if (!goals.back()) return fail({Errc::kNotFound, play.name + ": a goal is in a wall"});
    longest = std::max(longest, std::hypot(w.to.x - w.from.x, w.to.z - w.from.z) / w.speed);
  }
  const auto ids = crowd->add(spawns, context);
  if (!ids) return fail(ids.error());
  const auto placed = std::count_if(ids->begin(), ids->end(), [](AvatarId id) { return bool(id); });
  if (placed < static_cast<std::ptrdiff_t>(ids->size())) {
    return fail({Errc::kLimit, play.name + ": not all avatars fit at their starts"});
  }
  crowd->set_goals(*ids, goals);
  Tally tally;
  uint64_t arrived = 0;
  std::vector<double> times;
  const auto time = [&] { return static_cast<double>(tally.steps) * o.dt; };
  while (arrived < ids->size() && time() < o.seconds - 1e-9) {
    tally.step(*crowd, o);
    arrived += crowd->arrived().size();
    times.resize(arrived, time());
  }
  Json json = {{"scene", play.name},
               {"bodies", ids->size()},
               {"seed", o.seed},
               {"arrived", arrived},
               {"seconds", time()},
               {"half", times.size() * 2 >= ids->size() ? times[ids->size() / 2 - 1] : -1.0},
               {"alone", longest}};
  json.update(tally.json());
  return json;
}

// Scattered over a built-in world; each gets one nearby goal after the other.
Json run_world(const Options& o) {
  const auto scene = create_builtin_world({.name = o.scene, .seed = o.seed});
  if (!scene) return fail(scene.error());
  Context context;
  const auto world = bake(*scene, {}, o.cell);
  if (!world) return fail(world.error());
  auto crowd = Crowd::create(*world, {.dt = o.dt, .seed = o.seed, .workers = o.threads});
  if (!crowd) return fail(crowd.error());
  const auto ids = crowd->scatter(o.bodies, {}, context);
  if (!ids) return fail(ids.error());
  std::vector<AvatarState> states;
  std::vector<Place> goals;
  std::vector<AvatarId> bound;
  uint64_t drawn = 0, arrived = 0;
  const auto give = [&](std::span<const AvatarId> to) {
    constexpr int kDraws = 8;
    if (to.empty()) return;
    crowd->read(states);
    goals.clear();
    for (const AvatarId id : to) {
      const Vec3d& at = states[id.slot1 - 1].position;
      Place goal;
      double far = INFINITY;
      for (int n = 0; n < kDraws && far > o.near; ++n) {  // Or the nearest of these.
        const Place place = world->random_place(0, o.seed, ++drawn);
        const double here = std::hypot(place.position.x - at.x, place.position.z - at.z);
        if (here < far) goal = place;
        far = std::min(far, here);
      }
      goals.push_back(goal);
    }
    crowd->set_goals(to, goals);
  };
  give(*ids);
  Tally tally;
  while (static_cast<double>(tally.steps) * o.dt < o.seconds - 1e-9) {
    tally.step(*crowd, o);
    arrived += crowd->arrived().size();
    bound.assign(crowd->arrived().begin(), crowd->arrived().end());
    bound.insert(bound.end(), crowd->goal_unreachable().begin(), crowd->goal_unreachable().end());
    give(bound);
  }
  Json json = {{"scene", o.scene},
               {"bodies", o.bodies},
               {"seed", o.seed},
               {"arrived", arrived},
               {"seconds", static_cast<double>(tally.steps) * o.dt}};
  json.update(tally.json());
  return json;
}

Json run(const Options& o) {
  if (o.scene == "corridor") return run_play(corridor(o.bodies / 2, o.area, o.seed), o);
  if (o.scene == "crossing") return run_play(crossing(o.bodies / 4, o.area, o.seed), o);
  if (!o.scene.ends_with(".xml")) return run_world(o);
  const auto play = test::load_steer_bench(o.scene, o.seed);
  return play ? run_play(*play, o) : fail(play.error());
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App parser{"Do all avatars arrive, and without overlaps?"};
  Options options;
  parser.add_option("scene", options.scene, "corridor, crossing, a SteerBench file, or a world")
      ->required();
  parser.add_option("--bodies", options.bodies)->check(CLI::Range(4, 10000000));
  parser.add_option("--area", options.area, "Per avatar, in corridors [m2]")
      ->check(CLI::Range(0.5, 1000.0));
  parser.add_option("--near", options.near, "Goals in worlds [m]")->capture_default_str();
  parser.add_option("--seconds", options.seconds, "At most")->check(CLI::PositiveNumber);
  parser.add_option("--dt", options.dt)->check(CLI::PositiveNumber);
  parser.add_option("--cell", options.cell)->check(CLI::PositiveNumber);
  parser.add_option("--seed", options.seed);
  parser.add_option("--check-every", options.check_every, "Steps")->check(CLI::PositiveNumber);
  parser.add_option("--threads", options.threads)->check(CLI::Range(0, 1024));
  CLI11_PARSE(parser, argc, argv);
  const Json result = run(options);
  std::puts(result.dump().c_str());
  return result.contains("error") ? 2 : 0;
}
