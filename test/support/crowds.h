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

}  // namespace throng
