// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "validate/arrivals.h"

#include <fmt/format.h>

#include <cmath>

// An avatar that has arrived is removed after the step, so none that is there keeps others from
// their goals.
namespace throng::validate {

Result<Arrivals> walk_trips(const World& world, const Trips& trips, double limit,
                            const ValidationConfig& config, ValidationResult& result,
                            Context& context) {
  auto crowd = PlaneCrowd::create(world, Routing::kPaths, config);
  if (!crowd) return crowd.error();
  const auto ids = crowd->add(trips.starts, std::vector<double>(trips.starts.size(), 0), context);
  if (!ids) return ids.error();
  for (size_t n = 0; n < ids->size(); ++n) {
    if ((*ids)[n] && crowd->set_goal((*ids)[n], trips.goals[n])) continue;
    return Error{Errc::kBadConfig,
                 fmt::format("validate: no room for person {} of {}, from ({}, "
                             "{}) to ({}, {})",
                             n + 1, ids->size(), trips.starts[n].x, trips.starts[n].z,
                             trips.goals[n].x, trips.goals[n].z)};
  }
  Arrivals run;
  while (crowd->size() > 0 && crowd->time() < limit) {
    crowd->step();
    if (context.cancel) return Error{Errc::kCancelled, "cancelled"};
    const std::vector<AvatarId> leaving(crowd->arrived().begin(), crowd->arrived().end());
    if (leaving.empty()) continue;
    run.arrived += leaving.size();
    run.last = crowd->time();
    crowd->remove(leaving);
  }
  crowd->report(result);
  return run;
}

void add_arrivals(const Arrivals& run, size_t people, const std::string& at,
                  ValidationResult& result) {
  const bool all_there = run.arrived == people;
  result.measures.push_back({.name = "arrived, " + at,
                             .value = static_cast<double>(run.arrived),
                             .unit = "of " + std::to_string(people),
                             .low = static_cast<double>(people)});
  result.measures.push_back({.name = "time until all arrived, " + at,
                             .value = all_there ? run.last : std::nan(""),
                             .unit = "s"});
}

ValidationConfig config_of_run(const ValidationConfig& config, uint64_t runs, uint64_t k) {
  ValidationConfig one = config;
  one.seed = (config.seed - 1) * runs + 1 + k;
  return one;
}

PlaneConfig two_rooms_plane(const TwoRooms& rooms) {
  const double low = (rooms.side - rooms.width) / 2, high = (rooms.side + rooms.width) / 2;
  const double end = rooms.side + rooms.length, all = rooms.all(), side = rooms.side;
  PlaneConfig plane;
  plane.ground = {.outer = {{0, 0},
                            {side, 0},
                            {side, low},
                            {end, low},
                            {end, 0},
                            {all, 0},
                            {all, side},
                            {end, side},
                            {end, high},
                            {side, high},
                            {side, side},
                            {0, side}},
                  .holes = {}};
  return plane;
}

}  // namespace throng::validate
