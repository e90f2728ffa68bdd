// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
// Measures a step of a crowd with goals: the random scene of the table, on a plane. Prints a JSON
// object.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/random.h"
#include "throng/bake.h"
#include "throng/crowd.h"
#include "throng/scene.h"
#include "time_steps.h"

namespace {

using namespace throng;
using Json = nlohmann::ordered_json;

struct Options {
  uint32_t avatars = 10000;
  double area = 4;  // Per avatar. [m2]
  double near = 50;
  bench::StepTiming timing;
  uint64_t seed = 1;
  int32_t threads = 0;
  double radius = 0.3, speed = 1.3;
  double view = -1;  // Radius of a view in the middle [m]; negative: none.
  double dt = 0.1;
  int32_t low_detail_steps = CrowdTuning().low_detail_steps;
  bool pushing = false;  // they do not queue
  double acceleration = CrowdTuning().acceleration;
  double low_detail_reaction = CrowdTuning().low_detail_reaction;
};

Json fail(const Error& error) { return {{"error", error.message}}; }

Json run(const Options& o) {
  constexpr double kRim = 2;  // [m] Without goals.
  const double side = std::sqrt(o.area * o.avatars) + 2 * kRim;
  Scene scene;
  scene.add_quad({0, 0, 0}, {0, 0, side}, {side, 0, side}, {side, 0, 0});
  Context context;
  BakeConfig bake;
  bake.cell = 0.5;
  bake.classes.resize(1);
  const auto world = bake_world(scene, bake, context);
  if (!world) return fail(world.error());
  auto crowd = Crowd::create(*world, {.dt = o.dt,
                                      .seed = o.seed,
                                      .workers = o.threads,
                                      .routing = Routing::kStraight,
                                      .tuning = {.low_detail_steps = o.low_detail_steps,
                                                 .low_detail_reaction = o.low_detail_reaction,
                                                 .queues = !o.pushing,
                                                 .acceleration = o.acceleration}});
  if (!crowd) return fail(crowd.error());
  if (o.view >= 0) {
    const CrowdView view{{side / 2, 0, side / 2}, o.view};
    crowd->set_views({&view, 1});
  }
  const auto ids = crowd->scatter(o.avatars, {.radius = o.radius, .speed = o.speed}, context);
  if (!ids) return fail(ids.error());
  std::vector<uint64_t> given(o.avatars, 0);
  std::vector<AvatarState> states;
  std::vector<Place> goals;
  const auto give = [&](std::span<const AvatarId> to) {
    if (to.empty()) return;
    crowd->read(states);
    goals.clear();
    for (const AvatarId id : to) {
      const uint32_t slot = id.slot1 - 1;
      const auto along = [&](double from, uint64_t stream) {
        const double low = std::max(kRim, from - o.near),
                     high = std::min(side - kRim, from + o.near);
        return low + (high - low) * random_unit(o.seed, 2 * uint64_t{slot} + stream, given[slot]);
      };
      const Vec3d& p = states[slot].position;
      goals.push_back(world->find_place(0, {along(p.x, 0), 0, along(p.z, 1)}, 1));
      ++given[slot];
    }
    crowd->set_goals(to, goals);
  };
  give(*ids);
  Json report = {{"avatars", o.avatars}, {"area", o.area}, {"threads", o.threads}};
  report.update(bench::time_steps(*crowd, o.timing, give));
  return report;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App parser{"Measures a step of a crowd with goals"};
  Options options;
  parser.add_option("--avatars", options.avatars)->check(CLI::Range(1, 10000000));
  parser.add_option("--area", options.area)->check(CLI::Range(0.3, 1000.0));
  parser.add_option("--near", options.near)->check(CLI::Range(1.0, 1e6));
  parser.add_option("--warm", options.timing.warm);
  parser.add_option("--steps", options.timing.steps)->check(CLI::PositiveNumber);
  parser.add_option("--seed", options.seed);
  parser.add_option("--threads", options.threads)->check(CLI::Range(0, 1024));
  parser.add_option("--radius", options.radius)->check(CLI::Range(0.05, 10.0));
  parser.add_option("--view", options.view, "One view in the middle of this radius [m]");
  parser.add_option("--dt", options.dt)->check(CLI::Range(0.001, 1.0));
  parser.add_flag("--pushing", options.pushing, "They push instead of queueing");
  parser.add_option("--acceleration", options.acceleration, "Limit, 0: none [m/s2]");
  parser.add_option("--far-steps", options.low_detail_steps)->check(CLI::Range(1, 16));
  parser.add_option("--far-reaction", options.low_detail_reaction)->check(CLI::Range(0.0, 10.0));
  parser.add_option("--check-every", options.timing.check_every, "Steps")
      ->check(CLI::PositiveNumber);
  CLI11_PARSE(parser, argc, argv);
  const Json result = run(options);
  std::puts(result.dump().c_str());
  return result.contains("error") ? 2 : 0;
}
