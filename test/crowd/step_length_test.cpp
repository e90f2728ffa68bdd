// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include "baked.h"
#include "crowds.h"
#include "throng/crowd.h"
#include "throng/papers.h"
#include "throng/recording.h"
#include "throng/scenario.h"
#include "worlds.h"

namespace throng {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kLengths[] = {0,    -1,    1e-300, 1e-20,  1e-9,  1e-6,      9e-4,
                               1e-3, 1e-2,  0.5,    1,      1.001, 10,        1e3,
                               1e9,  1e300, -0.0,   5e-324, NAN,   kInfinity, -kInfinity};

World open_ground(double cell) {
  Scene scene;
  scene.positions = {{0, 0, 0}, {0, 0, 100}, {100, 0, 100}, {100, 0, 0}};
  scene.triangles = {{0, 1, 2}, {0, 2, 3}};
  return test::bake(scene, cell, {AvatarClass{}});
}

// An avatar that heads to a place far along a line that is not along an axis.
std::pair<Crowd, AvatarId> walker(const World& world, double dt, double speed,
                                  double acceleration = 0) {
  auto crowd =
      Crowd::create(world, {.dt = dt, .workers = 1, .tuning = {.acceleration = acceleration}});
  EXPECT_TRUE(crowd) << crowd.error().message;
  Context context;
  const auto ids = crowd->add(
      std::vector<AvatarSpawn>{{.place = world.find_place(0, {5.3, 0, 40.2}, 1), .speed = speed}},
      context);
  EXPECT_TRUE(ids) << ids.error().message;
  crowd->set_goals(*ids, std::vector<Place>{world.find_place(0, {95, 0, 60.2}, 1)});
  return {std::move(*crowd), (*ids)[0]};
}

TEST(StepLength, EveryLengthIsRefusedWithASentenceOrWalked) {
  const World world = open_ground(0.25);
  int walked = 0;
  for (const double dt : kLengths) {
    SCOPED_TRACE(testing::Message() << "dt " << dt);
    auto crowd = Crowd::create(world, {.dt = dt, .workers = 1});
    EXPECT_EQ(static_cast<bool>(crowd), dt >= 1e-3 && dt <= 1);
    if (!crowd) {
      EXPECT_EQ(crowd.error().message, "crowd: dt must be 0.001 to 1 s");
    } else {
      auto [one, id] = walker(world, dt, 0);
      const Vec3d from = one.read(id)->position;
      for (int i = 0; i < 50; ++i) one.step();
      const Vec3d to = one.read(id)->position;
      EXPECT_NEAR(std::hypot(to.x - from.x, to.z - from.z), 50 * dt * 1.34, 0.02 + 0.67 * dt);
      ++walked;
    }
    auto wanderers = Wanderers::create(world, {.avatars = 3, .dt = dt});
    if (!wanderers) {
      EXPECT_NE(wanderers.error().message.find("dt"), std::string::npos);
    } else {
      for (int i = 0; i < 5; ++i) EXPECT_GT(wanderers->step().moved, 0u);
    }
    EXPECT_EQ(static_cast<bool>(caacd::Simulation::create({}, {}, dt)), dt >= 1e-3 && dt <= 1e3);
    const std::string file =
        (std::filesystem::temp_directory_path() / "throng_step_length.replay").string();
    RecordingInfo info;
    info.dt = dt;
    info.classes.emplace_back();
    auto recorder = Recorder::create(file, info);
    EXPECT_EQ(static_cast<bool>(recorder), dt >= 1e-6 && dt <= 1e6);
    if (recorder) {
      EXPECT_TRUE(recorder->finish());
    }
    std::filesystem::remove(file);
    Scenario scenario;
    scenario.dt = dt;
    Context context;
    auto simulation = Simulation::create(world, scenario, 1, context);
    EXPECT_EQ(static_cast<bool>(simulation), dt >= 1e-3 && dt <= 1);
    if (simulation) {
      EXPECT_TRUE(simulation->step());
    }
  }
  EXPECT_EQ(walked, 4);
}

constexpr double kStepLengths[] = {0.001, 0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1};  // [s]
constexpr double kWalkSpeeds[] = {0.05, 0.1, 0.5, 1.3, 1.34, 5, 20};            // [m/s]

// About 60 m, or as far as 2000 steps lead.
int steps_for(double dt, double speed) {
  return static_cast<int>(std::clamp(60 / (speed * dt), 3.0, 2000.0));
}

TEST(StepLength, AvatarsMoveAsFarAsTheirSpeedRequires) {
  for (const double cell : {0.1, 0.25, 0.5, 1.0}) {
    const World world = open_ground(cell);
    for (const double dt : kStepLengths) {
      for (const double speed : kWalkSpeeds) {
        SCOPED_TRACE(testing::Message() << "cell " << cell << " dt " << dt << " speed " << speed);
        auto [crowd, id] = walker(world, dt, speed);
        const int steps = steps_for(dt, speed);
        const Vec3d from = crowd.read(id)->position;
        for (int i = 0; i < steps; ++i) crowd.step();
        const Vec3d to = crowd.read(id)->position;
        const double whole = steps * dt * speed;
        // Of the shortest of these walks 1 % is less than what a move is rounded by.
        const double rounded = 3 * cell / 2048;
        EXPECT_NEAR(std::hypot(to.x - from.x, to.z - from.z), whole,
                    std::max(0.01 * whole, rounded));
      }
    }
  }
}

// Also those whose velocity changes by far less in a step than a move is rounded by.
TEST(StepLength, AvatarsThatAccelerateReachTheirSpeedAndKeepIt) {
  for (const double cell : {0.1, 1.0}) {
    const World world = open_ground(cell);
    for (const double dt : kStepLengths) {
      for (const double speed : {0.05, 0.5, 1.34, 5.0}) {
        SCOPED_TRACE(testing::Message() << "cell " << cell << " dt " << dt << " speed " << speed);
        auto [crowd, id] = walker(world, dt, speed, 4);
        const auto walk = [&, &crowd = crowd, id = id](double seconds) {
          const Vec3d from = crowd.read(id)->position;
          const auto steps = static_cast<int>(std::ceil(seconds / dt - 1e-9));
          for (int i = 0; i < steps; ++i) crowd.step();
          const Vec3d to = crowd.read(id)->position;
          return std::hypot(to.x - from.x, to.z - from.z) / (steps * dt);
        };
        const double first = walk(std::max(dt, 0.5 * speed / 4));
        // Half of it, and what is rounded.
        EXPECT_LT(first, dt < 0.1 * speed ? 0.5 * speed + 3 * cell / 2048 / dt : 1.1 * speed);
        walk(speed / 4 + 0.5);
        EXPECT_NEAR(walk(4), speed, std::max(0.01 * speed, cell / 2048));
      }
    }
  }
}

// A wall behind the goal slows down fast avatars no more than others: they stop as quickly.
TEST(StepLength, FastAvatarsReachGoalsBesideWalls) {
  const World world = test::bake(worlds::flat(20), 0.1);
  for (const double dt : {0.05, 0.1, 0.5, 1.0}) {
    for (const double speed : {2.5, 5.0, 20.0, 50.0, 99.0}) {
      SCOPED_TRACE(testing::Message() << "dt " << dt << " speed " << speed);
      Crowd crowd = made(world, {.dt = dt, .workers = 1});
      const AvatarId id = added(crowd, world.find_place(0, {3, 0, 9}, 1), {.speed = speed});
      const Place goal = world.find_place(0, {19.6, 0, 10}, 1);
      ASSERT_TRUE(goal);
      crowd.set_goals({&id, 1}, {&goal, 1});
      // It begins and ends slowly; the last steps, before the wall, are slower, too.
      const double acceleration = CrowdTuning{}.acceleration;
      const double fastest = std::min(speed, std::sqrt(17 * acceleration));
      const double whole = 17 / fastest + fastest / acceleration;
      const auto steps = static_cast<int>(std::ceil((whole + 1) / dt));
      bool arrives = false;
      for (int i = 0; i < steps && !arrives; ++i) {
        crowd.step();
        arrives = !crowd.arrived().empty();
      }
      EXPECT_TRUE(arrives);
      EXPECT_EQ(crowd.check().wall_entries, 0u);
    }
  }
}

TEST(StepLength, SpeedsAndRadiiThatStepsCannotBeDividedForAreRefusedByName) {
  const World world = open_ground(0.25);
  Crowd crowd = made(world, {.dt = 1, .workers = 1});
  Context context;
  const auto add = [&](double radius, double speed) {
    const AvatarSpawn spawn{
        .place = world.find_place(0, {50, 0, 50}, 1), .radius = radius, .speed = speed};
    const auto ids = crowd.add({&spawn, 1}, context);
    return ids ? std::string() : ids.error().message;
  };
  EXPECT_NE(add(0.015, 20).find("take shorter steps"), std::string::npos);
  EXPECT_NE(add(0, 101).find("speed must be"), std::string::npos);
  EXPECT_EQ(add(0.02, 20), "");
}

// Externally controlled avatars, which could walk faster, on open ground.
TEST(StepLength, AnExternallyControlledAvatarIsWithinAUnitOfWhereItsVelocitiesLead) {
  for (const double cell : {0.1, 1.0}) {
    const World world = open_ground(cell);
    for (const double dt : kStepLengths) {
      for (const double speed : {0.05, 0.5, 1.3, 3.16, 4.9}) {
        for (const double turn : {0.0, 0.3}) {  // by each step
          SCOPED_TRACE(testing::Message() << "cell " << cell << " dt " << dt << " speed " << speed
                                          << " turn " << turn);
          Crowd crowd = made(world, {.dt = dt, .workers = 1});
          const AvatarId id = added(crowd, world.find_place(0, {40.3, 0, 50.2}, 1), {.speed = 5});
          const Vec3d from = crowd.read(id)->position;
          const int steps = std::min(2000, static_cast<int>(30 / (speed * dt)));
          double x = 0, z = 0;  // where they lead
          for (int i = 0; i < steps; ++i) {
            const double angle = 0.35 + turn * i;
            const Vec3d velocity{speed * std::cos(angle), 0, speed * std::sin(angle)};
            crowd.set_velocities({&id, 1}, {&velocity, 1});
            crowd.step();
            x += velocity.x * dt;
            z += velocity.z * dt;
            const Vec3d at = crowd.read(id)->position;
            ASSERT_LE(std::hypot(at.x - from.x - x, at.z - from.z - z), cell / 2048) << i;
            if (turn == 0) {
              ASSERT_LE(std::hypot(at.x - from.x, at.z - from.z),
                        speed * dt * (i + 1) + cell / 2048);
            }
          }
        }
      }
    }
  }
}

// Whatever it avoids, and whichever model steers it.
TEST(StepLength, AnExternallyControlledAvatarIsNeverFasterThanItWasGiven) {
  const World world = test::bake(worlds::flat(16), 0.1);
  constexpr double kUnit = 0.1 / 2048;
  for (const SteeringModel model :
       {SteeringModel::kSampled, SteeringModel::kCurvilinear, SteeringModel::kSocialForce}) {
    int turned = 0;  // moves that are not the given ones
    for (const double speed : {0.0, 0.4, 3.16}) {
      SCOPED_TRACE(testing::Message() << name_of(model) << " speed " << speed);
      Crowd crowd = made(world, {.workers = 1, .model = model});
      const AvatarId id = added(crowd, world.find_place(0, {2, 0, 8}, 1), {.speed = 5});
      const auto others = scattered(crowd, 60);
      crowd.set_goals(others, std::vector<Place>(60, world.find_place(0, {2, 0, 8}, 1)));
      Vec3d before = crowd.read(id)->position;
      for (int i = 0; i < 100; ++i) {
        const Vec3d velocity{speed * (i < 50 ? 0.8 : -0.8), 0, speed * 0.6};
        crowd.set_velocities({&id, 1}, {&velocity, 1});
        crowd.step();
        const Vec3d at = crowd.read(id)->position;
        // And what the moves of the sub-steps are rounded by.
        ASSERT_LE(std::hypot(at.x - before.x, at.z - before.z), speed * 0.1 + 3 * kUnit) << i;
        const double off = (at.x - before.x) * velocity.z - (at.z - before.z) * velocity.x;
        turned += std::fabs(off) > 0.1 * speed * speed * 0.1 ? 1 : 0;
        before = at;
      }
    }
    EXPECT_GT(turned, 0) << name_of(model) << ": it met none";
  }
}

// Moves of few units, each rounded up or down, of avatars that press against each other.
TEST(StepLength, ShortMovesNeverOverlap) {
  const World world = open_ground(1);
  Crowd crowd = made(world, {.dt = 0.001, .workers = 2});
  std::vector<AvatarSpawn> spawns;
  for (int i = 0; i < 64; ++i) {
    const Vec3d at{46.5 + 0.9 * (i % 8), 0, 46.5 + 0.9 * (i / 8)};
    spawns.push_back({.place = world.find_place(0, at, 1), .speed = 0.4 + 0.05 * i});
  }
  Context context;
  const auto ids = crowd.add(spawns, context);
  ASSERT_TRUE(ids) << ids.error().message;
  // Each to the place of the one opposite: all press inwards.
  std::vector<Place> goals;
  for (size_t i = 0; i < 64; ++i) goals.push_back(spawns[63 - i].place);
  crowd.set_goals(*ids, goals);
  // A quarter is externally controlled, towards the middle.
  for (size_t i = 0; i < 64; i += 4) {
    const Vec3d at = crowd.read((*ids)[i])->position, to{50 - at.x, 0, 50 - at.z};
    crowd.set_velocities({&(*ids)[i], 1}, {&to, 1});
  }
  uint64_t moved = 0;
  for (int i = 0; i < 1500; ++i) {
    const CrowdReport report = crowd.step();
    moved += report.avatars - report.stood;
    const CrowdCheck found = crowd.check();
    ASSERT_EQ(found.overlaps + found.wall_entries, 0u) << i;
  }
  EXPECT_GT(moved, 200u);
}

TEST(StepLength, WanderersWhoseStepsAreTooShortToBeExactAreRefused) {
  const World world = open_ground(0.25);
  const auto slow = Wanderers::create(world, {.avatars = 1, .dt = 0.1, .speed = 1e-3});
  ASSERT_FALSE(slow);
  EXPECT_EQ(slow.error().code, Errc::kBadConfig);
  EXPECT_NE(slow.error().message.find("take longer steps"), std::string::npos);
  EXPECT_TRUE(Wanderers::create(world, {.avatars = 1, .dt = 0.1, .speed = 0.1}));
}

TEST(StepLength, TimesThatAreDividedByItAreBounded) {
  const World world = open_ground(0.25);
  for (const double seconds : {-1.0, 1e300, double{NAN}, kInfinity}) {
    EXPECT_FALSE(Crowd::create(world, {.tuning = {.no_progress_after = seconds}})) << seconds;
  }
  EXPECT_TRUE(Crowd::create(world, {.dt = 1e-3, .tuning = {.no_progress_after = 1e6}}));
}

}  // namespace
}  // namespace throng
