// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "throng/verify.h"

#include <string>

#include "verify/claims.h"

// The World's side of the oracle: nothing but its public look-ups.
namespace throng {

Result<VerifyReport> verify_world(const World& world, const Scene& source,
                                  const VerifyConfig& config, Context& context) {
  const WorldSummary summary = world.summary();
  if (config.avatar_class < 0 ||
      static_cast<size_t>(config.avatar_class) >= summary.classes.size()) {
    return Error{Errc::kBadConfig, "verify: the world has no avatar class " +
                                       std::to_string(config.avatar_class) + "; it has " +
                                       std::to_string(summary.classes.size())};
  }
  const int32_t c = config.avatar_class;
  const verify::Claims claims{
      .avatar = summary.classes[static_cast<size_t>(c)],
      .cell = summary.cell,
      .resolution = summary.resolution,
      .random_place = [&](uint64_t seed, uint64_t n) { return world.random_place(c, seed, n); },
      .find_place = [&](Vec3d position,
                        double reach) { return world.find_place(c, position, reach); },
      .move = [&](const Place& from, double dx, double dz) { return world.move(c, from, dx, dz); },
      .feet = [&](const Place& place) { return world.feet(place); }};
  return verify::verify_claims(claims, source, config, context);
}

}  // namespace throng
