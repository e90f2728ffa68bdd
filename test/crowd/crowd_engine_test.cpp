// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "crowd/walk/crowd_engine.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <barrier>
#include <cmath>
#include <cstring>
#include <span>
#include <string>
#include <thread>
#include <type_traits>
#include <utility>
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

// Engines of one crowd, a thread each, that own stripes of the plane and write to each other's
// boxes.
class Stripes {
 public:
  Stripes(std::vector<int32_t> borders, int32_t far)
      : borders_(std::move(borders)),
        far_(far),
        ranks_(borders_.size() + 1),
        together_(static_cast<ptrdiff_t>(ranks_)),
        bodies_(ranks_ * ranks_),
        moved_(ranks_ * ranks_),
        moves_(ranks_),
        accepted_(ranks_) {}

  [[nodiscard]] size_t ranks() const { return ranks_; }
  [[nodiscard]] size_t owner(const crowd::Body& body) const {
    return static_cast<size_t>(std::upper_bound(borders_.begin(), borders_.end(), body.x) -
                               borders_.begin());
  }
  [[nodiscard]] bool sees(size_t rank, const crowd::Body& body) const {
    return (rank == 0 || body.x >= borders_[rank - 1] - far_) &&
           (rank + 1 == ranks_ || body.x < borders_[rank] + far_);
  }

  class Exchange : public crowd::StepExchange {
   public:
    Exchange(Stripes& all, size_t rank) : all_(all), rank_(rank) {}
    uint64_t step = 0;
    uint64_t ghosts = 0;  // of all steps

    // Bodies that have left the stripe go to the engine that owns where they are.
    void migrate(crowd::CrowdEngine& engine) {
      for (size_t to = 0; to < all_.ranks_; ++to) box(all_.moved_, to).clear();
      const std::span<crowd::Body> bodies = engine.bodies();
      size_t kept = 0;
      for (size_t n = 0; n < bodies.size(); ++n) {
        const size_t to = all_.owner(bodies[n]);
        if (to == rank_) {
          bodies[kept++] = bodies[n];
        } else {
          box(all_.moved_, to).push_back({engine.ghost_of(n, step), engine.choice(bodies[n].slot)});
        }
      }
      engine.shrink(kept);
      all_.together_.arrive_and_wait();
      for (size_t from = 0; from < all_.ranks_; ++from) {
        if (from == rank_) continue;
        for (const auto& [ghost, choice] : all_.moved_[from * all_.ranks_ + rank_]) {
          engine.take_over(ghost, choice, step);
        }
      }
      all_.together_.arrive_and_wait();
    }

    std::span<const crowd::Ghost> exchange_bodies(crowd::CrowdEngine& engine) override {
      for (size_t to = 0; to < all_.ranks_; ++to) box(all_.bodies_, to).clear();
      for (size_t n = 0; n < engine.bodies().size(); ++n) {
        for (size_t to = 0; to < all_.ranks_; ++to) {
          if (to == rank_ || !all_.sees(to, engine.bodies()[n])) continue;
          engine.show_to_others(n);
          box(all_.bodies_, to).push_back(engine.ghost_of(n, step));
        }
      }
      return collect<crowd::Ghost>(
          [&](size_t from) { return std::span(all_.bodies_[from * all_.ranks_ + rank_]); },
          ghosts_);
    }
    std::span<const crowd::GhostMove> exchange_moves(
        std::span<const crowd::GhostMove> shown) override {
      all_.moves_[rank_].assign(shown.begin(), shown.end());
      return collect<crowd::GhostMove>([&](size_t from) { return std::span(all_.moves_[from]); },
                                       moves_);
    }
    std::span<const uint32_t> exchange_accepted(std::span<const uint32_t> shown) override {
      all_.accepted_[rank_].assign(shown.begin(), shown.end());
      return collect<uint32_t>([&](size_t from) { return std::span(all_.accepted_[from]); },
                               accepted_);
    }

   private:
    template <class Box>
    Box& box(std::vector<Box>& boxes, size_t to) {
      return boxes[rank_ * all_.ranks_ + to];
    }
    template <class T, class From>
    std::span<const T> collect(From from, std::vector<T>& into) {
      all_.together_.arrive_and_wait();
      into.clear();
      for (size_t other = 0; other < all_.ranks_; ++other) {
        if (other == rank_) continue;
        const auto box = from(other);
        into.insert(into.end(), box.begin(), box.end());
      }
      ghosts += std::is_same_v<T, crowd::Ghost> ? into.size() : 0;
      all_.together_.arrive_and_wait();
      return into;
    }

    Stripes& all_;
    size_t rank_;
    std::vector<crowd::Ghost> ghosts_;
    std::vector<crowd::GhostMove> moves_;
    std::vector<uint32_t> accepted_;
  };

 private:
  std::vector<int32_t> borders_;  // x, ascending [units]
  int32_t far_;                   // beyond its borders a stripe sees bodies [units]
  size_t ranks_;
  std::barrier<> together_;
  // From each to each, and from each to all.
  std::vector<std::vector<crowd::Ghost>> bodies_;
  std::vector<std::vector<std::pair<crowd::Ghost, steer::Plane>>> moved_;
  std::vector<std::vector<crowd::GhostMove>> moves_;
  std::vector<std::vector<uint32_t>> accepted_;
};

// Steps a crowd by one engine and by as many as there are stripes; all bodies are the same.
void expect_shared(const LevelGround& ground, const std::vector<test::PlainBody>& bodies,
                   const test::PlainConfig& config, const std::vector<int32_t>& borders, int steps,
                   const std::string& name) {
  Pair alone = ground.pair(bodies, config, 1);
  std::vector<Pair> shared;
  for (size_t rank = 0; rank <= borders.size(); ++rank) {
    shared.push_back(ground.pair(bodies, config, 1));
  }
  Stripes stripes(borders, alone.engine.sight());
  std::vector<Stripes::Exchange> exchanges;
  for (size_t rank = 0; rank < shared.size(); ++rank) {
    exchanges.emplace_back(stripes, rank);
    const std::span<crowd::Body> own = shared[rank].engine.bodies();
    const auto end = std::remove_if(own.begin(), own.end(), [&](const crowd::Body& body) {
      return stripes.owner(body) != rank;
    });
    shared[rank].engine.shrink(static_cast<size_t>(end - own.begin()));
  }
  const auto nothing = [](std::span<crowd::Body>, int32_t) {};
  for (int number = 0; number < steps; ++number) {
    crowd::EngineCounts counts;
    crowd::EngineTimes times;
    const auto step = static_cast<uint64_t>(number);
    alone.engine.step(step, nothing, counts, times);
    std::vector<std::thread> threads;
    for (size_t rank = 0; rank < shared.size(); ++rank) {
      threads.emplace_back([&, rank] {
        crowd::EngineCounts own_counts;
        crowd::EngineTimes own_times;
        exchanges[rank].step = step;
        exchanges[rank].migrate(shared[rank].engine);
        shared[rank].engine.step(step, nothing, own_counts, own_times, &exchanges[rank]);
      });
    }
    for (std::thread& thread : threads) thread.join();
    std::vector<const crowd::Body*> by_slot(bodies.size(), nullptr);
    for (const Pair& pair : shared) {
      for (const crowd::Body& body : pair.engine.bodies()) {
        ASSERT_EQ(by_slot[body.slot], nullptr) << name << ": two engines have " << body.slot;
        by_slot[body.slot] = &body;
      }
    }
    for (const crowd::Body& a : alone.engine.bodies()) {
      const crowd::Body* const b = by_slot[a.slot];
      ASSERT_NE(b, nullptr) << name << ": no engine has " << a.slot;
      ASSERT_EQ(std::memcmp(&a, b, sizeof a), 0)
          << name << ": body " << a.slot << " in step " << number;
    }
  }
  uint64_t ghosts = 0;
  for (const auto& exchange : exchanges) ghosts += exchange.ghosts;
  EXPECT_GT(ghosts, static_cast<uint64_t>(steps)) << name << ": there was nothing to share";
}

TEST(CrowdEngine, SharedByEnginesDoesWhatOneDoes) {
  const LevelGround ground(60);
  test::PlainConfig config;
  const test::Spot corner{config.to_units(15), config.to_units(15)};
  const auto at = [&](double x) { return config.to_units(x); };
  for (const bool queues : {false, true}) {
    config.queues = queues;
    config.acceleration = queues ? 4.0f : 0.0f;
    for (const double area : {4.0, 0.7}) {
      const double side = std::sqrt(300 * area);
      std::vector<test::PlainBody> bodies = scattered(config, 300, area, 8, corner);
      for (const std::vector<double>& shares : {std::vector<double>{0.5}, {0.2, 0.25, 0.5, 0.8}}) {
        std::vector<int32_t> borders;
        for (const double share : shares) borders.push_back(at(15 + share * side));
        const std::string name = std::to_string(queues) + ' ' + std::to_string(area) + ' ' +
                                 std::to_string(borders.size() + 1);
        expect_shared(ground, bodies, config, borders, 40, name);
      }
      for (size_t i = 0; i < bodies.size(); i += 3) bodies[i].goal = bodies[0].goal;
      expect_shared(ground, bodies, config, {at(15 + 0.5 * side)}, 60,
                    "one goal, " + std::to_string(queues) + ' ' + std::to_string(area));
    }
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
