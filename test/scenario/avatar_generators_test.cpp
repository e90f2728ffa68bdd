// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <set>
#include <vector>

#include "baked.h"
#include "core/random.h"
#include "rays.h"
#include "throng/crowd.h"
#include "worlds.h"

namespace throng {
namespace {

// Blocks of houses, 20 m by 20 m and 12 m high, between streets of 10 m.
struct Town {
  Scene scene;
  std::vector<Box3d> houses;
  World world;
  Town() {
    scene.add_box({0, -1, 0}, {160, 0, 160});
    for (int32_t z = 0; z < 5; ++z) {
      for (int32_t x = 0; x < 5; ++x) {
        const Vec3d low{10.0 + 30 * x, 0, 10.0 + 30 * z};
        houses.push_back({low, low + Vec3d{20, 12, 20}});
        scene.add_box(houses.back().min, houses.back().max);
      }
    }
    world = test::bake(scene, 0.25, {default_classes()[0]});
  }
};

const Town& town() {
  static const Town one;
  return one;
}

// Does the segment pass through the inside of the box?
bool cuts(Vec3d from, Vec3d to, const Box3d& box) {
  double enter = 0, leave = 1;
  const auto clip = [&](double a, double b, double low, double high) {
    const double d = b - a;
    if (std::fabs(d) < 1e-12) {
      if (a <= low || a >= high) enter = 2;
      return;
    }
    const double t0 = (low - a) / d, t1 = (high - a) / d;
    enter = std::max(enter, std::min(t0, t1));
    leave = std::min(leave, std::max(t0, t1));
  };
  clip(from.x, to.x, box.min.x, box.max.x);
  clip(from.y, to.y, box.min.y, box.max.y);
  clip(from.z, to.z, box.min.z, box.max.z);
  return enter < leave;
}

// The shadow of a convex body is convex: a box whose corners all lie in the shadow of one house is
// hidden.
bool can_see(Vec3d eye, const Box3d& box) {
  return std::none_of(town().houses.begin(), town().houses.end(), [&](const Box3d& house) {
    for (size_t k = 0; k < 8; ++k) {
      const Vec3d corner{(k & 1) != 0 ? box.max.x : box.min.x, (k & 2) != 0 ? box.max.y : box.min.y,
                         (k & 4) != 0 ? box.max.z : box.min.z};
      if (!cuts(eye, corner, house)) return false;
    }
    return true;
  });
}

// An oracle from triangles alone: is any of some points of a body in sight?
bool is_body_in_sight(Vec3d eye, Vec3d feet, uint64_t salt) {
  const Scene& scene = town().scene;
  for (uint64_t k = 0; k < 40; ++k) {
    const double turn = 6.283185307 * random_unit(91, salt, 3 * k);
    const double out = 0.3 * random_unit(91, salt, 3 * k + 1);
    const Vec3d point =
        feet + Vec3d{out * std::cos(turn), 0.05 + 1.7 * random_unit(91, salt, 3 * k + 2),
                     out * std::sin(turn)};
    const Vec3d ray = point - eye;
    const bool hidden = std::any_of(scene.triangles.begin(), scene.triangles.end(),
                                    [&](const std::array<uint32_t, 3>& t) {
                                      const auto at = meet(scene, t, eye, ray);
                                      return at && at->u >= 0 && at->v >= 0 && at->u + at->v <= 1 &&
                                             at->along > 1e-9 && at->along < 1 - 1e-9;
                                    });
    if (!hidden) return true;
  }
  return false;
}

struct Walk {
  double min_share = 1e9, max_share = 0;  // Avatars in sight by the required number, after a while.
  double mean = 0;
  uint64_t added = 0, removed = 0;
  size_t appeared_in_sight = 0, gone_in_sight = 0;
  size_t largest = 0;  // Crowd.
  uint64_t hash = 0;
};

// Five minutes of a street; `at` is where the eye is after that many steps.
template <class At>
Walk walk_and_see(const GeneratorConfig& config, At at, int32_t steps) {
  Walk out;
  auto crowd = Crowd::create(town().world, {.dt = 0.2, .seed = 3});
  EXPECT_TRUE(crowd) << crowd.error().message;
  Context context;
  auto generators = AvatarGenerators::create(town().world, config, context);
  EXPECT_TRUE(generators) << generators.error().message;
  std::set<uint32_t> before;
  std::vector<AvatarState> states;
  std::vector<std::pair<uint32_t, Vec3d>> last;
  int32_t counted = 0;
  for (int32_t step = 0; step <= steps; ++step) {
    const Vec3d eye = at(step);
    const auto sight = [&](const Box3d& box) { return can_see(eye, box); };
    crowd->read(states);
    last.clear();
    for (const AvatarState& s : states) last.emplace_back(s.id, s.position);
    const auto report = generators->update(*crowd, eye, sight, context);
    EXPECT_TRUE(report) << report.error().message;
    crowd->read(states);
    if (step > 0) {
      // Slots are reused, so compare by place: no avatar moves during the update.
      const auto key = [](Vec3d p) { return std::array{p.x, p.y, p.z}; };
      std::set<std::array<double, 3>> then, now;
      for (const auto& [id, p] : last) then.insert(key(p));
      for (const AvatarState& s : states) now.insert(key(s.position));
      for (const auto& p : now) {
        if (then.count(p) == 0) {
          out.appeared_in_sight += is_body_in_sight(eye, {p[0], p[1], p[2]}, out.added++) ? 1 : 0;
        }
      }
      for (const auto& p : then) {
        if (now.count(p) == 0) {
          out.gone_in_sight += is_body_in_sight(eye, {p[0], p[1], p[2]}, out.removed++) ? 1 : 0;
        }
      }
    }
    out.largest = std::max<size_t>(out.largest, crowd->size());
    if (step > steps / 4) {
      const double share = report->seen_avatars / (config.density * report->seen_area);
      out.min_share = std::min(out.min_share, share);
      out.max_share = std::max(out.max_share, share);
      out.mean += share;
      ++counted;
    }
    crowd->step();
  }
  out.mean /= counted;
  out.hash = crowd->state_hash();
  EXPECT_EQ(crowd->check().overlaps, 0U);
  return out;
}

GeneratorConfig config_of(double density) {
  GeneratorConfig config;
  config.home = town().world.find_place(0, {5, 0, 5}, 1);
  config.density = density;
  config.radius = 90;
  return config;
}

TEST(AvatarGenerators, KeepAStreetPopulatedWhileOnlyWhatIsSeenIsSimulated) {
  const GeneratorConfig config = config_of(0.04);
  Context context;
  const auto generators = AvatarGenerators::create(town().world, config, context);
  ASSERT_TRUE(generators);
  const double all = config.density * generators->area();
  EXPECT_NEAR(generators->area(), 160 * 160 - 25 * 21 * 21, 1500);  // Bodies keep off walls.
  const auto stands = [](int32_t) { return Vec3d{35, 1.7, 65}; };
  const Walk r = walk_and_see(config, stands, 900);
  std::printf(
      "standing: %.2f to %.2f of the required number in sight, mean %.2f; %llu added, %llu "
      "removed, %zu "
      "and %zu in sight; at most %zu of %.0f simulated\n",
      r.min_share, r.max_share, r.mean, static_cast<unsigned long long>(r.added),
      static_cast<unsigned long long>(r.removed), r.appeared_in_sight, r.gone_in_sight, r.largest,
      all);
  EXPECT_GT(r.added, 100U);
  EXPECT_GT(r.removed, 100U);
  EXPECT_EQ(r.appeared_in_sight, 0U);
  EXPECT_EQ(r.gone_in_sight, 0U);
  EXPECT_GT(r.min_share, 0.55);
  EXPECT_LT(r.max_share, 1.4);
  EXPECT_NEAR(r.mean, 1, 0.06);
  EXPECT_LT(static_cast<double>(r.largest), 0.8 * all);
}

TEST(AvatarGenerators, TakeANumberOfAvatarsInPlaceOfADensity) {
  Context context;
  GeneratorConfig config = config_of(0.04);
  const auto by_density = AvatarGenerators::create(town().world, config, context);
  ASSERT_TRUE(by_density);
  const auto stands = [](int32_t) { return Vec3d{35, 1.7, 65}; };
  const uint64_t wanted = walk_and_see(config, stands, 30).hash;
  config.people = 0.04 * by_density->area();
  config.density = 0.9;
  EXPECT_EQ(walk_and_see(config, stands, 30).hash, wanted);
  config.people = -1;
  EXPECT_EQ(AvatarGenerators::create(town().world, config, context).error().code, Errc::kBadConfig);
}

TEST(AvatarGenerators, FollowAnEyeThatWalksAroundCorners) {
  const GeneratorConfig config = config_of(0.04);
  const auto walks = [](int32_t step) {  // 1.4 m/s around a block.
    const double walked = std::fmod(step * 0.28, 120.0), side = walked / 30;
    const double along = (side - std::floor(side)) * 30;
    switch (static_cast<int32_t>(side)) {
      case 0:
        return Vec3d{35 + along, 1.7, 65};
      case 1:
        return Vec3d{65, 1.7, 65 + along};
      case 2:
        return Vec3d{65 - along, 1.7, 95};
      default:
        return Vec3d{35, 1.7, 95 - along};
    }
  };
  const Walk r = walk_and_see(config, walks, 900);
  std::printf("walking: %.2f to %.2f, mean %.2f; %llu added, %llu removed, %zu and %zu in sight\n",
              r.min_share, r.max_share, r.mean, static_cast<unsigned long long>(r.added),
              static_cast<unsigned long long>(r.removed), r.appeared_in_sight, r.gone_in_sight);
  EXPECT_EQ(r.appeared_in_sight, 0U);
  EXPECT_EQ(r.gone_in_sight, 0U);
  EXPECT_GT(r.min_share, 0.55);
  EXPECT_LT(r.max_share, 1.35);
  EXPECT_NEAR(r.mean, 1, 0.06);
  EXPECT_EQ(walk_and_see(config, walks, 60).hash, walk_and_see(config, walks, 60).hash);
}

TEST(AvatarGenerators, RefuseBadSettings) {
  Context context;
  GeneratorConfig config = config_of(0.04);
  config.density = 0;
  EXPECT_EQ(AvatarGenerators::create(town().world, config, context).error().code, Errc::kBadConfig);
  config = config_of(0.04);
  config.avatar_class = 7;
  EXPECT_EQ(AvatarGenerators::create(town().world, config, context).error().code, Errc::kNotFound);
  config = config_of(0.04);
  config.mix = {{.avatar_class = 0}, {.avatar_class = 0}};
  EXPECT_EQ(AvatarGenerators::create(town().world, config, context).error().code, Errc::kBadConfig);
  config.mix = {{.avatar_class = 0, .share = 0}};
  EXPECT_EQ(AvatarGenerators::create(town().world, config, context).error().code, Errc::kBadConfig);
  config.mix = {{.avatar_class = 5}};
  EXPECT_EQ(AvatarGenerators::create(town().world, config, context).error().code, Errc::kNotFound);
  config = config_of(0.04);
  config.region = -1;
  EXPECT_EQ(AvatarGenerators::create(town().world, config, context).error().code, Errc::kBadConfig);
  config = config_of(0.04);
  config.map.weights = {1, 2, 3};
  EXPECT_EQ(AvatarGenerators::create(town().world, config, context).error().code, Errc::kBadConfig);
  config = config_of(0.04);
  config.home = {};
  EXPECT_EQ(AvatarGenerators::create(town().world, config, context).error().code, Errc::kBadInput);
}

TEST(AvatarGenerators, SpreadAMixByADensityMapOnBothSidesOfTheBorder) {
  const World world = test::bake(town().scene, 0.25, {default_classes()[0], default_classes()[1]});
  // The west has three times the weight of the east, and a street along X has none.
  GeneratorConfig config;
  config.home = world.find_place(0, {5, 0, 5}, 1);
  config.density = 0.03;
  config.radius = 200;
  config.mix = {{.avatar_class = 0, .share = 3}, {.avatar_class = 1, .share = 1}};
  config.map = {.x0 = 0, .z0 = 0, .x1 = 160, .z1 = 160, .width = 160, .height = 160, .weights = {}};
  const auto weight_at = [](double x, double z) {
    return z > 62 && z < 68 && x > 20 ? 0 : x < 80 ? 90 : 30;
  };
  for (int z = 0; z < 160; ++z) {
    for (int x = 0; x < 160; ++x) {
      config.map.weights.push_back(static_cast<uint8_t>(weight_at(x + 0.5, z + 0.5)));
    }
  }
  Context context;
  auto generators = AvatarGenerators::create(world, config, context);
  ASSERT_TRUE(generators) << generators.error().message;
  Crowd crowd = *Crowd::create(world, {.dt = 0.2, .seed = 3});
  // The border between what is seen and what is not cuts both halves.
  const auto can_see_from = [](const Vec3d&, const Box3d& box) { return box.min.z < 80; };
  generators->set_region_sight(can_see_from);
  const Vec3d eye{80, 1.7, 40};
  const auto can_see = [&](const Box3d& box) { return can_see_from(eye, box); };
  double west = 0, east = 0, children = 0, all = 0;
  std::vector<AvatarState> states;
  for (int step = 0; step < 200; ++step) {
    ASSERT_TRUE(generators->update(crowd, eye, can_see, context));
    crowd.step();
    crowd.read(states);
    for (const AvatarState& s : states) {
      (s.position.x < 80 ? west : east) += 1;
      children += s.avatar_class == 1 ? 1 : 0;
      all += 1;
      ASSERT_NE(weight_at(s.position.x, s.position.z), 0);
    }
  }
  EXPECT_GT(all / 200, 150);
  EXPECT_GT(west / east, 2.2) << "three, but paths in the east cost more";
  EXPECT_LT(west / east, 5);
  EXPECT_NEAR(children / all, 0.25, 0.06);
}

TEST(AvatarGenerators, QueryWhatIsSeenFromTheWholeRegionOfTheEye) {
  GeneratorConfig config = config_of(0.04);
  config.region = 4;
  Context context;
  auto generators = AvatarGenerators::create(town().world, config, context);
  ASSERT_TRUE(generators);
  Crowd crowd = *Crowd::create(town().world, {});
  const Vec3d eye{35, 1.7, 65};
  const auto sight = [&](const Box3d& box) { return can_see(eye, box); };
  const auto of_point = generators->populate(crowd, eye, sight, context);
  ASSERT_TRUE(of_point);
  generators->set_region_sight(
      [](const Vec3d& from, const Box3d& box) { return can_see(from, box); });
  const auto of_region = generators->populate(crowd, eye, sight, context);
  ASSERT_TRUE(of_region);
  EXPECT_GT(of_region->seen_area, of_point->seen_area);
}

TEST(AvatarGenerators, PopulateAfterAJumpMovesOwnAvatarsAndLeavesOthers) {
  const GeneratorConfig config = config_of(0.04);
  Context context;
  auto generators = AvatarGenerators::create(town().world, config, context);
  auto crowd = Crowd::create(town().world, {.dt = 0.2, .seed = 3});
  ASSERT_TRUE(generators && crowd);
  const auto others = crowd->scatter(20, {}, context);
  ASSERT_TRUE(others);

  for (const Vec3d eye : {Vec3d{35, 1.7, 65}, Vec3d{125, 1.7, 95}}) {
    const std::vector<AvatarId> before(generators->members().begin(), generators->members().end());
    const auto sight = [&](const Box3d& box) { return can_see(eye, box); };
    const auto report = generators->populate(*crowd, eye, sight, context);
    ASSERT_TRUE(report) << report.error().message;
    EXPECT_EQ(report->removed, before.size());
    EXPECT_EQ(report->added, generators->members().size());
    EXPECT_EQ(crowd->size(), others->size() + generators->members().size());
    const auto alive = [&](AvatarId id) { return crowd->is_alive(id); };
    EXPECT_TRUE(std::none_of(before.begin(), before.end(), alive));
    EXPECT_TRUE(std::all_of(others->begin(), others->end(), alive));
    EXPECT_GT(report->seen_avatars, 10u);
    EXPECT_NEAR(report->seen_avatars, config.density * report->seen_area,
                0.2 * config.density * report->seen_area);
  }
}

// A small yard for two classes.
struct Yard {
  World world = test::bake(worlds::flat(30), 0.25, {{.name = "adult"}, {.name = "porter"}});
  GeneratorConfig config{.home = world.find_place(1, {15, 0, 15}, 0.1), .avatar_class = 1};
  Context context;
};

TEST(AvatarGenerators, PopulateFailsAsACrowdThatAddsThem) {
  Yard yard;
  Context context;
  auto generators = AvatarGenerators::create(yard.world, yard.config, context);
  ASSERT_TRUE(generators) << generators.error().message;
  const Vec3d eye{15, 1.7, 15};
  const auto sees_all = [](const Box3d&) { return true; };

  // Its world has no such class.
  auto other = Crowd::create(test::bake(worlds::flat(30), 0.25, {{.name = "adult"}}), {});
  ASSERT_TRUE(other);
  const auto unknown = generators->populate(*other, eye, sees_all, context);
  ASSERT_FALSE(unknown);
  EXPECT_EQ(unknown.error().code, Errc::kNotFound) << unknown.error().message;
  EXPECT_EQ(other->size(), 0u);
  EXPECT_TRUE(generators->members().empty());

  auto crowd = Crowd::create(yard.world, {});
  ASSERT_TRUE(crowd);
  context.cancel = true;
  const auto cancelled = generators->populate(*crowd, eye, sees_all, context);
  ASSERT_FALSE(cancelled);
  EXPECT_EQ(cancelled.error().code, Errc::kCancelled);
  EXPECT_EQ(crowd->size(), 0u);
  EXPECT_TRUE(generators->members().empty());

  context.cancel = false;
  const auto report = generators->populate(*crowd, eye, sees_all, context);
  ASSERT_TRUE(report) << report.error().message;
  EXPECT_EQ(report->removed, 0u);
  EXPECT_GT(report->added, 20u);
  EXPECT_EQ(generators->members().size(), report->added);
}

TEST(AvatarGenerators, PopulateNothingForAnEyeThatSeesNothing) {
  Yard yard;
  auto generators = AvatarGenerators::create(yard.world, yard.config, yard.context);
  auto crowd = Crowd::create(yard.world, {});
  ASSERT_TRUE(generators && crowd);
  const auto sees = [](bool all) { return [all](const Box3d&) { return all; }; };
  const Vec3d eye{15, 1.7, 15};
  for (int round = 0; round < 2; ++round) {  // Also after there were some.
    for (const Vec3d& nowhere :
         {Vec3d{NAN, 0, 0}, Vec3d{15, 0, NAN}, Vec3d{HUGE_VAL, 0, 0}, Vec3d{1e6, 0, 1e6}}) {
      const auto report = generators->populate(*crowd, nowhere, sees(true), yard.context);
      ASSERT_TRUE(report) << report.error().message;
      EXPECT_EQ(report->added, 0u);
      EXPECT_EQ(report->seen_area, 0);
      EXPECT_EQ(crowd->size(), 0u);
    }
    const auto blind = generators->populate(*crowd, eye, sees(false), yard.context);
    ASSERT_TRUE(blind);
    EXPECT_EQ(crowd->size(), 0u) << "without what is seen there is no band";
    ASSERT_TRUE(generators->populate(*crowd, eye, sees(true), yard.context));
    EXPECT_GT(crowd->size(), 20u);
  }
}

}  // namespace
}  // namespace throng
