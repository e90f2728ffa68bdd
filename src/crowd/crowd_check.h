// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>

#include "throng/avatar.h"
#include "throng/base.h"
#include "throng/world.h"

/// A check of a crowd that shares nothing with the step: exact distances, the world's own queries.
namespace throng::crowd {

struct CheckedBody {
  int32_t x = 0, z = 0;  // [units]
  int32_t y = 0;         // feet [mm]
  uint32_t level = 0;
  int32_t avatar_class = 0;
  double radius = 0, height = 0;  // [m]
  bool flies = false;             // it is in the air, or between the ground and the air
  bool climbs = false;            // over nodes: other code checks whether it may be there
  bool on_link = false;           // on an off-mesh link: likewise
};

/// `obstacles`: what no body may be in, a body with the radius of its class, from its step height
/// up.
CrowdCheck check_bodies(const World& world, std::span<const CheckedBody> bodies,
                        std::span<const Prism> obstacles, int32_t workers);

}  // namespace throng::crowd
