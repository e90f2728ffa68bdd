// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "scenario/density_draw.h"
#include "scratch_folder.h"
#include "throng/picture.h"
#include "throng/scenario.h"

namespace throng {
namespace {

using Weights = std::vector<uint8_t>;

DensityMap day() {
  DensityMap map;
  map.x1 = 2;
  map.z1 = 1;
  map.width = 2;
  map.height = 1;
  map.weights = {7, 7};
  map.hours = {{100, {0, 200}}, {200, {100, 0}}, {400, {100, 50}}};
  return map;
}

TEST(DensityHours, AreBlendedBetweenTheTwoNearest) {
  const DensityMap map = day();
  EXPECT_EQ(scenario::weights_at(map, 0), (Weights{0, 200})) << "before the first";
  EXPECT_EQ(scenario::weights_at(map, 100), (Weights{0, 200}));
  EXPECT_EQ(scenario::weights_at(map, 125), (Weights{25, 150}));
  EXPECT_EQ(scenario::weights_at(map, 199.9), (Weights{100, 0})) << "rounded";
  EXPECT_EQ(scenario::weights_at(map, 300), (Weights{100, 25}));
  EXPECT_EQ(scenario::weights_at(map, 400), (Weights{100, 50}));
  EXPECT_EQ(scenario::weights_at(map, 1e9), (Weights{100, 50})) << "after the last";
  DensityMap still = map;
  still.hours.clear();
  EXPECT_EQ(scenario::weights_at(still, 150), (Weights{7, 7}));
}

TEST(DensityHours, BeginAgainAfterThePeriod) {
  DensityMap map = day();
  map.period = 600;
  // From 400 to 700, which is 100 of the next period.
  EXPECT_EQ(scenario::weights_at(map, 550), (Weights{50, 125}));
  EXPECT_EQ(scenario::weights_at(map, 0), (Weights{33, 150}));
  for (const double time : {0.0, 70.0, 125.0, 399.0, 599.0}) {
    EXPECT_EQ(scenario::weights_at(map, time), scenario::weights_at(map, time + 1200)) << time;
  }
  map.hours.resize(1);
  EXPECT_EQ(scenario::weights_at(map, 555), (Weights{0, 200}));
}

// A hall of 20 by 10 m whose west is full at first and its east a minute later.
std::string hall(const std::string& density) {
  return R"(seconds = 120
seed = 3
cell = 0.1
[plane]
floor = [[0, 0], [20, 0], [20, 10], [0, 10]]
[[density]]
name = "day"
box = [0, 0, 20, 10]
)" + density +
         R"(
[[source]]
name = "all"
density = "day"
begin = 0
end = 90
rate = 1
)";
}

void write_picture(const std::string& path, Weights greys) {
  Image image{.width = static_cast<int32_t>(greys.size()), .height = 1, .rgb = {}};
  for (const uint8_t grey : greys) image.rgb.insert(image.rgb.end(), 3, grey);
  ASSERT_TRUE(write_png(image, path));
}

TEST(DensityHours, AvatarsEnterWhereTheHourPutsThem) {
  const test::ScratchFolder folder;
  write_picture(folder.path() + "/west.png", {255, 0});
  write_picture(folder.path() + "/east.png", {0, 255});
  const auto scenario = parse_scenario(
      hall("images = [{ at = 10, image = \"west.png\" }, { at = 70, image = \"east.png\" }]"),
      folder.path() + "/day.toml");
  ASSERT_TRUE(scenario) << scenario.error().message;
  Context context;
  const auto world = open_world(*scenario, context);
  ASSERT_TRUE(world);
  auto simulation = Simulation::create(*world, *scenario, 2, context);
  ASSERT_TRUE(simulation) << simulation.error().message;
  std::vector<AvatarState> states;
  const auto east_of_last = [&] {
    int east = 0;
    const size_t before = states.size();
    simulation->read(states);
    for (size_t i = before; i < states.size(); ++i) east += states[i].position.x > 10 ? 1 : 0;
    return east;
  };
  const auto walk_until = [&](double time) {
    while (simulation->step()->time < time - 0.01) {
    }
  };
  walk_until(10);
  EXPECT_EQ(east_of_last(), 0);
  walk_until(70);
  const int blended = east_of_last();
  EXPECT_GT(blended, 15);
  EXPECT_LT(blended, 45);
  walk_until(72);
  east_of_last();
  const size_t before = states.size();
  walk_until(90);
  const auto east = static_cast<size_t>(east_of_last());
  EXPECT_EQ(east, states.size() - before);
  EXPECT_GT(states.size(), before + 10);
}

TEST(DensityHours, WhatMakesNoSenseIsRefusedByName) {
  const test::ScratchFolder folder;
  write_picture(folder.path() + "/a.png", {255, 0});
  write_picture(folder.path() + "/wide.png", {255, 0, 3});
  write_picture(folder.path() + "/black.png", {0, 0});
  const auto refuse = [&](const std::string& density, const std::string& word) {
    const auto scenario = parse_scenario(hall(density), folder.path() + "/day.toml");
    ASSERT_FALSE(scenario) << density;
    EXPECT_NE(scenario.error().message.find(word), std::string::npos) << scenario.error().message;
    EXPECT_NE(scenario.error().message.find("day.toml:"), std::string::npos);
  };
  refuse("images = []", "at least one");
  refuse("images = [{ at = 1 }]", "image");
  refuse("images = [{ at = 1, image = \"none.png\" }]", "none.png");
  refuse("images = [{ at = 5, image = \"a.png\" }, { at = 5, image = \"a.png\" }]", "order");
  refuse("images = [{ at = 5, image = \"a.png\" }, { at = 6, image = \"wide.png\" }]", "3 x 1");
  refuse("images = [{ at = 5, image = \"black.png\" }]", "black.png");
  refuse("period = 5\nimages = [{ at = 5, image = \"a.png\" }]", "less than the period");
  refuse("period = 5\nimage = \"a.png\"", "period");
  refuse("image = \"a.png\"\nimages = [{ at = 5, image = \"a.png\" }]", "one of");
  refuse("images = [{ at = 5, image = \"a.png\", weight = 3 }]", "weight");
}

}  // namespace
}  // namespace throng
