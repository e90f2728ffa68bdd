// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "scenario/attractors.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "throng/scenario.h"

namespace throng {
namespace {

// A square of 80 by 40 m on which 300 avatars stroll, and a jogger that runs back and forth in the
// north.
std::string square(const std::string& more) {
  return R"(seconds = 300
seed = 11
[plane]
floor = [[0, 0], [80, 0], [80, 40], [0, 40]]
[[area]]
name = "all"
box = [0.5, 0.5, 79.5, 39.5]
[[area]]
name = "west"
box = [8, 6, 10, 8]
[[area]]
name = "east"
box = [30, 6, 32, 8]
[[area]]
name = "pond"
box = [10, 10, 30, 14]
[[density]]
name = "map"
box = [0, 0, 80, 40]
paint = [{ area = "all", weight = 10 }, { area = "pond", weight = 0 }]
[[profile]]
name = "runner"
speed = 2
[[journey]]
name = "stroll"
repeat = true
stages = [{ density = "map" }]
[[journey]]
name = "run"
repeat = true
stages = [{ go = "west" }, { go = "east" }]
[[source]]
name = "walkers"
density = "map"
journey = "stroll"
count = 300
[[source]]
name = "jogger"
area = "west"
profile = "runner"
journey = "run"
count = 1
)" + more;
}

Scenario parsed(const std::string& text) {
  const auto scenario = parse_scenario(text, "square.toml");
  EXPECT_TRUE(scenario) << scenario.error().message;
  return scenario ? *scenario : Scenario{};
}

Simulation started(const Scenario& scenario, int32_t workers = 2) {
  Context context;
  const auto world = open_world(scenario, context);
  EXPECT_TRUE(world);
  auto made = Simulation::create(*world, scenario, workers, context);
  EXPECT_TRUE(made) << made.error().message;
  return *std::move(made);
}

// The jogger enters last.
uint64_t jogger_of(const Simulation& simulation) {
  for (const Trip& trip : simulation.trips()) {
    if (trip.source == 1) return trip.person;
  }
  return UINT64_MAX;
}

// Mean number of avatars within 10 m of a moving point, from 100 s on.
template <class Where>
double mean_near(Simulation& simulation, Where where) {
  std::vector<AvatarState> states;
  double sum = 0;
  int frames = 0;
  for (int step = 0; step < 2000; ++step) {
    EXPECT_TRUE(simulation.step());
    simulation.read(states);
    for (const AvatarState& s : states) {
      const bool in_pond =
          s.position.x > 10 && s.position.x < 30 && s.position.z > 10 && s.position.z < 14;
      EXPECT_FALSE(in_pond && s.id != jogger_of(simulation)) << "weight 0 stays 0";
    }
    if (step < 1000) continue;
    const Vec3d at = where(states);
    for (const AvatarState& s : states) {
      sum += std::hypot(s.position.x - at.x, s.position.z - at.z) < 10 ? 1 : 0;
    }
    ++frames;
  }
  return sum / frames;
}

TEST(Attractors, ACrowdIsDrawnToAJogger) {
  const auto near_jogger = [](const std::string& more) {
    Simulation simulation = started(parsed(square(more)));
    const auto number = static_cast<uint32_t>(jogger_of(simulation));
    return mean_near(simulation, [&](const std::vector<AvatarState>& states) {
      for (const AvatarState& s : states) {
        if (s.id == number) return s.position;
      }
      return Vec3d{};
    });
  };
  const double without = near_jogger("");
  const double with = near_jogger(
      "[[attractor]]\nname = \"a\"\ndensity = \"map\"\nsource = \"jogger\"\nradius = 12\n");
  EXPECT_GT(without, 10);
  EXPECT_GT(with, 2 * without);
}

TEST(Attractors, ACrowdIsDrawnToAMovingObstacle) {
  const std::string cart = R"([[obstacle]]
name = "float"
circle = [55, 20, 1]
line = [[55, 20], [70, 20], [70, 30]]
speed = 0.5
)";
  const auto near_cart = [&](const std::string& more) {
    Simulation simulation = started(parsed(square(cart + more)));
    double moved = 0;
    Vec3d last{55, 0, 20};
    const double mean = mean_near(simulation, [&](const std::vector<AvatarState>&) {
      const std::vector<Prism> there = simulation.crowd().obstacles();
      EXPECT_EQ(there.size(), 1U);
      Vec3d at;
      for (const auto& [x, z] : there[0].corners) {
        at.x += x / 32;
        at.z += z / 32;
      }
      moved += std::hypot(at.x - last.x, at.z - last.z);
      last = at;
      return at;
    });
    EXPECT_GT(moved, 3);  // It waits where the crowd that it draws stands before it.
    EXPECT_EQ(simulation.crowd().check().obstacle_entries, 0U);
    return mean;
  };
  const double without = near_cart("");
  const double with = near_cart(
      "[[attractor]]\nname = \"a\"\ndensity = \"map\"\nobstacle = \"float\"\nradius = 12\n");
  EXPECT_GT(with, 1.7 * without);
}

TEST(Attractors, AnyAvatarCanCarryOneWhileItRuns) {
  Simulation simulation = started(parsed(square("")));
  const uint64_t person = jogger_of(simulation);
  EXPECT_FALSE(simulation.attract("mop", person, 10, 255));
  EXPECT_FALSE(simulation.attract("map", 5000, 10, 255));
  EXPECT_FALSE(simulation.attract("map", person, 0, 255));
  EXPECT_FALSE(simulation.attract("map", person, NAN, 255));
  Simulation other = started(parsed(square("")), 1);
  ASSERT_TRUE(simulation.attract("map", person, 12, 255));
  ASSERT_TRUE(other.attract("map", person, 12, 255));
  for (int step = 0; step < 150; ++step) {
    ASSERT_TRUE(simulation.step());
    ASSERT_TRUE(other.step());
  }
  EXPECT_EQ(simulation.state_hash(), other.state_hash()) << "for any workers";
  ASSERT_TRUE(simulation.attract("map", person, 12, 0)) << "removed";
  for (int step = 0; step < 50; ++step) {
    ASSERT_TRUE(simulation.step());
    ASSERT_TRUE(other.step());
  }
  EXPECT_NE(simulation.state_hash(), other.state_hash());
}

TEST(Attractors, AnObstacleMovesAlongItsLineAndBack) {
  const ScenarioObstacle cart{.name = "cart",
                              .prism = Prism::box({9, 0, 9}, {11, 2, 11}),
                              .line = {{10, 10}, {14, 10}, {14, 13}}};
  const auto corner = [&](double distance) {
    return scenario::prism_after(cart, distance).corners[0];
  };
  using At = std::array<double, 2>;
  EXPECT_EQ(corner(0), (At{9, 9}));
  EXPECT_EQ(corner(3), (At{12, 9}));
  EXPECT_EQ(corner(6), (At{13, 11}));
  EXPECT_EQ(corner(7), (At{13, 12}));
  EXPECT_EQ(corner(9), (At{13, 10}));
  EXPECT_EQ(corner(14), (At{9, 9}));
  EXPECT_EQ(corner(17), (At{12, 9}));
}

TEST(Attractors, WhatMakesNoSenseIsRefusedByName) {
  const auto refuse = [](const std::string& more, const std::string& word) {
    const auto scenario = parse_scenario(square(more), "square.toml");
    ASSERT_FALSE(scenario) << more;
    EXPECT_NE(scenario.error().message.find(word), std::string::npos) << scenario.error().message;
  };
  const std::string head = "[[attractor]]\nname = \"a\"\n";
  refuse(head, "density");
  refuse(head + "density = \"map\"\n", "source");
  refuse(head + "density = \"mop\"\nsource = \"jogger\"\n", "mop");
  refuse(head + "density = \"map\"\nsource = \"nowhere\"\n", "nowhere");
  refuse(head + "density = \"map\"\nobstacle = \"float\"\n", "float");
  refuse(head + "density = \"map\"\nsource = \"jogger\"\nradius = 0\n", "radius");
  refuse(head + "density = \"map\"\nsource = \"jogger\"\nweight = 0\n", "weight");
  const std::string cart = "[[obstacle]]\nname = \"c\"\ncircle = [5, 5, 1]\n";
  refuse(cart + "speed = 1\n", "line");
  refuse(cart + "line = [[5, 5]]\n", "two points");
  refuse(cart + "line = [[5, 5], [9, 5]]\nspeed = 0\n", "speed");
  Scenario scenario = parsed(square(cart + "line = [[5, 5], [5, 5]]\n"));
  Context context;
  const auto world = open_world(scenario, context);
  const auto made = Simulation::create(*world, scenario, 1, context);
  ASSERT_FALSE(made);
  EXPECT_NE(made.error().message.find("'c'"), std::string::npos) << made.error().message;
}

}  // namespace
}  // namespace throng
