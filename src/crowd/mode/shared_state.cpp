// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "crowd/mode/shared_state.h"

#include "world/tile_grid.h"

// Which modes a class has, and goals that are dropped.
namespace throng::crowd {

SharedState::SharedState(const World& a_world, const CrowdConfig& a_config)
    : world(a_world),
      config(a_config),
      unit(data_of(a_world)->summary.cell / world::kUnitsPerCell),
      classes(kMaxAvatarClasses),
      obstacles(a_world, kMaxAvatarClasses),
      obstacle_grid(unit) {}

bool SharedState::flies(size_t number) const {
  return body_class(number).flies && data_of(world)->air != nullptr;
}

bool SharedState::climbs(size_t number) const {
  const AvatarClass& avatar = body_class(number);
  return config.nodes && !avatar.flies && goes_over_nodes(avatar);
}

void SharedState::drop_goal(Body& body) {
  body.flags &= Body::kMovedElsewhere;
  const std::lock_guard lock(goal_mutex);
  goal_unreachable.push_back(id_of(body.slot));
}

}  // namespace throng::crowd
