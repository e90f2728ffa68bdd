// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <algorithm>

#include "scenario/simulation_state.h"

// Areas in which avatars walk faster or slower, as on sand; stairs and slopes slow them besides.
// Time: avatars x prisms of areas with a factor.
namespace throng {

// The first area with a factor in which an avatar stands sets its own.
void Simulation::State::apply_speed_factors() {
  const auto has_factor = [](const ScenarioArea& area) { return area.speed_factor != 1; };
  if (std::ranges::none_of(scenario.areas, has_factor)) return;
  for (ScenarioAvatar& p : avatars) {
    if (!p.id) continue;
    const Vec3d at = crowd.read(p.id)->position;
    double factor = 1;
    for (const ScenarioArea& area : scenario.areas) {
      const auto is_here = [&](const Prism& prism) { return prism.contains(at); };
      if (!has_factor(area) || std::ranges::none_of(area.prisms, is_here)) continue;
      factor = area.speed_factor;
      break;
    }
    if (factor == p.speed_factor) continue;
    p.speed_factor = factor;
    const double speed = p.speed * factor;
    crowd.set_speeds({&p.id, 1}, {&speed, 1});
  }
}

}  // namespace throng
