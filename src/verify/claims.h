// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>

#include "throng/avatar.h"
#include "throng/base.h"
#include "throng/scene.h"
#include "throng/verify.h"
#include "throng/world.h"

/// What a world claims about one avatar class, and the judge. The functions have the meaning of
/// World's; tests feed hand-made worlds, honest and broken ones.
namespace throng::verify {

struct Claims {
  AvatarClass avatar;
  double cell = 0.1;        ///< Sideways growth of the body whose floors must not be lost. [m]
  double resolution = 0.1;  ///< Upward growth of that body. [m]
  std::function<Place(uint64_t seed, uint64_t n)> random_place;
  std::function<Place(Vec3d position, double reach)> find_place;
  std::function<MoveResult(const Place& from, double dx, double dz)> move;
  std::function<double(const Place& place)> feet;
};

/// Can this source be tested with these settings? Fails with kBadConfig, kBadInput or kLimit.
[[nodiscard]] Result<void> check_source(const Scene& scene, const VerifyConfig& config);

/// Tests the claims against the triangles. `config.avatar_class` is not used: the claims are about
/// one class. Fails with kBadConfig, kBadInput (no triangles, bad indices), kCancelled.
[[nodiscard]] Result<VerifyReport> verify_proposals(const Claims& claims, const Scene& source,
                                                    const VerifyConfig& config, Context& context);

}  // namespace throng::verify
