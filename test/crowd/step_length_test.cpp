// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include "baked.h"
#include "throng/crowd.h"
#include "throng/papers.h"
#include "throng/recording.h"
#include "throng/scenario.h"

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
std::pair<Crowd, AvatarId> walker(const World& world, double dt, double speed) {
  auto crowd = Crowd::create(world, {.dt = dt, .workers = 1});
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

TEST(StepLength, SlowAvatarsInShortStepsMoveAsFarAsTheirSpeedRequires) {
  for (const double cell : {0.1, 0.25, 0.5, 1.0}) {
    const World world = open_ground(cell);
    for (const double dt : {0.1, 0.01, 0.001}) {
      for (const double speed : {0.1, 0.5, 1.34}) {
        SCOPED_TRACE(testing::Message() << "cell " << cell << " dt " << dt << " speed " << speed);
        auto [crowd, id] = walker(world, dt, speed);
        const int steps = dt < 0.01 ? 4000 : static_cast<int>(10 / dt);
        const Vec3d from = crowd.read(id)->position;
        for (int i = 0; i < steps; ++i) crowd.step();
        const Vec3d to = crowd.read(id)->position;
        const double whole = steps * dt * speed;
        EXPECT_NEAR(std::hypot(to.x - from.x, to.z - from.z), whole, 0.015 * whole + 0.02);
      }
    }
  }
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
