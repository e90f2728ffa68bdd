// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "throng/scenario.h"

namespace throng {
namespace {

// A hall of 20 by 10 m, with a door of 3 m in a wall across it.
const std::string kHall = R"(seconds = 60
seed = 3
cell = 0.1
[plane]
floor = [[0, 0], [20, 0], [20, 10], [0, 10]]
obstacles = [[[10, 0], [10.2, 0], [10.2, 4], [10, 4]], [[10, 7], [10.2, 7], [10.2, 10], [10, 10]]]
[[area]]
name = "west"
box = [0.5, 0.5, 8, 9.5]
[[area]]
name = "north"
box = [18, 0.5, 19.5, 2.5]
[[area]]
name = "south"
box = [18, 7.5, 19.5, 9.5]
)";

struct Hall {
  Scenario scenario;
  World world;
};

Hall read(const std::string& text) {
  auto scenario = parse_scenario(kHall + text, "hall.toml");
  EXPECT_TRUE(scenario) << scenario.error().message;
  Context context;
  auto world = open_world(*scenario, context);
  EXPECT_TRUE(world) << world.error().message;
  return {*scenario, *world};
}

Simulation made(const Hall& run, int32_t workers = 2) {
  Context context;
  auto simulation = Simulation::create(run.world, run.scenario, workers, context);
  EXPECT_TRUE(simulation) << simulation.error().message;
  return std::move(*simulation);
}

// Steps until it is over, at most `max_time`. Checks overlaps and walls in every step.
double run_out(Simulation& simulation, double max_time) {
  SimulationReport last;
  do {
    const auto report = simulation.step();
    EXPECT_TRUE(report) << report.error().message;
    last = *report;
    const CrowdCheck found = simulation.crowd().check();
    EXPECT_EQ(found.overlaps + found.wall_entries, 0U) << "at " << last.time;
  } while (!simulation.is_over() && last.time < max_time);
  return last.time;
}

// A similar hall at (x, z), with every table that has coordinates.
Hall hall_at(double x, double z) {
  const auto box = [&](double u0, double v0, double u1, double v1) {
    return fmt::format("[{}, {}, {}, {}]", x + u0, z + v0, x + u1, z + v1);
  };
  const auto ring = [&](double u0, double v0, double u1, double v1) {
    return fmt::format("[[{0}, {1}], [{2}, {1}], [{2}, {3}], [{0}, {3}]]", x + u0, z + v0, x + u1,
                       z + v1);
  };
  const std::string text = fmt::format(
      R"(seconds = 60
seed = 3
cell = 0.125
[plane]
floor = {}
obstacles = [{}, {}]
[[area]]
name = "west"
box = {}
[[area]]
name = "out"
circle = [{}, {}, 1]
[[density]]
name = "all"
box = {}
pixel = 1
paint = [{{ area = "west", weight = 200 }}]
[[queue]]
name = "till"
line = [[{}, 0, {}], [{}, 0, {}]]
spacing = 0.75
service = 0.5
[[journey]]
name = "out"
stages = [{{ queue = "till" }}, {{ leave = "out" }}]
[[source]]
name = "all"
density = "all"
journey = "out"
count = 40
)",
      ring(0, 0, 20, 10), ring(10, 0, 10.25, 4), ring(10, 7, 10.25, 10), box(0.5, 0.5, 8, 9.5),
      x + 18, z + 2, box(0, 0, 8, 10), x + 13, z + 5, x + 17, z + 5);
  auto scenario = parse_scenario(text, "hall.toml");
  EXPECT_TRUE(scenario) << scenario.error().message;
  if (!scenario) return {};
  Context context;
  auto world = open_world(*scenario, context);
  EXPECT_TRUE(world) << world.error().message;
  return {*scenario, *world};
}

TEST(Simulation, RunsInANationalGridAsNearTheCoordinateOrigin) {
  for (const auto& [x, z] : {std::pair{678000.0, -5403500.0}, std::pair{-1e7, 1e7}}) {
    Simulation near = made(hall_at(0, 0)), far = made(hall_at(x, z));
    std::vector<AvatarState> near_states, far_states;
    for (int step = 0; step < 300; ++step) {
      ASSERT_TRUE(near.step());
      ASSERT_TRUE(far.step());
      near.crowd().read(near_states);
      far.crowd().read(far_states);
      ASSERT_EQ(near_states.size(), far_states.size()) << step;
      for (size_t i = 0; i < near_states.size(); ++i) {
        EXPECT_EQ(near_states[i].id, far_states[i].id);
        const Vec3d off = far_states[i].position - Vec3d{x, 0, z} - near_states[i].position;
        ASSERT_LT(length(off), 1e-3) << step;  // [m]
      }
    }
    EXPECT_EQ(far.crowd().check().wall_entries, 0U);
  }
}

TEST(Simulation, AvatarsEnterAndLeaveByTheNearestExit) {
  const Hall run = read(R"(
[[journey]]
name = "out"
stages = [{ leave = ["north", "south"] }]
[[source]]
name = "all"
area = "west"
journey = "out"
count = 80
)");
  Simulation simulation = made(run);
  EXPECT_EQ(simulation.crowd().size(), 80U);
  EXPECT_LT(run_out(simulation, 120), 60);
  ASSERT_EQ(simulation.trips().size(), 80U);
  std::map<int32_t, int> by_exit;
  for (const Trip& trip : simulation.trips()) {
    EXPECT_GT(trip.left, 5);
    EXPECT_EQ(trip.entered, 0);
    ++by_exit[trip.exit];
  }
  EXPECT_EQ(by_exit[1] + by_exit[2], 80);
  EXPECT_GT(by_exit[1], 10);
  EXPECT_GT(by_exit[2], 3);
}

TEST(Simulation, IsTheSameForAnyWorkers) {
  const Hall run = read(R"(
[[queue]]
name = "till"
line = [[15, 0, 1], [15, 0, 9]]
service = { uniform = [0.5, 1] }
[[journey]]
name = "shop"
stages = [
  { queue = "till" },
  { random_point = "west" },
  { wait = 2 },
  { leave = ["north", "south"], by = "quickest" },
]
[[source]]
name = "stream"
area = "west"
journey = "shop"
rate = 2
group = { uniform = [1, 3] }
)");
  Simulation one = made(run, 1), two = made(run, 2), four = made(run, 4);
  for (int step = 0; step < 400; ++step) {
    for (Simulation* s : {&one, &two, &four}) ASSERT_TRUE(s->step());
    ASSERT_EQ(one.state_hash(), two.state_hash()) << step;
    ASSERT_EQ(one.state_hash(), four.state_hash()) << step;
  }
  EXPECT_GT(one.trips().size(), 60U);
}

TEST(Simulation, NoAvatarStartsBeforeItsPremovementTimeIsOver) {
  const Hall run = read(R"(
[[journey]]
name = "out"
stages = [{ leave = "north" }]
[[source]]
name = "all"
area = "west"
journey = "out"
count = 30
premovement = { uniform = [2, 8] }
)");
  Simulation simulation = made(run);
  std::vector<AvatarState> before, now;
  simulation.read(before);
  // An avatar that waits yields to those that walk, but stays about where it is.
  std::map<uint32_t, double> began;
  while (simulation.crowd().size() == 30) {
    const auto report = simulation.step();
    ASSERT_TRUE(report);
    simulation.read(now);
    for (size_t i = 0; i < std::min(now.size(), before.size()); ++i) {
      const Vec3d a = before[i].position, b = now[i].position;
      const bool moved = std::hypot(a.x - b.x, a.z - b.z) > 2;
      if (moved && now[i].id == before[i].id) began.try_emplace(now[i].id, report->time);
    }
  }
  EXPECT_GT(began.size(), 20U);
  // An avatar that stands in a stream is swept along for a while.
  int swept = 0;
  for (const auto& [person, time] : began) {
    swept += time < simulation.trips()[person].started ? 1 : 0;
    EXPECT_LT(time, simulation.trips()[person].started + 8) << person;
  }
  EXPECT_LE(swept, 2);
}

TEST(Simulation, ACounterServesOneAfterTheOther) {
  const Hall run = read(R"(
[[queue]]
name = "till"
line = [[13, 0, 5], [19, 0, 5]]
servers = 1
service = 2
[[journey]]
name = "buy"
stages = [{ queue = "till" }, { leave = ["north", "south"] }]
[[source]]
name = "all"
area = "west"
journey = "buy"
count = 12
)");
  Simulation simulation = made(run);
  const double over = run_out(simulation, 200);
  EXPECT_LT(over, 120);
  std::multiset<double> times;
  for (const Trip& trip : simulation.trips()) times.insert(trip.left);
  // Service takes two seconds each, one after the other.
  EXPECT_GT(*times.rbegin() - *times.begin(), 11 * 2 - 3);
}

TEST(Simulation, ALiftTakesAsManyAsItHolds) {
  const Hall run = read(R"(
[[link]]
name = "lift"
from = "north"
to = "south"
interval = 10
capacity = 4
seconds = 5
[[journey]]
name = "ride"
stages = [{ link = "lift" }, { wait = 1 }, { leave = "south" }]
[[source]]
name = "all"
area = "west"
journey = "ride"
count = 10
)");
  Simulation simulation = made(run);
  uint64_t max_in = 0;
  std::set<double> rides;
  uint64_t before = 0;
  while (!simulation.is_over()) {
    const auto report = simulation.step();
    ASSERT_TRUE(report);
    ASSERT_LT(report->time, 120);
    max_in = std::max(max_in, report->in_links);
    if (report->in_links > before) rides.insert(report->time);
    before = report->in_links;
  }
  EXPECT_EQ(max_in, 4U);
  EXPECT_GE(rides.size(), 3U);
  for (const double time : rides) EXPECT_NEAR(std::remainder(time - 0.1, 10), 0, 0.01) << time;
  for (const Trip& trip : simulation.trips()) EXPECT_GE(trip.left, 16);
}

TEST(Simulation, GroupsStayTogether) {
  const Hall run = read(R"(
[[profile]]
name = "mixed"
speed = { uniform = [0.8, 1.8] }
[[journey]]
name = "out"
stages = [{ go = "north" }, { go = "west" }, { leave = "south" }]
[[source]]
name = "all"
area = "west"
profile = "mixed"
journey = "out"
count = 12
group = 3
)");
  // The same avatars, each alone.
  Hall alone = run;
  alone.scenario.sources[0].group = Distribution::fixed(1);
  const auto spread = [](const Hall& of) {
    Simulation simulation = made(of);
    std::vector<AvatarState> now;
    double sum = 0;
    int count = 0;
    for (int step = 0; step < 300; ++step) {
      EXPECT_TRUE(simulation.step());
      simulation.read(now);
      std::map<uint32_t, Vec3d> at;
      for (const AvatarState& a : now) at[a.id] = a.position;
      for (uint32_t first = 0; first < 12; first += 3) {
        for (uint32_t k = 1; k < 3; ++k) {
          if (!at.count(first) || !at.count(first + k)) continue;
          sum += std::hypot(at[first].x - at[first + k].x, at[first].z - at[first + k].z);
          ++count;
        }
      }
    }
    return sum / count;
  };
  const double together = spread(run), apart = spread(alone);
  EXPECT_LT(together, 2.5);
  EXPECT_GT(apart, together * 1.5);
}

TEST(Simulation, DensityMapsDecideWhereAvatarsEnter) {
  const Hall run = read(R"(
[[density]]
name = "map"
box = [0, 0, 20, 10]
pixel = 1
paint = [{ area = "west", weight = 10 }, { area = "north", weight = 100 }]
[[source]]
name = "all"
density = "map"
count = 60
)");
  Simulation simulation = made(run);
  std::vector<AvatarState> states;
  simulation.read(states);
  ASSERT_EQ(states.size(), 60U);
  int north = 0;
  for (const AvatarState& a : states) {
    const bool in_north = a.position.x > 17 && a.position.z < 3;
    EXPECT_TRUE(in_north || a.position.x < 8.5) << a.position.x << " " << a.position.z;
    north += in_north ? 1 : 0;
  }
  // Weight 100 on 2 to 6 m2 against 10 on 72 m2, as far as there is room in the north.
  EXPECT_GT(north, 4);

  std::vector<uint8_t> nowhere(200, 0), wrong(3, 1);
  EXPECT_FALSE(simulation.set_density("map", nowhere));
  EXPECT_FALSE(simulation.set_density("map", wrong));
  EXPECT_FALSE(simulation.set_density("mop", std::vector<uint8_t>(200, 1)));
  EXPECT_TRUE(simulation.set_density("map", std::vector<uint8_t>(200, 1)));
}

TEST(Simulation, ByQuickestAvoidsACrowdedExit) {
  // All start near the north exit.
  const std::string text = R"(
[[area]]
name = "corner"
box = [12, 0.5, 17, 4]
[[journey]]
name = "out"
stages = [{ leave = ["north", "south"], by = "BY" }]
[[source]]
name = "all"
area = "corner"
journey = "out"
count = 60
)";
  const auto by_south = [&](const std::string& by) {
    std::string of = text;
    const Hall run = read(of.replace(of.find("BY"), 2, by));
    Simulation simulation = made(run);
    run_out(simulation, 120);
    EXPECT_TRUE(simulation.is_over());
    int south = 0;
    for (const Trip& trip : simulation.trips()) south += trip.exit == 2 ? 1 : 0;
    return south;
  };
  EXPECT_EQ(by_south("nearest"), 0);
  EXPECT_GT(by_south("quickest"), 5);
}

// The door is shut for ten seconds: no avatar leaves before it opens, and all leave after that.
TEST(Simulation, AShutDoorOpensAgain) {
  const Hall run = read(R"(
[[obstacle]]
name = "door"
box = [9.9, 3.5, 10.3, 7.5]
end = 10
[[journey]]
name = "out"
stages = [{ leave = ["north", "south"] }]
[[source]]
name = "all"
area = "west"
journey = "out"
count = 30
)");
  Simulation simulation = made(run);
  EXPECT_LT(run_out(simulation, 200), 100);
  EXPECT_TRUE(simulation.is_over());
  for (const Trip& trip : simulation.trips()) EXPECT_GT(trip.left, 10 + 8 / 1.5);
}

// A door is to shut while avatars stream through. By the default policy it shuts soon; one that
// waits may stay open.
TEST(Simulation, ADoorThatIsToShutInAStreamReportsWhenItDid) {
  const std::string text = R"(
[[obstacle]]
name = "door"
box = [9.9, 3.5, 10.3, 7.5]
begin = 8
POLICY
[[journey]]
name = "out"
stages = [{ leave = ["north", "south"] }]
[[source]]
name = "all"
area = "west"
journey = "out"
rate = 3
)";
  for (const bool waits : {false, true}) {
    std::string of = text;
    const Hall run = read(of.replace(of.find("POLICY"), 6, waits ? "policy = \"wait\"" : ""));
    Simulation simulation = made(run);
    const ObstacleTimes& times = simulation.obstacle_times()[0];
    EXPECT_LT(times.requested_at, 0);
    for (int step = 0; step < 200; ++step) ASSERT_TRUE(simulation.step());
    EXPECT_NEAR(times.requested_at, 8, 1e-9);
    EXPECT_LT(times.removed_at, 0);
    EXPECT_GT(times.inside, 0u);
    if (waits) continue;
    EXPECT_GE(times.up, 8);
    EXPECT_LE(times.up, 11);
    EXPECT_EQ(times.waits_for, 0u);
  }
}

// Avatars of two classes that go from area "west" to area "east" in the world of the text.
Simulation across(const std::string& text) {
  auto scenario = parse_scenario(text + R"(
[[profile]]
name = "first"
class = "adult"
[[profile]]
name = "second"
class = "other"
[[journey]]
name = "across"
stages = [{ leave = "east" }]
[[source]]
name = "all"
area = "west"
count = 12
profile = "first"
journey = "across"
[[source]]
name = "others"
area = "west"
count = 12
profile = "second"
journey = "across"
)",
                                 "across.toml");
  EXPECT_TRUE(scenario) << scenario.error().message;
  Context context;
  const auto world = open_world(*scenario, context);
  EXPECT_TRUE(world) << world.error().message;
  auto simulation = Simulation::create(*world, *scenario, 2, context);
  EXPECT_TRUE(simulation) << simulation.error().message;
  return std::move(*simulation);
}

// Over a wall right across, in one crowd with avatars that cannot fly.
TEST(Simulation, FlyersCrossWalls) {
  Simulation simulation = across(R"(
[plane]
floor = [[0, 0], [20, 0], [20, 10], [0, 10]]
obstacles = [[[10, 0], [10.4, 0], [10.4, 10], [10, 10]]]
[[class]]
name = "adult"
[[class]]
name = "other"
radius = 0.4
speed = 5
flies = true
[[area]]
name = "west"
box = [1, 1, 8, 9]
[[area]]
name = "east"
box = [12, 1, 19, 9]
)");
  run_out(simulation, 40);
  for (const Trip& trip : simulation.trips()) EXPECT_EQ(trip.exit >= 0, trip.profile == 1);
  EXPECT_EQ(simulation.trips().size(), 24U);
}

// Over curved hills on foot and along the normal, in one crowd.
TEST(Simulation, ClimbersWalkOverNodes) {
  Simulation simulation = across(R"(
cell = 0.5
[builtin]
name = "landscape"
size = 64
[[class]]
name = "adult"
[[class]]
name = "other"
climb_slope = 180
[[area]]
name = "west"
box = [2, 2, 18, 62]
[[area]]
name = "east"
box = [46, 2, 62, 62]
)");
  std::vector<AvatarState> states;
  size_t climbing = 0, leaning = 0;
  while (!simulation.is_over()) {
    const auto report = simulation.step();
    ASSERT_TRUE(report) << report.error().message;
    const CrowdCheck found = simulation.crowd().check();
    ASSERT_EQ(found.overlaps + found.wall_entries, 0U) << "at " << report->time;
    simulation.read(states);
    for (const AvatarState& s : states) {
      EXPECT_EQ(s.mode == MoveMode::kClimb, s.avatar_class == 1);
      climbing += s.mode == MoveMode::kClimb ? 1 : 0;
      leaning += s.mode == MoveMode::kClimb && s.up.y < 0.9 ? 1 : 0;
    }
    if (report->time >= 120) break;
  }
  EXPECT_GT(climbing, 0U);
  EXPECT_GT(leaning, 0U);
  size_t left = 0;
  for (const Trip& trip : simulation.trips()) left += trip.exit >= 0 ? 1 : 0;
  EXPECT_EQ(simulation.trips().size(), 24U);
  EXPECT_GE(left, 20U);
}

TEST(Simulation, NamesWhatIsWrong) {
  const auto why = [](const std::string& text) {
    const Hall run = read(text);
    Context context;
    const auto simulation = Simulation::create(run.world, run.scenario, 1, context);
    return simulation ? std::string() : simulation.error().message;
  };
  EXPECT_NE(why("[[area]]\nname = \"off\"\nbox = [30, 0, 31, 1]\n[[source]]\nname = \"s\"\narea = "
                "\"off\"\ncount = 1\n")
                .find("source 's': no avatar of class 'adult' can stand in area 'off'"),
            std::string::npos);
  EXPECT_NE(why("[[profile]]\nname = \"p\"\nclass = \"wolf\"\n").find("no class 'wolf'"),
            std::string::npos);
}

// More avatars than there is room for: the rest waits outside and enters when others leave.
TEST(Simulation, AvatarsWithoutRoomWaitOutside) {
  const Hall run = read(R"(
[[area]]
name = "cell"
box = [1, 1, 2.5, 2.5]
[[journey]]
name = "out"
stages = [{ leave = "north" }]
[[source]]
name = "all"
area = "cell"
journey = "out"
count = 60
)");
  Simulation simulation = made(run);
  EXPECT_LT(simulation.crowd().size(), 20U);
  run_out(simulation, 200);
  EXPECT_TRUE(simulation.is_over());
  for (const Trip& trip : simulation.trips()) EXPECT_GE(trip.left, 0) << trip.person;
}

// A crowd with targets that is saved and restored takes the same steps, to the bit.
TEST(Crowd, TargetsAreSaved) {
  const Hall run = read("");
  Context context;
  auto crowd = Crowd::create(run.world, {});
  ASSERT_TRUE(crowd);
  const auto ids = crowd->scatter(40, {}, context);
  ASSERT_TRUE(ids);
  const auto target = crowd->add_target(run.scenario.areas[1].prisms, context);
  const auto other = crowd->add_target(run.scenario.areas[2].prisms, context);
  ASSERT_TRUE(target && other);
  crowd->set_targets(std::span(*ids).first(20), *target);
  crowd->set_targets(std::span(*ids).last(20), *other);
  for (int step = 0; step < 20; ++step) crowd->step();
  const std::vector<uint8_t> saved = crowd->save();
  auto again = Crowd::restore(run.world, {}, saved, context);
  ASSERT_TRUE(again) << again.error().message;
  uint64_t arrived = 0;
  for (int step = 0; step < 300; ++step) {
    arrived += crowd->step().arrived;
    again->step();
    ASSERT_EQ(crowd->state_hash(), again->state_hash()) << step;
  }
  EXPECT_GT(arrived, 20U);
}

// Where an obstacle cuts the path to a target, avatars walk around it, and straight again once it
// is removed: flow fields follow the obstacles.
TEST(Crowd, TargetsAreReachedAroundObstacles) {
  const Hall run = read("");
  Context context;
  Edits edits;
  auto crowd = Crowd::create(run.world, {.edits = edits});
  ASSERT_TRUE(crowd);
  std::vector<AvatarSpawn> spawns;
  for (int i = 0; i < 12; ++i) {
    spawns.push_back({run.world.find_place(0, {1.0 + i % 5, 0, 2.0 + i / 5}, 1), 0, 0, 0});
  }
  const auto ids = crowd->add(spawns, context);
  ASSERT_TRUE(ids);
  const auto target = crowd->add_target(run.scenario.areas[1].prisms, context);
  ASSERT_TRUE(target);
  crowd->set_targets(*ids, *target);
  const double before = crowd->distance((*ids)[0], *target);
  // All of the door but its south end: z from 4 to 6 of 4 to 7.
  ASSERT_TRUE(edits.add_obstacle(Prism::box({9.5, 0, 3.5}, {10.7, 2, 6})));
  EXPECT_EQ(crowd->distance((*ids)[0], *target), before) << "it follows in its next step, or now";
  ASSERT_TRUE(crowd->add({}, context));
  EXPECT_GT(crowd->distance((*ids)[0], *target), before + 1);
  // Then all of the door, for a while.
  const auto door = edits.add_obstacle(Prism::box({9.9, 0, 5}, {10.3, 2, 7.2}));
  ASSERT_TRUE(door && crowd->add({}, context));
  EXPECT_FALSE(std::isfinite(crowd->distance((*ids)[0], *target)));
  crowd->step();
  EXPECT_EQ(crowd->goal_unreachable().size(), ids->size());
  ASSERT_TRUE(edits.remove(*door) && crowd->add({}, context));
  crowd->set_targets(*ids, *target);
  uint64_t arrived = 0;
  for (int step = 0; step < 1500; ++step) {
    arrived += crowd->step().arrived;
    const CrowdCheck found = crowd->check();
    ASSERT_EQ(found.overlaps + found.wall_entries + found.obstacle_entries, 0U) << step;
  }
  EXPECT_EQ(arrived, ids->size());
}

// A column of avatars with one goal walks there; they wait for each other only near it.
TEST(Crowd, ManyWithOneGoalWalk) {
  const Hall run = read("");
  Context context;
  auto crowd = Crowd::create(run.world, {});
  ASSERT_TRUE(crowd);
  std::vector<AvatarSpawn> spawns;
  for (int i = 0; i < 8; ++i) {
    spawns.push_back({run.world.find_place(0, {1.0 + 0.8 * i, 0, 5.5}, 1), 0, 0, 0});
  }
  const auto ids = crowd->add(spawns, context);
  ASSERT_TRUE(ids);
  const Place goal = run.world.find_place(0, {17, 0, 5.5}, 1);
  crowd->set_goals(*ids, std::vector<Place>(ids->size(), goal));
  double progress = 0;
  for (int step = 0; step < 50; ++step) progress += crowd->step().progress / 50;
  EXPECT_GT(progress, 0.75);  // At 0.8 m behind each other none has its full speed.
}

// An avatar that leaves within a move of an area left by it, not by the first of the list.
TEST(Simulation, ReportsTheExitThatWasUsed) {
  const Hall run = read(R"(
[[area]]
name = "beside north"
box = [15, 0.5, 16, 1.5]
[[area]]
name = "beside south"
box = [15, 8.5, 16, 9.5]
[[journey]]
name = "out"
stages = [{ leave = ["north", "south"] }]
[[source]]
name = "upper"
area = "beside north"
journey = "out"
count = 3
[[source]]
name = "lower"
area = "beside south"
journey = "out"
count = 3
)");
  Simulation simulation = made(run);
  run_out(simulation, 30);
  for (const Trip& trip : simulation.trips()) {
    ASSERT_GE(trip.exit, 0);
    EXPECT_EQ(run.scenario.areas[static_cast<size_t>(trip.exit)].name,
              trip.source == 0 ? "north" : "south");
  }
}

TEST(Simulation, RowsHoldFiveAvatarsASquareMetreWithoutOverlap) {
  const Hall run = read(R"(
[[area]]
name = "full"
box = [1, 1, 5, 7]
[[profile]]
name = "slim"
radius = 0.19
[[source]]
name = "all"
area = "full"
profile = "slim"
count = 120
places = "rows"
)");
  const Simulation simulation = made(run);
  EXPECT_EQ(simulation.crowd().size(), 120U);
  EXPECT_EQ(simulation.crowd().check().overlaps, 0U);
}

TEST(Simulation, TheSpeedFactorOfAnAreaHoldsInsideItAlone) {
  const Hall run = read(R"(
[[area]]
name = "stairs"
box = [8.5, 0, 14, 10]
speed_factor = 0.5
[[profile]]
name = "any"
speed = 1
[[journey]]
name = "out"
stages = [{ leave = ["north", "south"] }]
[[source]]
name = "all"
area = "west"
profile = "any"
journey = "out"
count = 1
)");
  Simulation simulation = made(run);
  std::vector<AvatarState> before, now;
  int slow = 0, fast = 0;
  simulation.read(before);
  while (!simulation.is_over()) {
    ASSERT_TRUE(simulation.step());
    simulation.read(now);
    if (now.empty()) break;
    const Vec3d &a = before[0].position, &b = now[0].position;
    const double speed = std::hypot(b.x - a.x, b.z - a.z) / 0.1;
    if (a.x > 8.8 && b.x < 13.8) {
      EXPECT_NEAR(speed, 0.5, 0.011) << a.x;
      ++slow;
    }
    if ((b.x < 8.4 && simulation.crowd().size() == 1 && speed > 0.9) || a.x > 14.3) ++fast;
    EXPECT_LE(speed, 1.001);
    before = now;
  }
  EXPECT_GT(slow, 80);
  EXPECT_GT(fast, 30);
}

}  // namespace
}  // namespace throng
