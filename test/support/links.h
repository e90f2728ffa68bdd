// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "baked.h"
#include "crowds.h"
#include "throng/crowd.h"
#include "throng/path.h"
#include "throng/scene.h"
#include "throng/world.h"

/// Worlds with off-mesh links, and an oracle that knows only the world, the links and where the
/// avatars are.
namespace throng::links {

// Two floors of 10 x 10 m with a gap of 2 m between them.
inline World gap() {
  Scene scene;
  scene.add_box({0, -0.5, 0}, {10, 0, 10});
  scene.add_box({12, -0.5, 0}, {22, 0, 10});
  return test::bake(scene, 0.1);
}

// A floor of 10 x 10 m, 3 m above another beside it.
inline World ledge() {
  Scene scene;
  scene.add_box({0, 0, 0}, {10, 3, 10});
  scene.add_box({10, -0.5, 0}, {20, 0, 10});
  return test::bake(scene, 0.1);
}

inline Place at(const World& world, double x, double z, double y = 0) {
  const Place place = world.find_place(0, {x, y, z}, 0.5);
  EXPECT_TRUE(place) << x << ' ' << z;
  return place;
}

inline EditId add_link(Edits& edits, const OffMeshLink& link) {
  const auto added = edits.add_off_mesh_link(link);
  EXPECT_TRUE(added);
  return added ? *added : 0;
}

inline double distance_to_segment(const Vec3d& p, const Vec3d& a, const Vec3d& b) {
  const Vec3d along = b - a;
  const double whole = dot(along, along);
  const double part = whole > 0 ? std::clamp(dot(p - a, along) / whole, 0.0, 1.0) : 0;
  return length(p - (a + along * part));
}

// Looks at every pair and every position.
struct Oracle {
  const World& world;
  std::vector<OffMeshLink> links;
  uint64_t pairs = 0, riding = 0;  // that it has looked at

  void look(const Crowd& crowd, int step) {
    std::vector<AvatarState> all;
    crowd.read(all);
    const auto height = [&](const AvatarState& a) {
      return world.summary().classes[static_cast<size_t>(a.avatar_class)].height;
    };
    for (size_t i = 0; i < all.size(); ++i) {
      const AvatarState& a = all[i];
      if (a.mode == MoveMode::kLink) {
        ++riding;
        double nearest = HUGE_VAL;
        for (const OffMeshLink& link : links) {
          nearest = std::min(nearest,
                             distance_to_segment(a.position, link.from.position, link.to.position));
        }
        ASSERT_LT(nearest, 0.2) << "step " << step << ": off every line";
      } else if (a.mode == MoveMode::kWalk) {
        const Place under = world.find_place(a.avatar_class, a.position, 0.01);
        ASSERT_TRUE(under) << "step " << step << ": stands nowhere";
        ASSERT_NEAR(under.position.y, a.position.y, 0.003);
      }
      for (size_t j = i + 1; j < all.size(); ++j, ++pairs) {
        const AvatarState& b = all[j];
        const double apart = std::hypot(a.position.x - b.position.x, a.position.z - b.position.z);
        const bool level = a.position.y < b.position.y + height(b) - 1e-9 &&
                           b.position.y < a.position.y + height(a) - 1e-9;
        ASSERT_FALSE(level && apart < a.radius + b.radius - 1e-9) << "step " << step;
      }
    }
    const CrowdCheck check = crowd.check();
    ASSERT_EQ(check.wall_entries, 0u) << "step " << step;
    ASSERT_EQ(check.overlaps, 0u) << "step " << step;
    ASSERT_EQ(check.obstacle_entries, 0u) << "step " << step;
  }
};

// Steps until so many have arrived. Returns after how many steps, or -1.
inline int steps_until(Crowd& crowd, Oracle& oracle, uint64_t arrivals, int max_steps) {
  uint64_t arrived = 0;
  for (int step = 1; step <= max_steps; ++step) {
    arrived += crowd.step().arrived;
    oracle.look(crowd, step);
    if (testing::Test::HasFatalFailure()) return -1;
    if (arrived >= arrivals) return step;
  }
  return -1;
}

inline AvatarId walker(Crowd& crowd, const Place& from, const Place& to) {
  const AvatarId id = added(crowd, from);
  EXPECT_TRUE(id);
  crowd.set_goals({&id, 1}, {&to, 1});
  return id;
}

// Steps until an avatar is on a link. Returns its state.
inline AvatarState step_until_riding(Crowd& crowd, AvatarId id) {
  for (int step = 0; step < 400; ++step) {
    crowd.step();
    const auto state = crowd.read(id);
    if (state && state->mode == MoveMode::kLink) return *state;
  }
  ADD_FAILURE() << "it takes no link";
  return {};
}

/// Edits beside the gap that change in each step, so that avatars search in each.
class ChangesInEachStep {
 public:
  explicit ChangesInEachStep(const Edits& edits) : edits_(edits) {
    EXPECT_TRUE(edits_.add_area(Prism::box({0, -1, 0}, {2, 1, 2}), 1));
    const auto crate = edits_.add_obstacle(Prism::box({0.5, 0, 9}, {1, 1, 9.5}));
    EXPECT_TRUE(crate);
    if (crate) crate_ = *crate;
  }
  /// Of paths.
  void change_costs(int step) { EXPECT_TRUE(edits_.set_area_cost(1, 1.5 + step % 2)); }
  /// What flow fields lead around.
  void change_flows(int step) { EXPECT_TRUE(edits_.set_active(crate_, step % 2 == 0)); }

 private:
  Edits edits_;
  EditId crate_ = 0;
};

}  // namespace throng::links
