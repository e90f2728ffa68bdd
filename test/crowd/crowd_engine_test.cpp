// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "crowd/walk/crowd_engine.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <span>
#include <string>
#include <vector>

#include "baked.h"
#include "core/access.h"
#include "core/random.h"
#include "plain_crowd.h"
#include "simd_targets.h"
#include "world/place.h"
#include "worlds.h"

namespace throng {
namespace {

// An engine on level ground, and the same bodies in the reference step of the tests.
struct Pair {
  test::PlainCrowd plain;
  crowd::CrowdEngine engine;
  uint64_t steps = 0;

  // Steps both and names the first body that differs.
  std::string step() {
    plain.step();
    crowd::EngineCounts counts;
    crowd::EngineTimes times;
    engine.step(
        steps++, [](std::span<crowd::Body>, int32_t) {}, counts, times);
    std::vector<const crowd::Body*> by_slot(engine.bodies().size());
    for (const crowd::Body& body : engine.bodies()) by_slot[body.slot] = &body;
    for (size_t i = 0; i < by_slot.size(); ++i) {
      const test::PlainBody& p = plain.bodies()[i];
      const crowd::Body& b = *by_slot[i];
      if (b.x != p.at.x || b.z != p.at.z || b.detour_angle != p.turn ||
          b.has(crowd::Body::kArrived) != (p.arrived >= 0)) {
        return "body " + std::to_string(i) + " in step " + std::to_string(steps);
      }
    }
    return "";
  }
};

struct LevelGround {
  World world;
  crowd::CrowdGround ground;

  explicit LevelGround(double side)
      : world(test::bake(worlds::flat(side), 0.1)),
        ground(*crowd::CrowdGround::create(*data_of(world), 0, 400)) {}

  [[nodiscard]] Pair pair(const std::vector<test::PlainBody>& bodies,
                          const test::PlainConfig& config, int32_t workers) const {
    const world::WorldData& data = *data_of(world);
    int32_t widest = 0;
    float fastest = 0;
    for (const test::PlainBody& b : bodies) {
      widest = std::max(widest, b.radius);
      fastest = std::max(fastest, b.speed);
    }
    crowd::CrowdEngine engine({.units = config.units,
                               .sight = config.sight,
                               .rounds = config.rounds,
                               .deadlock_avoidance = config.deadlock_avoidance,
                               .reaction = config.reaction,
                               .seed = config.seed,
                               .workers = workers,
                               .model = config.model,
                               .steering = config.steering,
                               .deadlock_settings = config.deadlock_settings,
                               .lanes = config.lanes,
                               .spacing = {},
                               .queues = config.queues,
                               .queue = config.queue,
                               .acceleration = config.acceleration},
                              data.width, data.depth, 1);
    engine.set_ground(0, crowd::StrideGround(ground, 400));
    engine.fit(widest, fastest, config.units.dt);
    for (size_t i = 0; i < bodies.size(); ++i) {
      const test::PlainBody& p = bodies[i];
      crowd::Body body;
      body.x = p.at.x;
      body.z = p.at.z;
      const auto tile =
          data.tile_levels(p.at.x >> (world::kUnitBits + 6), p.at.z >> (world::kUnitBits + 6));
      EXPECT_EQ(tile.last, tile.first + 1) << "level ground has one level";
      body.level = tile.first;
      body.y = ground.feet(body.level, body.point());
      body.local_target_x = p.goal.x;
      body.local_target_z = p.goal.z;
      body.speed = p.speed;
      body.radius = p.radius;
      body.slot = static_cast<uint32_t>(i);
      body.height = 1750;
      body.flags = crowd::Body::kHasGoal | crowd::Body::kLast;
      engine.add(body);
    }
    return {test::PlainCrowd(bodies, config), std::move(engine)};
  }
};

std::vector<test::PlainBody> scattered(const test::PlainConfig& config, uint32_t count, double area,
                                       uint64_t seed, test::Spot corner) {
  int32_t side = 0;
  std::vector<test::PlainBody> bodies = random_bodies(config, count, area, seed, side);
  for (uint32_t i = 0; i < count; ++i) {
    test::PlainBody& b = bodies[i];
    b.at = {b.at.x + corner.x, b.at.z + corner.z};
    b.goal = {
        corner.x + static_cast<int32_t>(random_below(seed, 1, i, static_cast<uint64_t>(side))),
        corner.z + static_cast<int32_t>(random_below(seed, 2, i, static_cast<uint64_t>(side)))};
    b.radius = config.to_units(0.15 + 0.15 * random_unit(seed, 5, i));
    b.speed = static_cast<float>(0.5 + random_unit(seed, 6, i));
  }
  return bodies;
}

TEST(CrowdEngine, DoesWhatThePlainStepDoes) {
  const LevelGround ground(60);
  const test::PlainConfig config;
  const test::Spot corner{config.to_units(15), config.to_units(15)};
  for (const double area : {4.0, 1.0, 0.7}) {
    for (const uint64_t seed : {1, 2}) {
      Pair pair = ground.pair(scattered(config, 300, area, seed, corner), config, 2);
      for (int step = 0; step < 60; ++step) ASSERT_EQ(pair.step(), "") << area << ' ' << seed;
    }
  }
}

TEST(CrowdEngine, BodiesThatContinueDoWhatThePlainStepDoes) {
  const LevelGround ground(60);
  test::PlainConfig config;
  config.units.dt = 0.05f;
  const test::Spot corner{config.to_units(15), config.to_units(15)};
  for (const float reaction : {0.0f, 0.1f, 0.5f}) {
    config.reaction = reaction;
    for (const double area : {4.0, 1.0, 0.7}) {
      Pair pair = ground.pair(scattered(config, 300, area, 3, corner), config, 2);
      for (int step = 0; step < 80; ++step) ASSERT_EQ(pair.step(), "") << reaction << ' ' << area;
    }
  }
}

TEST(CrowdEngine, QueuesDoWhatThePlainStepDoes) {
  const LevelGround ground(60);
  test::PlainConfig config;
  config.queues = true;
  const test::Spot corner{config.to_units(15), config.to_units(15)};
  for (const float acceleration : {0.0f, 5.0f}) {
    config.acceleration = acceleration;
    for (const double area : {2.0, 1.0, 0.7}) {
      Pair pair = ground.pair(scattered(config, 300, area, 4, corner), config, 2);
      for (int step = 0; step < 300; ++step)
        ASSERT_EQ(pair.step(), "") << acceleration << ' ' << area;
    }
  }
}

TEST(CrowdEngine, BoundedAccelerationsDoWhatThePlainStepDoes) {
  const LevelGround ground(60);
  test::PlainConfig config;
  config.acceleration = 3;
  const test::Spot corner{config.to_units(15), config.to_units(15)};
  for (const double area : {4.0, 1.0, 0.7}) {
    Pair pair = ground.pair(scattered(config, 300, area, 4, corner), config, 2);
    for (int step = 0; step < 100; ++step) ASSERT_EQ(pair.step(), "") << area;
  }
}

// A third head to the same place, so that they queue and rest around it.
TEST(CrowdEngine, BodiesWithOneGoalDoWhatThePlainStepDoes) {
  const LevelGround ground(60);
  test::PlainConfig config;
  config.queues = true;
  const test::Spot corner{config.to_units(15), config.to_units(15)};
  for (uint64_t seed = 1; seed <= 10; ++seed) {
    std::vector<test::PlainBody> bodies = scattered(config, 200, 0.7, seed, corner);
    for (size_t i = 0; i < bodies.size(); i += 3) bodies[i].goal = bodies[0].goal;
    Pair pair = ground.pair(bodies, config, 2);
    for (int step = 0; step < 400; ++step) ASSERT_EQ(pair.step(), "") << seed;
  }
}

TEST(CrowdEngine, RingsDoWhatThePlainStepDoes) {
  const LevelGround ground(60);
  const test::PlainConfig config;
  const test::Spot middle{config.to_units(30), config.to_units(30)};
  Pair pair = ground.pair(ring_bodies(config, 120, 8, middle), config, 1);
  for (int step = 0; step < 300; ++step) ASSERT_EQ(pair.step(), "");
}

TEST(CrowdEngine, OtherModelsDoWhatThePlainStepDoes) {
  const LevelGround ground(60);
  test::PlainConfig config;
  config.deadlock_avoidance = false;
  config.reaction = 0;
  config.steering.neighbours = steer::kMaxNear;
  const test::Spot corner{config.to_units(15), config.to_units(15)};
  const test::Spot middle{config.to_units(30), config.to_units(30)};
  for (const SteeringModel model : {SteeringModel::kCurvilinear, SteeringModel::kSocialForce}) {
    config.model = model;
    for (const double area : {4.0, 1.0, 0.7}) {
      Pair pair = ground.pair(scattered(config, 300, area, 3, corner), config, 2);
      for (int step = 0; step < 60; ++step) {
        ASSERT_EQ(pair.step(), "") << name_of(model) << ' ' << area;
      }
      EXPECT_EQ(pair.plain.overlaps(), 0U);
    }
    Pair ring = ground.pair(ring_bodies(config, 60, 8, middle), config, 1);
    for (int step = 0; step < 150; ++step) ASSERT_EQ(ring.step(), "") << name_of(model);
  }
}

// Several processes that share a crowd have its bodies in different orders.
void expect_any_order(const LevelGround& ground, const std::vector<test::PlainBody>& bodies,
                      const test::PlainConfig& config, int steps, const std::string& name) {
  Pair kept = ground.pair(bodies, config, 2), shuffled = ground.pair(bodies, config, 2);
  const auto step = [](crowd::CrowdEngine& engine, int number) {
    crowd::EngineCounts counts;
    crowd::EngineTimes times;
    engine.step(
        static_cast<uint64_t>(number), [](std::span<crowd::Body>, int32_t) {}, counts, times);
    std::vector<crowd::Body> by_slot(engine.bodies().size());
    for (const crowd::Body& body : engine.bodies()) by_slot[body.slot] = body;
    return by_slot;
  };
  for (int number = 0; number < steps; ++number) {
    const std::span<crowd::Body> order = shuffled.engine.bodies();
    for (size_t i = order.size(); i > 1; --i) {
      std::swap(order[i - 1], order[random_below(9, static_cast<uint64_t>(number), i, i)]);
    }
    const auto a = step(kept.engine, number), b = step(shuffled.engine, number);
    for (size_t i = 0; i < a.size(); ++i) {
      ASSERT_TRUE(a[i].x == b[i].x && a[i].z == b[i].z && a[i].velocity.x == b[i].velocity.x &&
                  a[i].velocity.z == b[i].velocity.z && a[i].detour_angle == b[i].detour_angle &&
                  a[i].flags == b[i].flags && a[i].asks == b[i].asks &&
                  a[i].at_rest == b[i].at_rest)
          << name << ": body " << i << " in step " << number;
    }
  }
}

TEST(CrowdEngine, TheOrderOfBodiesDoesNotMatter) {
  const LevelGround ground(60);
  test::PlainConfig config;
  const test::Spot first{config.to_units(15), config.to_units(15)};
  for (const bool queues : {false, true}) {
    config.queues = queues;
    for (const float acceleration : {0.0f, 4.0f}) {
      config.acceleration = acceleration;
      for (const double area : {4.0, 1.0, 0.7}) {
        std::vector<test::PlainBody> bodies = scattered(config, 300, area, 5, first);
        const std::string name = std::to_string(queues) + ' ' + std::to_string(acceleration) + ' ' +
                                 std::to_string(area);
        expect_any_order(ground, bodies, config, 80, name);
        for (size_t i = 0; i < bodies.size(); i += 3) bodies[i].goal = bodies[0].goal;
        expect_any_order(ground, bodies, config, 150, name + ", one goal");
      }
    }
  }
  config = {};
  config.deadlock_avoidance = false;
  config.reaction = 0;
  config.steering.neighbours = steer::kMaxNear;
  for (const SteeringModel model : {SteeringModel::kCurvilinear, SteeringModel::kSocialForce}) {
    config.model = model;
    expect_any_order(ground, scattered(config, 300, 0.7, 6, first), config, 100,
                     std::string(name_of(model)));
  }
}

TEST(CrowdEngine, EveryMachineDoesTheSame) {
  const LevelGround ground(40);
  const test::PlainConfig config;
  const test::Spot corner{config.to_units(12), config.to_units(12)};
  test::for_every_simd_target([&](const char* name) {
    for (const int32_t workers : {1, 3}) {
      Pair pair = ground.pair(scattered(config, 150, 1, 7, corner), config, workers);
      for (int step = 0; step < 20; ++step) ASSERT_EQ(pair.step(), "") << name << ' ' << workers;
    }
  });
}

}  // namespace
}  // namespace throng
