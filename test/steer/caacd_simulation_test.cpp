// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "core/random.h"
#include "throng/papers.h"

// The plane of [CAACD] section V: encounters walked through to their end, every change of activity,
// what counts as a collision, random spaces.
namespace throng::caacd {
namespace {

constexpr Fields kFields{5, 7.5, 12};

Model model_of(const ParameterSet& set, Trigger trigger = Trigger::kNear) {
  return {
      .mass = set.mass, .max_speed = set.max_speed, .max_force = set.max_force, .trigger = trigger};
}

// The paper's best set.
Model best(Trigger trigger = Trigger::kNear) { return model_of(named_sets()[2], trigger); }

void add(Space& space, Vec3d position, Vec3d forward, double speed, Vec3d target) {
  space.bodies.push_back({.position = position,
                          .velocity = forward * speed,
                          .forward = forward,
                          .fields = kFields,
                          .id = static_cast<uint32_t>(space.bodies.size())});
  space.targets.push_back(target);
}

Simulation made(const Space& space, const Model& model) {
  Result<Simulation> run = Simulation::create(space, model);
  EXPECT_TRUE(run) << run.error().message;
  return *std::move(run);
}

double distance(const Simulation& run, size_t i, size_t j) {
  return length(run.bodies()[i].position - run.bodies()[j].position);
}

// Steps until all stand, at most `frames`; returns the smallest distance of the first two bodies.
double walk(Simulation& run, int64_t frames = 5000) {
  double smallest = 1e9;
  while (!run.finished() && run.counts().frames < frames) {
    run.step();
    if (run.bodies().size() > 1) smallest = std::min(smallest, distance(run, 0, 1));
  }
  EXPECT_TRUE(run.finished());
  return smallest;
}

TEST(CaacdSimulation, OneAvatarTurnsToItsTargetBrakesAndStandsThere) {
  Space space;
  add(space, {0, 0, 0}, {-1, 0, 0}, 0.4, {100, 0, 0});
  Simulation run = made(space, best());
  std::vector<Activity> seen;
  double fastest = 0, last = 0, braking = 0;
  while (!run.finished() && run.counts().frames < 2000) {
    run.step();
    if (seen.empty() || seen.back() != run.activities()[0]) seen.push_back(run.activities()[0]);
    const double speed = length(run.bodies()[0].velocity);
    fastest = std::max(fastest, speed);
    if (run.activities()[0] == Activity::kArriving) braking = std::max(braking, speed - last);
    last = speed;
  }
  EXPECT_EQ(seen, (std::vector{Activity::kTravelling, Activity::kArriving, Activity::kArrived}));
  EXPECT_NEAR(fastest, 0.4, 1e-12);
  EXPECT_LT(braking, 1e-4);  // within psi it only slows down
  EXPECT_EQ(length(run.bodies()[0].velocity), 0);
  EXPECT_LE(length(run.bodies()[0].position - Vec3d{100, 0, 0}), 0.5);
  EXPECT_EQ(run.counts().arrived, 1);
  // Sent on, it goes on.
  ASSERT_TRUE(run.send(0, {0, 0, 0}));
  EXPECT_EQ(run.send(99, {0, 0, 0}).error().code, Errc::kNotFound);
  EXPECT_EQ(run.send(0, {0, 0, NAN}).error().code, Errc::kBadInput);
  EXPECT_FALSE(run.finished());
  walk(run, 4000);
  EXPECT_LE(length(run.bodies()[0].position), 0.5);
}

TEST(CaacdSimulation, TheTurnIsCurvilinearWithinTheForce) {
  Space space;
  add(space, {0, 0, 0}, {1, 0, 0}, 0.4, {0, 0, 60});
  Simulation run = made(space, best());
  double centripetal = 0;
  while (true) {
    const Body before = run.bodies()[0];
    run.step();
    if (run.finished()) break;
    const Vec3d change = run.bodies()[0].velocity - before.velocity;
    ASSERT_LE(length(change), 0.03 + 1e-12);  // max_force / mass
    centripetal = std::max(centripetal, curvilinear(before.forward, change).centripetal);
  }
  EXPECT_GT(centripetal, 0.02);
}

TEST(CaacdSimulation, HeadOnTheyPassOnTheRightWithoutACollision) {
  Space space;
  add(space, {0, 0, 0}, {1, 0, 0}, 0.4, {120, 0, 0});
  add(space, {120, 0, 0}, {-1, 0, 0}, 0.4, {0, 0, 0});
  Simulation run = made(space, best());
  double side = 0;
  bool avoided = false;
  while (!run.finished() && run.counts().frames < 3000) {
    run.step();
    if (std::fabs(run.bodies()[0].position.x - run.bodies()[1].position.x) < 0.5) {
      side = run.bodies()[0].position.z;
    }
    avoided |= run.activities()[0] == Activity::kAvoiding;
  }
  EXPECT_TRUE(run.finished());
  EXPECT_TRUE(avoided);
  EXPECT_GT(side, 2);  // +z is the right of +x
  EXPECT_EQ(run.counts().collisions, 0);
  EXPECT_EQ(run.counts().arrived, 2);
}

TEST(CaacdSimulation, WithoutAvoidanceTheSameMeetingIsOneCollision) {
  Space space;
  add(space, {0, 0, 0}, {1, 0, 0}, 0.4, {120, 0, 0});
  add(space, {120, 0, 0}, {-1, 0, 0}, 0.4, {0, 0, 0});
  Simulation run = made(space, best(Trigger::kNever));
  EXPECT_LT(walk(run), 1);
  EXPECT_EQ(run.counts().collisions, 1);
}

TEST(CaacdSimulation, OvertakingAndCrossingGoWithoutACollision) {
  // A fast body approaches from behind one that brakes to its target.
  Space overtaking;
  add(overtaking, {0, 0, 0}, {1, 0, 0}, 0.4, {150, 0, 0});
  add(overtaking, {26, 0, 0}, {1, 0, 0}, 0.4, {60, 0, 0});
  Simulation run = made(overtaking, best());
  EXPECT_GT(walk(run), 10);
  EXPECT_EQ(run.counts().collisions, 0);
  EXPECT_EQ(run.counts().arrived, 2);

  Space crossing;
  add(crossing, {-50, 0, 0}, {1, 0, 0}, 0.4, {50, 0, 0});
  add(crossing, {0, 0, -52}, {0, 0, 1}, 0.4, {0, 0, 50});
  run = made(crossing, best());
  EXPECT_GT(walk(run), 10);
  EXPECT_EQ(run.counts().collisions, 0);
  EXPECT_EQ(run.counts().arrived, 2);
}

TEST(CaacdSimulation, ParallelCoursesOutsideTheAlertFieldStayStraight) {
  Space space;
  add(space, {0, 0, 0}, {1, 0, 0}, 0.4, {100, 0, 0});
  add(space, {0, 0, 24.5}, {1, 0, 0}, 0.4, {100, 0, 24.5});
  Simulation run = made(space, best());
  walk(run);
  EXPECT_EQ(run.bodies()[0].position.z, 0);
  // In the alert field each pushes off; once they part neither is a threat, and both turn back.
  space.bodies[1].position.z = space.targets[1].z = 20;
  run = made(space, best());
  for (int i = 0; i < 150; ++i) {
    run.step();
    EXPECT_GT(distance(run, 0, 1), 20 - 1e-9);
  }
  EXPECT_LT(run.bodies()[0].position.z, -0.01);
  EXPECT_GT(run.bodies()[1].position.z, 20.01);
}

TEST(CaacdSimulation, BodiesAtOnePointPartAndStayFinite) {
  Space space;
  for (int i = 0; i < 4; ++i) add(space, {7, 0, 7}, {1, 0, 0}, 0, {80.0 + 30 * i, 0, 90});
  Simulation run = made(space, best());
  EXPECT_EQ(run.counts().collisions, 0);  // they began inside of each other
  walk(run);
  for (size_t i = 0; i < 4; ++i) {
    ASSERT_TRUE(std::isfinite(run.bodies()[i].position.x));
    for (size_t j = 0; j < i; ++j) EXPECT_GT(distance(run, i, j), 10);
  }
}

TEST(CaacdSimulation, AnObstacleIsWalkedAround) {
  Space space;
  add(space, {0, 0, 1}, {1, 0, 0}, 0.4, {160, 0, 0});
  space.obstacles = {{{80, 0, 0}, {15, 20, 30}}};
  Simulation run = made(space, best());
  double least = 1e9;
  while (!run.finished() && run.counts().frames < 3000) {
    run.step();
    least = std::min(least, length(run.bodies()[0].position - Vec3d{80, 0, 0}));
  }
  EXPECT_EQ(run.counts().arrived, 1);
  EXPECT_EQ(run.counts().obstacle_collisions, 0);
  EXPECT_GT(least, 20);  // 15 + 5
  Simulation blind = made(space, best(Trigger::kNever));
  walk(blind);
  EXPECT_EQ(blind.counts().obstacle_collisions, 1);
}

TEST(CaacdSimulation, ACollisionIsAnEntryOfAPair) {
  // A third body walks through two that stand: two entries, counted once each, and again on its
  // return.
  Space space;
  add(space, {50, 0, 0}, {1, 0, 0}, 0, {50, 0, 0});
  add(space, {90, 0, 0}, {1, 0, 0}, 0, {90, 0, 0});
  add(space, {0, 0, 0}, {1, 0, 0}, 0, {140, 0, 0});
  Simulation run = made(space, best(Trigger::kNever));
  walk(run);
  EXPECT_EQ(run.counts().collisions, 2);
  ASSERT_TRUE(run.send(2, {0, 0, 0}));
  walk(run);
  EXPECT_EQ(run.counts().collisions, 4);
}

// Checks that of two bodies with one target at most one is inside; returns the first.
int first_at(Simulation& run, Vec3d place) {
  int first = -1;
  while (!run.finished() && run.counts().frames < 5000) {
    run.step();
    int inside = 0;
    for (size_t i = 0; i < run.bodies().size(); ++i) {
      if (length(run.bodies()[i].position - place) > 5) continue;
      ++inside;
      if (first < 0) first = static_cast<int>(i);
    }
    EXPECT_LE(inside, 1) << "frame " << run.counts().frames;
  }
  return first;
}

TEST(CaacdSimulation, OfTwoWithOneTargetExactlyOneGoesFirstAndTheOtherWaits) {
  const Vec3d place{0, 0, 0};
  // From both sides, from one side, at a right angle; also at equal distances.
  const std::array<std::array<Vec3d, 2>, 4> starts{{{Vec3d{-100, 0, 0}, Vec3d{90, 0, 0}},
                                                    {Vec3d{-100, 0, 0}, Vec3d{-70, 0, 3}},
                                                    {Vec3d{-80, 0, 0}, Vec3d{0, 0, -95}},
                                                    {Vec3d{-80, 0, 0}, Vec3d{80, 0, 0}}}};
  for (const auto& start : starts) {
    Space space;
    for (const Vec3d& from : start) {
      add(space, from, heading_of(place - from, {1, 0, 0}), 0.4, place);
    }
    Simulation run = made(space, best());
    const int first = first_at(run, place);
    ASSERT_GE(first, 0);
    const auto other = static_cast<size_t>(1 - first);
    EXPECT_EQ(run.counts().arrived, 1);
    EXPECT_EQ(run.counts().waiting, 1);
    EXPECT_EQ(run.activities()[static_cast<size_t>(first)], Activity::kArrived);
    EXPECT_EQ(run.activities()[other], Activity::kWaiting);
    EXPECT_GT(length(run.bodies()[other].position - place), 10);
    EXPECT_EQ(run.counts().collisions, 0);
    // The first one leaves: the other follows.
    ASSERT_TRUE(run.send(static_cast<uint32_t>(first), {0, 0, 120}));
    walk(run);
    EXPECT_EQ(run.counts().arrived, 2);
    EXPECT_LE(length(run.bodies()[other].position - place), 0.5);
  }
}

TEST(CaacdSimulation, OfTwoThatAreBothNearTheNearerOneGoesFirstWhateverItsId) {
  for (const double farther : {0, 1}) {
    Space space;
    for (const double from : {0, 1}) {
      const double x = from == farther ? -26 : 22;
      add(space, {x, 0, 0}, {x < 0 ? 1.0 : -1.0, 0, 0}, 0.4, {0, 0, 0});
    }
    Simulation run = made(space, best());
    EXPECT_EQ(first_at(run, {0, 0, 0}), farther == 0 ? 1 : 0);
  }
}

TEST(CaacdSimulation, NoBodyBrakesForAPlaceWithoutAReservation) {
  Space space;
  add(space, {-100, 0, 0}, {1, 0, 0}, 0.4, {0, 0, 0});
  add(space, {900, 0, 0}, {-1, 0, 0}, 0.4, {0, 0, 0});
  Simulation run = made(space, best());
  while (run.bodies()[0].position.x < -30.5) {
    run.step();
    ASSERT_NEAR(length(run.bodies()[0].velocity), 0.4, 1e-9) << run.counts().frames;
  }
}

TEST(CaacdSimulation, EveryChangeOfActivityHappensAndNoOther) {
  using enum Activity;
  std::set<std::pair<Activity, Activity>> seen;
  for (uint64_t seed = 1; seed <= 12; ++seed) {
    auto space = random_space({.avatars = 70, .side = 300, .obstacles = 3, .seed = seed}, best());
    ASSERT_TRUE(space) << space.error().message;
    Simulation run = made(*space, best());
    std::vector<Activity> before(70, kTravelling);
    for (int i = 0; i < 1500; ++i) {
      run.step();
      for (uint32_t k = 0; k < 70; ++k) {
        const Activity now = run.activities()[k];
        if (now != before[k]) seen.insert({before[k], now});
        before[k] = now;
        // Bodies that have arrived leave now and then.
        if (now == kArrived && random_below(seed, i, k, 40) == 0) {
          const double x = 300 * random_unit(seed, i, 100 + k);
          const double z = 300 * random_unit(seed, i, 200 + k);
          ASSERT_TRUE(run.send(k, {x, 0, z}));
        }
      }
    }
  }
  const std::set<std::pair<Activity, Activity>> wanted = {
      {kTravelling, kAvoiding}, {kTravelling, kArriving}, {kTravelling, kWaiting},
      {kAvoiding, kTravelling}, {kAvoiding, kArriving},   {kAvoiding, kWaiting},
      {kAvoiding, kArrived},    {kArriving, kAvoiding},   {kArriving, kArrived},
      {kArriving, kTravelling}, {kWaiting, kAvoiding},    {kWaiting, kArriving},
      {kWaiting, kTravelling},  {kArrived, kTravelling},  {kArrived, kAvoiding},
      {kArrived, kArriving},    {kArrived, kWaiting},
  };
  for (const auto& change : seen) {
    EXPECT_TRUE(wanted.contains(change))
        << static_cast<int>(change.first) << " to " << static_cast<int>(change.second);
  }
  for (const auto& change : wanted) {
    EXPECT_TRUE(seen.contains(change))
        << static_cast<int>(change.first) << " to " << static_cast<int>(change.second);
  }
}

TEST(CaacdSimulation, RandomSpacesKeepTheirDistancesAndTheirPlaces) {
  for (uint64_t seed = 1; seed <= 40; ++seed) {
    const SpaceConfig config{.avatars = 60, .seed = seed};
    const auto space = random_space(config, best());
    ASSERT_TRUE(space) << space.error().message;
    ASSERT_EQ(space->bodies.size(), 60u);
    ASSERT_EQ(space->targets.size(), 60u);
    ASSERT_EQ(space->obstacles.size(), 6u);
    for (size_t i = 0; i < 60; ++i) {
      const Body& b = space->bodies[i];
      EXPECT_EQ(b.id, i);
      EXPECT_NEAR(length(b.forward), 1, 1e-12);
      EXPECT_LE(length(b.velocity), 0.4);
      EXPECT_GE(dot(b.velocity, b.forward), 0);
      for (const Obstacle& o : space->obstacles) {
        EXPECT_GT(length(b.position - o.position), o.fields.alert);
        EXPECT_GT(length(space->targets[i] - o.position), o.fields.alert);
      }
      for (size_t j = 0; j < i; ++j) {
        EXPECT_GT(length(b.position - space->bodies[j].position), 15);
      }
    }
    // One more avatar or another model does not change the places.
    SpaceConfig more = config;
    more.avatars = 61;
    const auto other = random_space(more, model_of({1, 1.2, 0.2}));
    ASSERT_TRUE(other);
    for (size_t i = 0; i < 60; ++i) {
      EXPECT_EQ(space->bodies[i].position, other->bodies[i].position);
      EXPECT_EQ(space->targets[i], other->targets[i]);
      EXPECT_EQ(space->bodies[i].forward, other->bodies[i].forward);
    }
  }
}

// The oracle looks at all pairs, without the radius beyond which the step looks at none.
TEST(CaacdSimulation, ThreatsAreTheGreatestOfEachAvatarBeforeTheStep) {
  const Model model = best();
  const auto space = random_space({.avatars = 70, .side = 300, .obstacles = 3, .seed = 4}, model);
  ASSERT_TRUE(space) << space.error().message;
  Simulation run = made(*space, model);
  const auto is_none = [](const Threat& threat) { return threat.state == State::kTolerable; };
  ASSERT_EQ(run.threats().size(), 70u);
  EXPECT_TRUE(std::ranges::all_of(run.threats(), is_none));
  uint64_t of_bodies = 0, of_obstacles = 0, critical = 0, of_arrived = 0;
  for (int frame = 0; frame < 600; ++frame) {
    const std::vector<Body> bodies(run.bodies().begin(), run.bodies().end());
    const std::vector<Activity> before(run.activities().begin(), run.activities().end());
    run.step();
    for (size_t i = 0; i < bodies.size(); ++i) {
      Threat greatest;
      const auto consider = [&](const Threat& threat) {
        if (!is_none(threat) && more_urgent(threat, greatest)) greatest = threat;
      };
      for (size_t j = 0; j < bodies.size(); ++j) {
        if (j != i) consider(threat_of(bodies[i], bodies[j], model));
      }
      for (const Obstacle& obstacle : run.obstacles()) {
        consider(threat_of(bodies[i], obstacle, model));
      }
      if (before[i] == Activity::kArrived) greatest = {};
      const Threat& threat = run.threats()[i];
      ASSERT_EQ(threat.state, greatest.state) << frame << ", " << i;
      ASSERT_EQ(threat.id, greatest.id) << frame << ", " << i;
      ASSERT_EQ(threat.time, greatest.time);
      ASSERT_EQ(threat.distance, greatest.distance);
      ASSERT_EQ(threat.other_then, greatest.other_then);
      critical += threat.state == State::kCritical ? 1 : 0;
      of_arrived += before[i] == Activity::kArrived ? 1 : 0;
      if (is_none(threat)) continue;
      ++(threat.id == Threat::kObstacle ? of_obstacles : of_bodies);
    }
  }
  EXPECT_GT(of_bodies, 100u);
  EXPECT_GT(of_obstacles, 10u);
  EXPECT_GT(critical, 10u);
  EXPECT_GT(of_arrived, 100u);
}

TEST(CaacdSimulation, BadSpacesAreRefused) {
  const auto refused = [](const SpaceConfig& config) {
    const auto space = random_space(config, {});
    return space ? Errc::kOk : space.error().code;
  };
  EXPECT_EQ(refused({.avatars = 0}), Errc::kBadConfig);
  EXPECT_EQ(refused({.side = NAN}), Errc::kBadConfig);
  EXPECT_EQ(refused({.fields = {5, 4, 10}}), Errc::kBadConfig);
  EXPECT_EQ(refused({.min_obstacle = 9, .largest_obstacle = 8}), Errc::kBadConfig);
  EXPECT_EQ(refused({.avatars = 100, .side = 60, .obstacles = 0}), Errc::kLimit);
  EXPECT_EQ(refused({.avatars = 5, .side = 60, .obstacles = 1}), Errc::kLimit);
  Space space;
  add(space, {0, 0, 0}, {1, 0, 0}, 0, {1, 0, 0});
  EXPECT_FALSE(Simulation::create(space, {}, 0));
  EXPECT_FALSE(Simulation::create(space, {.mass = -1}));
  space.bodies[0].position.x = NAN;
  EXPECT_FALSE(Simulation::create(space, {}));
  space.bodies[0].position.x = 0;
  space.bodies[0].id = 3;
  EXPECT_FALSE(Simulation::create(space, {}));
  space.bodies[0].id = 0;
  space.targets.clear();
  EXPECT_FALSE(Simulation::create(space, {}));
  EXPECT_TRUE(Simulation::create({}, {})->finished());
}

TEST(CaacdSimulation, AnySpaceStaysFiniteAndWithinTheSpeed) {
  // Crowded, coincident, with huge forces, long frames and tiny masses.
  for (uint64_t seed = 1; seed <= 60; ++seed) {
    Space space;
    for (uint64_t i = 0; i < 12; ++i) {
      const auto grid = [&](uint64_t k) {
        return 4.0 * static_cast<double>(random_below(seed, i, k, 6));
      };
      add(space, {grid(0), 0, grid(1)}, {1, 0, 0}, grid(2), {grid(3), 0, grid(4)});
    }
    space.obstacles = {{{10, 0, 10}, {3, 4, 5}}};
    const auto trigger = static_cast<Trigger>(1 + seed % 3);
    Model model{.mass = seed % 2 == 0 ? 1e-6 : 2, .max_speed = 1.2, .max_force = 1e3};
    model.trigger = trigger;
    auto run = Simulation::create(space, model, seed % 5 == 0 ? 100 : 1);
    ASSERT_TRUE(run);
    Simulation walked = *std::move(run);
    for (int i = 0; i < 200; ++i) walked.step();
    for (const Body& body : walked.bodies()) {
      ASSERT_LT(std::fabs(body.position.x), 1e6) << seed;
      ASSERT_LT(std::fabs(body.position.z), 1e6) << seed;
      ASSERT_LE(length(body.velocity), 1.2 + 1e-12);
      ASSERT_NEAR(length(body.forward), 1, 1e-9);
      ASSERT_EQ(body.position.y, 0);
    }
  }
}

TEST(CaacdSimulation, AnAvatarMayHaveAMassASpeedAndAForceOfItsOwn) {
  Space space;
  add(space, {0, 0, 0}, {1, 0, 0}, 0.4, {200, 0, 0});
  add(space, {0, 0, 100}, {1, 0, 0}, 0.4, {200, 0, 100});
  Simulation run = made(space, best());
  const ParameterSet fast{1, 1.2, 0.06};
  ASSERT_TRUE(run.set_parameters(1, fast));
  EXPECT_EQ(run.parameters(0), named_sets()[2]);
  EXPECT_EQ(run.parameters(1), fast);
  EXPECT_EQ(run.set_parameters(2, fast).error().code, Errc::kNotFound);
  EXPECT_EQ(run.set_parameters(0, {0, 1, 1}).error().code, Errc::kBadConfig);
  for (int frame = 0; frame < 100; ++frame) run.step();
  EXPECT_NEAR(length(run.bodies()[0].velocity), 0.4, 1e-9);
  EXPECT_NEAR(length(run.bodies()[1].velocity), 1.2, 1e-9);
  walk(run);
  EXPECT_EQ(run.counts().arrived, 2);
}

TEST(CaacdSimulation, TheValuesOfTheModelGivenToEachChangeNothing) {
  const Model model = best(Trigger::kThreat);
  const auto space = random_space({.avatars = 30}, model);
  ASSERT_TRUE(space);
  Simulation run = made(*space, model), twin = made(*space, model);
  for (uint32_t id = 0; id < 30; ++id) ASSERT_TRUE(run.set_parameters(id, named_sets()[2]));
  for (int frame = 0; frame < 300; ++frame) {
    run.step();
    twin.step();
  }
  EXPECT_EQ(run.state_hash(), twin.state_hash());
}

}  // namespace
}  // namespace throng::caacd
