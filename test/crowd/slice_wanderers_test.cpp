// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "core/random.h"
#include "naive_columns.h"
#include "naive_slices.h"
#include "papers/slices/slice_sweep.h"
#include "throng/papers.h"
#include "throng/scene.h"

namespace throng {
namespace {

constexpr int32_t kSide = 150;  // [cells]
constexpr double kCell = 0.1;   // [m]
constexpr double kStep = 0.4;   // [m]

// Two storeys of uneven floor, a ramp between them, walls with gaps, holes.
naive::Columns building(uint64_t seed) {
  std::vector<std::vector<std::pair<int32_t, int32_t>>> cells;
  for (int32_t z = 0; z < kSide; ++z) {
    for (int32_t x = 0; x < kSide; ++x) {
      const auto below = [&](uint64_t i, uint64_t n) {
        const auto patch = static_cast<uint64_t>(z / 8 * 1000 + x / 8);
        return static_cast<int32_t>(random_below(seed, patch, i, n));
      };
      auto& spans = cells.emplace_back();
      const int32_t ground = below(0, 4) * 60;
      spans.emplace_back(ground - 200, ground);
      const bool is_ramp = z >= 20 && z < 40 && x >= 10 && x < 130;
      if (is_ramp) spans.emplace_back(ground, std::max(ground, (x - 10) * 25));
      const bool is_hole = z >= 15 && z < 45 && x < 120;
      if (!is_hole && below(1, 12) != 0) spans.emplace_back(2900, 3000 + below(2, 3) * 50);
      if (x % 50 == 49 && z % 30 > 8) spans.emplace_back(0, 2500);
      if (below(3, 25) == 0) spans.emplace_back(0, 900 + below(4, 5000));
    }
  }
  return naive::from_lists(kSide, kSide, cells);
}

DepthSlices cut(const naive::Columns& columns, int32_t avatar_height) {
  Context context;
  DepthSlices slices = *store_depths(*papers::sweep_slices(
      naive::make_tiles(columns), naive::sweep_config(columns, avatar_height, 100), context));
  slices.cell = kCell;
  return slices;
}

AvatarClass body(const char* name, double height, double radius, double speed) {
  AvatarClass avatar;
  avatar.name = name;
  avatar.height = height;
  avatar.radius = radius;
  avatar.speed = speed;
  avatar.step_height = kStep;
  return avatar;
}

SliceWanderConfig three_kinds() {
  return {.groups = {{body("child", 1.1, 0.12, 0.9), 60},
                     {body("adult", 1.75, 0.19, 1.34), 200},
                     {body("giant", 2.4, 0.6, 2.1), 12}},
          .dt = 0.1,
          .seed = 5};
}

// Do the columns leave the body's cylinder free, with a floor under all that it covers? And do no
// two bodies share a place? By the columns alone.
void expect_no_faults(const naive::Columns& columns, const SliceWanderConfig& config,
                      const std::vector<AvatarState>& avatars) {
  for (size_t i = 0; i < avatars.size(); ++i) {
    const AvatarState& a = avatars[i];
    const AvatarClass& kind = config.groups[static_cast<size_t>(a.avatar_class)].avatar;
    const auto feet = static_cast<int32_t>(std::lround(a.position.y * 1000));
    const auto head = feet + static_cast<int32_t>(std::lround(kind.height * 1000));
    const auto first = [&](double at) {
      return static_cast<int32_t>(std::floor((at - kind.radius) / kCell + 1e-6));
    };
    const auto last = [&](double at) {
      return static_cast<int32_t>(std::floor((at + kind.radius) / kCell - 1e-6));
    };
    for (int32_t z = first(a.position.z); z <= last(a.position.z); ++z) {
      for (int32_t x = first(a.position.x); x <= last(a.position.x); ++x) {
        ASSERT_TRUE(x >= 0 && z >= 0 && x < kSide && z < kSide);
        const auto cell = static_cast<size_t>(z * kSide + x);
        int32_t floor = INT32_MIN;
        for (size_t s = 0; s < columns.lows(cell).size(); ++s) {
          const int32_t low = columns.lows(cell)[s], high = columns.highs(cell)[s];
          EXPECT_FALSE(low < head && high > feet) << "avatar " << i << " is in a solid";
          if (high <= feet) floor = high;
        }
        EXPECT_LE(feet - floor, std::lround(kStep * 1000)) << "avatar " << i << " has no floor";
      }
    }
    for (size_t j = i + 1; j < avatars.size(); ++j) {
      const AvatarState& b = avatars[j];
      const AvatarClass& other = config.groups[static_cast<size_t>(b.avatar_class)].avatar;
      const double dx = a.position.x - b.position.x, dz = a.position.z - b.position.z;
      const bool touch = std::sqrt(dx * dx + dz * dz) < kind.radius + other.radius - 1e-6;
      EXPECT_FALSE(touch && a.position.y < b.position.y + other.height &&
                   b.position.y < a.position.y + kind.height)
          << i << " and " << j << " overlap";
    }
  }
}

TEST(SliceWanderers, BodiesOfThreeKindsEnterNeitherSolidsNorEachOther) {
  for (uint64_t seed = 0; seed < 3; ++seed) {
    const naive::Columns columns = building(seed);
    const SliceWanderConfig config = three_kinds();
    auto crowd = SliceWanderers::create(cut(columns, 1100), config);
    ASSERT_TRUE(crowd) << crowd.error().message;
    EXPECT_EQ(crowd->size(), 272u);
    std::vector<AvatarState> first, now;
    crowd->read(first);
    expect_no_faults(columns, config, first);
    uint64_t moved = 0, blocked_by_wall = 0, blocked_by_avatar = 0;
    for (int step = 0; step < 300; ++step) {
      const WanderReport report = crowd->step();
      moved += report.moved;
      blocked_by_wall += report.blocked_by_wall;
      blocked_by_avatar += report.blocked_by_avatar;
      if (step % 30 != 29) continue;
      crowd->read(now);
      expect_no_faults(columns, config, now);
      const CrowdCheck check = crowd->check();
      EXPECT_EQ(check.wall_entries + check.overlaps, 0u);
    }
    EXPECT_GT(moved, 10000u);
    EXPECT_GT(blocked_by_wall, 100u);
    EXPECT_GT(blocked_by_avatar, 100u);
    double farthest = 0, highest = 0;
    for (size_t i = 0; i < now.size(); ++i) {
      farthest = std::max(farthest, std::fabs(now[i].position.x - first[i].position.x));
      highest = std::max(highest, std::fabs(now[i].position.y - first[i].position.y));
    }
    EXPECT_GT(farthest, 4);
    EXPECT_GT(highest, 0.1) << "none climbed a step";
  }
}

TEST(SliceWanderers, StateHashIsTheSameForAnyThreads) {
  const naive::Columns columns = building(1);
  std::set<uint64_t> hashes;
  for (const int32_t workers : {1, 2, 3, 8}) {
    SliceWanderConfig config = three_kinds();
    config.workers = workers;
    auto crowd = SliceWanderers::create(cut(columns, 1100), config);
    ASSERT_TRUE(crowd);
    for (int step = 0; step < 100; ++step) crowd->step();
    hashes.insert(crowd->state_hash());
  }
  EXPECT_EQ(hashes.size(), 1u);
  EXPECT_EQ(*hashes.begin(), 17217044617261575638u) << "golden";
}

TEST(SliceWanderers, AsManyFitAsTheErrorSays) {
  const auto columns = naive::from_lists(
      kSide, 6,
      std::vector<std::vector<std::pair<int32_t, int32_t>>>(size_t{kSide} * 6, {{0, 100}}));
  SliceWanderConfig config{.groups = {{body("adult", 1.75, 0.19, 1.34), 1000}}};
  const auto refused = SliceWanderers::create(cut(columns, 1750), config);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, Errc::kLimit);
  const auto fit = static_cast<uint32_t>(std::stoul(refused.error().message.substr(8)));
  EXPECT_GT(fit, 20u);
  EXPECT_LT(fit, 40u);
  config.groups[0].count = fit;
  EXPECT_TRUE(SliceWanderers::create(cut(columns, 1750), config));
}

TEST(SliceWanderers, BodiesThatSlicesDoNotServeAreRefusedByName) {
  const auto columns = naive::from_lists(1, 1, {{{0, 100}}});
  const auto refuse = [&](const AvatarClass& avatar, const char* reason) {
    const auto crowd = SliceWanderers::create(cut(columns, 1750), {.groups = {{avatar, 1}}});
    ASSERT_FALSE(crowd);
    EXPECT_EQ(crowd.error().code, Errc::kBadConfig);
    EXPECT_NE(crowd.error().message.find(avatar.name), std::string::npos);
    EXPECT_NE(crowd.error().message.find(reason), std::string::npos) << crowd.error().message;
  };
  refuse(body("small", 1.1, 0.1, 1.3), "--avatar-height 1.1");
  refuse(body("huge", 25, 0.1, 1.3), "20 m");
  refuse(body("slow", 1.75, 0.1, 0.001), "longer steps");
  AvatarClass bird = body("bird", 1.75, 0.1, 1.3);
  bird.flies = true;
  refuse(bird, "only walk");
  EXPECT_FALSE(SliceWanderers::create(cut(columns, 1750), {}));
  EXPECT_FALSE(SliceWanderers::create({}, {.groups = {{body("adult", 1.75, 0.19, 1.3), 1}}}));
}

}  // namespace
}  // namespace throng
