// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "throng/scenario.h"

namespace throng {
namespace {

// Two rooms with a door of 1.2 m between them.
const std::string kRooms = R"(seconds = 300
[plane]
floor = [[0, 0], [20, 0], [20, 10], [0, 10]]
obstacles = [
  [[10, 0], [10.2, 0], [10.2, 4.4], [10, 4.4]],
  [[10, 5.6], [10.2, 5.6], [10.2, 10], [10, 10]]]
[[area]]
name = "a"
box = [1, 1, 4, 9]
[[area]]
name = "b"
box = [16, 1, 19, 9]
[[queue]]
name = "q"
line = [[18, 0, 5], [12, 0, 5]]
service = 0.5
[[source]]
name = "s"
area = "a"
journey = "j"
count = 10
)";

const std::string kQueue =
    "[[journey]]\nname = \"j\"\nstages = [{queue = \"q\"}, {leave = \"b\"}]\n";

std::string obstacle(const std::string& box, const std::string& times) {
  return "[[obstacle]]\nname = \"o" + box.substr(0, 5) + "\"\nbox = [" + box + "]\n" + times + "\n";
}

struct Rooms {
  explicit Rooms(const std::string& text) {
    auto scenario = parse_scenario(kRooms + text, "rooms.toml");
    EXPECT_TRUE(scenario) << scenario.error().message;
    Context context;
    auto world = open_world(*scenario, context);
    EXPECT_TRUE(world) << world.error().message;
    auto made = Simulation::create(*world, *scenario, 1, context);
    EXPECT_TRUE(made) << made.error().message;
    simulation.emplace(std::move(*made));
  }
  // Steps until it is over or the time is reached. Returns how many have left.
  uint64_t until(double time) {
    SimulationReport last;
    do {
      const auto report = simulation->step();
      EXPECT_TRUE(report) << report.error().message;
      last = *report;
      const CrowdCheck found = simulation->crowd().check();
      EXPECT_EQ(found.overlaps + found.wall_entries, 0U) << "at " << last.time;
    } while (!simulation->is_over() && last.time < time);
    at = last.time;
    return last.left;
  }
  std::optional<Simulation> simulation;
  double at = 0;
};

TEST(Unreachable, AQueueGoesOnBehindADoorThatWasShut) {
  Rooms open(kQueue), early(kQueue + obstacle("9.9, 4.3, 10.3, 5.7", "begin = 0\nend = 2"));
  EXPECT_EQ(open.until(300), 10u);
  EXPECT_EQ(early.until(300), 10u);
  EXPECT_LT(early.at, open.at + 10);
  Rooms late(kQueue + obstacle("9.9, 4.3, 10.3, 5.7", "begin = 6\nend = 40"));
  EXPECT_LT(late.until(39), 10u);
  EXPECT_EQ(late.until(300), 10u);
  EXPECT_LT(late.at, 40 + open.at);
}

// On the counter, on a place behind it, on all places but two, and where the line ends; for a while
// or for good.
TEST(Unreachable, AQueueGoesOnWhileACrateStandsOnItsLine) {
  for (const std::string times : {"", "begin = 0\nend = 2", "begin = 8", "begin = 8\nend = 16"}) {
    for (const std::string box :
         {"17.6, 4.6, 18.4, 5.4", "16.5, 4.5, 17.5, 5.5", "13, 4, 17, 6", "12, 4.5, 12.6, 5.5"}) {
      Rooms run(kQueue + obstacle(box, times));
      EXPECT_EQ(run.until(120), 10u) << times << ' ' << box;
    }
  }
}

// An obstacle comes up over people without a journey: where they stood is under it.
TEST(Unreachable, PeopleWithoutAJourneyLeaveAnObstacleAndStand) {
  Rooms run(R"([[journey]]
name = "j"
stages = [{leave = "b"}]
[[source]]
name = "t"
area = "a"
count = 8
)" + obstacle("0.5, 0.5, 4.5, 9.5", "begin = 5\nend = 40"));
  EXPECT_EQ(run.until(100), 10u);
  std::vector<AvatarState> all;
  run.simulation->read(all);
  ASSERT_EQ(all.size(), 8u);
  for (const AvatarState& one : all) EXPECT_LT(length(one.velocity), 0.02);
}

TEST(Unreachable, PeopleWalkUpToAShutDoorWaitBeforeItAndGoOnAtOnce) {
  const std::string door = obstacle("9.9, 4.3, 10.3, 5.7", "begin = 0\nend = 60");
  for (const std::string stage :
       {"{leave = \"b\"}", "{go = \"b\"}, {leave = \"b\"}",
        "{random_point = \"b\"}, {leave = \"b\"}", "{queue = \"q\"}, {leave = \"b\"}",
        "{leave = [\"b\"], by = \"quickest\"}"}) {
    Rooms run("[[journey]]\nname = \"j\"\nstages = [" + stage + "]\n" + door);
    EXPECT_EQ(run.until(59), 0u);
    std::vector<AvatarState> all;
    run.simulation->read(all);
    ASSERT_EQ(all.size(), 10u);
    for (const AvatarState& one : all) {
      EXPECT_LT(std::hypot(one.position.x - 9.9, one.position.z - 5), 2.5) << stage;
      EXPECT_LT(length(one.velocity), 0.02) << stage;
    }
    EXPECT_EQ(run.until(300), 10u) << stage;
    EXPECT_LT(run.at, 60 + 35) << stage;
  }
}

}  // namespace
}  // namespace throng
