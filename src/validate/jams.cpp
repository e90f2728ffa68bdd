// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <array>
#include <span>
#include <vector>

#include "throng/bake.h"
#include "throng/crowd.h"
#include "throng/scene.h"
#include "validate/plane_crowd.h"
#include "validate/tests.h"

// A building in which all go from one random place to the next: how fast they get on once jams have
// formed, and how often they change their routes.
namespace throng::validate {
namespace {

constexpr uint32_t kPeople = 1000, kBriefPeople = 100;
constexpr double kTime = 300, kBriefTime = 20;  // [s]
constexpr double kLastPart = 60;                // [s] over which the speed is measured
constexpr double kMinSpeed = 0.85;              // of the desired speed
constexpr double kDt = 0.1;                     // [s]

// Gives those that need one a random goal each.
void give_goals(Crowd& crowd, const World& world, std::span<const AvatarId> ids, uint64_t seed,
                uint64_t& drawn) {
  for (const AvatarId id : ids) {
    const Place goal = world.random_place(0, seed, drawn++);
    crowd.set_goals({&id, 1}, {&goal, 1});
  }
}

Result<ValidationResult> garage(const ValidationConfig& config, Context& context) {
  const auto scene = create_builtin_world({.name = "garage"});
  if (!scene) return scene.error();
  const auto world =
      bake_world(*scene, {.classes = {AvatarClass{}}, .workers = config.workers}, context);
  if (!world) return world.error();
  auto crowd = Crowd::create(*world, {.dt = kDt,
                                      .seed = config.seed,
                                      .workers = config.workers,
                                      .model = config.model,
                                      .tuning = tuning_of(config)});
  if (!crowd) return crowd.error();
  const uint32_t people = config.brief ? kBriefPeople : kPeople;
  const auto ids = crowd->scatter(people, {}, context);
  if (!ids) return ids.error();
  uint64_t drawn = 0;
  give_goals(*crowd, *world, *ids, config.seed, drawn);
  const double time = config.brief ? kBriefTime : kTime;
  const double last = config.brief ? kBriefTime : kLastPart;
  ValidationResult result;
  double speed = 0, first_speed = 0, changed = 0, searches = 0, arrived = 0;
  uint64_t steps = 0, measured = 0;
  std::vector<AvatarId> without;
  for (; static_cast<double>(steps) * kDt < time - 1e-9; ++steps) {
    const CrowdReport report = crowd->step();
    if (context.cancel) return Error{Errc::kCancelled, "cancelled"};
    changed += static_cast<double>(report.changed_route);
    searches += static_cast<double>(report.jam_searches);
    arrived += static_cast<double>(report.arrived);
    if (static_cast<double>(steps) * kDt < last) first_speed += report.progress;
    if (static_cast<double>(steps) * kDt >= time - last - 1e-9) {
      speed += report.progress;
      ++measured;
    }
    without.assign(crowd->arrived().begin(), crowd->arrived().end());
    without.insert(without.end(), crowd->goal_unreachable().begin(),
                   crowd->goal_unreachable().end());
    give_goals(*crowd, *world, without, config.seed, drawn);
    if (steps % 10 != 0) continue;
    const CrowdCheck faults = crowd->check();
    result.faults.overlaps += faults.overlaps;
    result.faults.wall_entries += faults.wall_entries;
    ++result.checks;
  }
  result.simulated += static_cast<double>(steps) * kDt;
  const double avatar_minutes = static_cast<double>(people) * time / 60;
  result.measures = {
      {.name = "speed towards the next corner, of the desired speed, at the end",
       .value = speed / static_cast<double>(measured),
       .low = kMinSpeed},
      {.name = "the same, at the beginning", .value = first_speed / (last / kDt)},
      {.name = "goals reached", .value = arrived},
      {.name = "routes changed, of an avatar", .value = changed / avatar_minutes, .unit = "/min"},
      {.name = "searches for other routes, of an avatar",
       .value = searches / avatar_minutes,
       .unit = "/min"},
  };
  return result;
}

const std::array<Test, 1> kJamTests{Test{
    {.name = "motion.jams",
     .title = "1000 people in a garage, from one random place to the next",
     .method = "The built-in garage at cells of 0.1 m, the default adult, steps of 0.1 s. Each "
               "gets another random goal where it has arrived. After 300 s: mean speed towards "
               "the next corner by the desired speed over the last 60 s, and how often an "
               "avatar took another route because it did not get on.",
     .source = "ours: 0.85 of the desired speed",
     .in_work = true},
    garage}};

}  // namespace

std::span<const Test> jam_tests() { return kJamTests; }

}  // namespace throng::validate
