// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <algorithm>

#include "scenario/simulation_state.h"

// Where people walk faster or slower: on stairs, through sand.
namespace throng {

// The first area with a pace in which somebody stands sets his.
void Simulation::State::mind_paces() {
  const auto has_pace = [](const ScenarioArea& area) { return area.pace != 1; };
  if (std::ranges::none_of(scenario.areas, has_pace)) return;
  for (Person& p : persons) {
    if (!p.id) continue;
    const Vec3d at = crowd.read(p.id)->position;
    double pace = 1;
    for (const ScenarioArea& area : scenario.areas) {
      const auto is_here = [&](const Prism& prism) { return prism.holds(at); };
      if (!has_pace(area) || std::ranges::none_of(area.prisms, is_here)) continue;
      pace = area.pace;
      break;
    }
    if (pace == p.pace) continue;
    p.pace = pace;
    const double speed = p.speed * pace;
    crowd.set_speeds({&p.id, 1}, {&speed, 1});
  }
}

}  // namespace throng
