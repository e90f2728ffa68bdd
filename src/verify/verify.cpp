// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "throng/verify.h"

#include <string>

#include "verify/claims.h"
#include "verify/world_claims.h"

// The World's side of the oracle: nothing but its public look-ups.
namespace throng {

Result<verify::Claims> verify::claims_of(const World& world, int32_t avatar_class) {
  const WorldSummary summary = world.summary();
  if (avatar_class < 0 || static_cast<size_t>(avatar_class) >= summary.classes.size()) {
    return Error{Errc::kBadConfig, "verify: the world has no avatar class " +
                                       std::to_string(avatar_class) + "; it has " +
                                       std::to_string(summary.classes.size())};
  }
  const int32_t c = avatar_class;
  return Claims{
      .avatar = summary.classes[static_cast<size_t>(c)],
      .cell = summary.cell,
      .resolution = summary.resolution,
      .random_place = [&world, c](uint64_t seed,
                                  uint64_t n) { return world.random_place(c, seed, n); },
      .find_place = [&world, c](Vec3d position,
                                double reach) { return world.find_place(c, position, reach); },
      .move = [&world, c](const Place& from, double dx,
                          double dz) { return world.move(c, from, dx, dz); },
      .feet = [&world](const Place& place) { return world.feet(place); }};
}

Result<VerifyReport> verify_world(const World& world, const Scene& source,
                                  const VerifyConfig& config, Context& context) {
  const auto claims = verify::claims_of(world, config.avatar_class);
  if (!claims) return claims.error();
  return verify::verify_proposals(*claims, source, config, context);
}

}  // namespace throng
