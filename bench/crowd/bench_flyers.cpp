// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
// Measures a step of flyers: random goals in open air, or avatars that cross a sphere. Prints a
// JSON object.
#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "core/random.h"
#include "throng/bake.h"
#include "throng/crowd.h"
#include "throng/path.h"
#include "throng/scene.h"
#include "time_steps.h"

namespace {

using namespace throng;
using Json = nlohmann::ordered_json;

struct Options {
  std::string scene = "random";
  uint32_t avatars = 10000;
  double volume = 64;  // Per avatar. [m3]
  double near = 50;
  bench::StepTiming timing{.warm = 30, .steps = 30, .check_every = 30};
  uint64_t seed = 1;
  int32_t threads = 0;
};

constexpr double kHigh = 40;  // [m] Height of the air.

Json fail(const Error& error) { return {{"error", error.message}}; }

Result<World> open_air(double side, double high, double cell) {
  Scene scene;
  scene.add_quad({0, 0, 0}, {0, 0, side}, {side, 0, side}, {side, 0, 0});
  scene.add_box({0, high, 0}, {1, high + 0.5, 1});  // The air ends at its top.
  Context context;
  return bake_world(scene, {.cell = cell, .classes = {flyer_class()}}, context);
}

Json run_random(const Options& o) {
  const double side = std::sqrt(o.volume * o.avatars / kHigh) + 4;
  const auto world = open_air(side, kHigh, 0.5);
  if (!world) return fail(world.error());
  auto crowd = Crowd::create(*world, {.seed = o.seed, .workers = o.threads});
  if (!crowd) return fail(crowd.error());
  Context context;
  const auto ids = crowd->scatter(o.avatars, {.place = air_place({})}, context);
  if (!ids) return fail(ids.error());
  std::vector<uint64_t> given(o.avatars, 0);
  std::vector<Place> goals;
  const auto give = [&](std::span<const AvatarId> to) {
    goals.clear();
    for (const AvatarId id : to) {
      const uint32_t slot = id.slot1 - 1;
      const Vec3d from = crowd->read(id)->position;
      Place goal = air_place(from);
      for (int tries = 0; tries < 64; ++tries) {
        const auto along = [&](uint64_t stream) {
          return o.near * (2 * random_unit(o.seed, 3 * uint64_t{slot} + stream, given[slot]) - 1);
        };
        const Vec3d at{from.x + along(0), from.y + along(1), from.z + along(2)};
        ++given[slot];
        if (!crowd->may_fly(0, at)) continue;
        goal = air_place(at);
        break;
      }
      goals.push_back(goal);
    }
    crowd->set_goals(to, goals);
  };
  give(*ids);
  Json report = {{"avatars", o.avatars}, {"volume", o.volume}, {"threads", o.threads}};
  report.update(bench::time_steps(*crowd, o.timing, give));
  return report;
}

// Each starts on a sphere of radius 25 m, evenly distributed, and flies to the opposite point.
Json run_sphere(const Options& o) {
  const auto world = open_air(80, 60, 0.2);
  if (!world) return fail(world.error());
  auto crowd = Crowd::create(*world, {.seed = o.seed, .workers = o.threads});
  if (!crowd) return fail(crowd.error());
  std::vector<AvatarSpawn> spawns;
  std::vector<Place> goals;
  const Vec3d middle{40, 30, 40};
  for (uint32_t i = 0; i < o.avatars; ++i) {
    const double y = 1 - (2.0 * i + 1) / o.avatars;
    const double r = std::sqrt(1 - y * y), turn = 2.399963 * i + static_cast<double>(o.seed);
    const Vec3d offset{25 * r * std::cos(turn), 25 * y, 25 * r * std::sin(turn)};
    spawns.push_back({.place = air_place(middle + offset)});
    goals.push_back(air_place(middle - offset));
  }
  Context context;
  const auto ids = crowd->add(spawns, context);
  if (!ids) return fail(ids.error());
  crowd->set_goals(*ids, goals);
  std::set<uint32_t> there;
  CrowdCheck found;
  uint64_t step = 0, begun = 0;
  for (const AvatarId id : *ids) begun += id ? 1 : 0;
  while (there.size() < begun && step < 3000) {
    crowd->step();
    ++step;
    for (const AvatarId id : crowd->arrived()) there.insert(id.slot1);
    const CrowdCheck check = crowd->check();
    found.overlaps += check.overlaps;
    found.wall_entries += check.wall_entries;
  }
  return {{"avatars", begun},
          {"arrived", there.size()},
          {"seconds", static_cast<double>(step) * 0.1},
          {"checked_avatar_steps", step * begun},
          {"overlaps", found.overlaps},
          {"wall_entries", found.wall_entries}};
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App parser{"Measures a step of flyers"};
  Options options;
  parser.add_option("--scene", options.scene)->check(CLI::IsMember({"random", "sphere"}));
  parser.add_option("--avatars", options.avatars)->check(CLI::Range(1, 1000000));
  parser.add_option("--volume", options.volume, "Per avatar [m3]")->check(CLI::Range(2.0, 1e4));
  parser.add_option("--near", options.near)->check(CLI::Range(1.0, 1e6));
  parser.add_option("--warm", options.timing.warm);
  parser.add_option("--steps", options.timing.steps)->check(CLI::PositiveNumber);
  parser.add_option("--seed", options.seed);
  parser.add_option("--threads", options.threads)->check(CLI::Range(0, 1024));
  parser.add_option("--check-every", options.timing.check_every, "Steps")
      ->check(CLI::PositiveNumber);
  CLI11_PARSE(parser, argc, argv);
  const Json result = options.scene == "sphere" ? run_sphere(options) : run_random(options);
  std::puts(result.dump().c_str());
  return result.contains("error") ? 2 : 0;
}
