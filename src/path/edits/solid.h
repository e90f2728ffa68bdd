// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "throng/avatar.h"
#include "throng/base.h"

/// A solid that is placed in a world at run time, and whether a body touches it.
namespace throng::path {

/// Names a change of one finder; 0 names none.
using ChangeId = uint32_t;

struct Solid {
  Prism prism;  ///< Of triangles: the box around them, which may be flat.
  std::vector<std::array<Vec3d, 3>> triangles = {};
};

/// [check_prism] Fails with kBadInput.
[[nodiscard]] Result<Solid> make_solid(const Prism& prism);
/// Fails with kBadInput unless there are triangles, of these corners, on Earth.
[[nodiscard]] Result<Solid> make_solid(std::span<const Vec3d> corners,
                                       std::span<const std::array<uint32_t, 3>> triangles);
/// The solid of triangles on Earth.
[[nodiscard]] Solid solid_of(std::vector<std::array<Vec3d, 3>> triangles);
[[nodiscard]] bool is_on_earth(const Vec3d& point);
/// A prism that holds it: of triangles a box that is never flat.
[[nodiscard]] Prism prism_around(const Solid& solid);

/// Bodies whose feet are no farther than `spread` from `feet` and whose axes turn away from `axis`
/// by at most an angle; where `turns_far` is set, by any.
struct BodyRoom {
  Vec3d feet, axis;
  double spread = 0;            ///< [m]
  double cosine = 1, sine = 0;  ///< Of the angle.
  bool turns_far = false;
  double bottom = 0;  ///< Above the feet. [m]
  double top = 0;
  double radius = 0;
  double margin = 0.001;  ///< [m]
};

/// False: none of these bodies is nearer to the solid than the margin. May be true of bodies that
/// are not nearer.
[[nodiscard]] bool may_touch(const BodyRoom& room, const Solid& solid);

/// The maximum distance of points of such bodies from their feet. [m]
[[nodiscard]] double reach_of(const AvatarClass& avatar);

}  // namespace throng::path
