// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <gtest/gtest.h>

#include <span>
#include <utility>
#include <vector>

#include "throng/crowd.h"

/// Crowds for tests; a test fails if they cannot be made.
namespace throng {

inline Crowd made(const World& world, const CrowdConfig& config = {}) {
  auto crowd = Crowd::create(world, config);
  EXPECT_TRUE(crowd) << crowd.error().message;
  return std::move(*crowd);
}

inline std::vector<AvatarId> scattered(Crowd& crowd, uint32_t count, const AvatarSpawn& like = {}) {
  Context context;
  auto ids = crowd.scatter(count, like, context);
  EXPECT_TRUE(ids) << ids.error().message;
  return ids ? *ids : std::vector<AvatarId>();
}

inline AvatarId added(Crowd& crowd, const Place& place, const AvatarSpawn& like = {}) {
  Context context;
  AvatarSpawn spawn = like;
  spawn.place = place;
  auto ids = crowd.add(std::span(&spawn, 1), context);
  EXPECT_TRUE(ids) << ids.error().message;
  return ids ? ids->front() : AvatarId{};
}

/// Makes a crowd follow its edits now, and not at the beginning of its next step.
inline void follow(Crowd& crowd) {
  Context context;
  const auto none = crowd.add({}, context);
  EXPECT_TRUE(none) << none.error().message;
}

/// Adds an obstacle to a crowd's edits, and makes the crowd follow them.
inline EditId put_up(Crowd& crowd, Edits edits, const Prism& prism,
                     ObstacleKind kind = ObstacleKind::kStatic,
                     ObstaclePolicy policy = ObstaclePolicy::kRefuseEntry) {
  const auto id = edits.add_obstacle(prism, kind, policy);
  EXPECT_TRUE(id) << id.error().message;
  follow(crowd);
  return id ? *id : EditId{};
}

}  // namespace throng
