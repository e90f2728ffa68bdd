// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "steer_bench.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>

#include "throng/bake.h"

namespace throng::test {
namespace {

// The header's lines are 1 to 5; `rest` begins on line 6. The world is 20 x 20 m.
std::string case_of(const std::string& rest) {
  return "<SteerBenchTestCase>\n"
         "<header><name>tiny</name>\n"
         "<worldBounds><xmin>-10</xmin><xmax>10</xmax><ymin>0</ymin><ymax>0</ymax>\n"
         "<zmin>-10</zmin><zmax>10</zmax></worldBounds>\n"
         "</header>\n" +
         rest + "\n</SteerBenchTestCase>\n";
}

std::string point(double x, double z) {
  return "<x>" + std::to_string(x) + "</x><y>0</y><z>" + std::to_string(z) + "</z>";
}

std::string region(double x0, double z0, double x1, double z1) {
  return "<regionBounds><xmin>" + std::to_string(x0) + "</xmin><xmax>" + std::to_string(x1) +
         "</xmax><ymin>0</ymin><ymax>0</ymax><zmin>" + std::to_string(z0) + "</zmin><zmax>" +
         std::to_string(z1) + "</zmax></regionBounds>";
}

std::string goal_to(const std::string& location) {
  return "<goalSequence><seekStaticTarget><targetLocation>" + location +
         "</targetLocation><desiredSpeed>1.3</desiredSpeed><timeDuration>1000</timeDuration>"
         "</seekStaticTarget></goalSequence>";
}

std::string agent(double x, double z) {
  return "<agent><name>A</name><initialConditions><radius>0.5</radius><position>" + point(x, z) +
         "</position><direction><x>1</x><y>0</y><z>0</z></direction><speed>0</speed>"
         "</initialConditions>" +
         goal_to(point(-x, -z)) + "</agent>";
}

std::string agents(int count, const std::string& bounds, const std::string& goal) {
  return "<agentRegion><numAgents>" + std::to_string(count) + "</numAgents>" + bounds +
         "<initialConditions><radius>0.4</radius><direction><random>true</random></direction>"
         "<speed>0</speed></initialConditions>" +
         goal + "</agentRegion>";
}

Play read(const std::string& rest, uint64_t seed = 1) {
  auto play = read_steer_bench(case_of(rest), "tiny.xml", seed);
  EXPECT_TRUE(play) << play.error().message;
  return play ? *std::move(play) : Play{};
}

std::string fault_of(const std::string& rest) {
  const auto play = read_steer_bench(case_of(rest), "tiny.xml", 1);
  if (play) return "none";
  EXPECT_EQ(play.error().code, Errc::kBadFile);
  return play.error().message;
}

double apart(const Vec3d& a, const Vec3d& b) { return std::hypot(a.x - b.x, a.z - b.z); }

// Where a point of 1 cm can stand.
class Ground {
 public:
  explicit Ground(const Play& play) {
    Context context;
    AvatarClass body;
    body.radius = 0.01;
    auto world = bake_world(play.scene, {.cell = 0.1, .classes = {body}, .workers = 1}, context);
    EXPECT_TRUE(world) << world.error().message;
    if (world) world_ = *std::move(world);
  }
  [[nodiscard]] bool is_open(double x, double z) const {
    return bool(world_.find_place(0, {x, 0, z}, 1));
  }

 private:
  World world_;
};

TEST(SteerBench, AgentsAndTheirTargetsAreRead) {
  const Play play = read(agent(3, 4) + "\n" + agent(-5, 6));
  EXPECT_EQ(play.name, "tiny");
  EXPECT_EQ(play.avatar.radius, 0.5);
  ASSERT_EQ(play.walkers.size(), 2U);
  EXPECT_EQ(play.walkers[1].from.x, -5);
  EXPECT_EQ(play.walkers[1].from.z, 6);
  EXPECT_EQ(play.walkers[1].to.x, 5);
  EXPECT_EQ(play.walkers[1].to.z, -6);
  EXPECT_EQ(play.walkers[1].speed, 1.3);
}

TEST(SteerBench, AgentsOfARegionStartInItApartFromEachOtherAndFromObstacles) {
  const std::string text = "<circleObstacle><radius>1</radius><height>1</height><position>" +
                           point(-5, -5) + "</position></circleObstacle>" + agent(-3, -3) +
                           agents(12, region(-8, -8, -2, -2), goal_to(point(7, 7)));
  const Play play = read(text);
  ASSERT_EQ(play.walkers.size(), 13U);
  for (size_t i = 0; i < play.walkers.size(); ++i) {
    const Walker& w = play.walkers[i];
    for (size_t k = 0; k < i; ++k) EXPECT_GE(apart(w.from, play.walkers[k].from), 2 * 0.5);
    if (i == 0) continue;
    EXPECT_GE(apart(w.from, {-5, 0, -5}), 1 + 0.5);
    EXPECT_GE(std::min(w.from.x, w.from.z), -8);
    EXPECT_LE(std::max(w.from.x, w.from.z), -2);
    EXPECT_EQ(w.to.x, 7);
    EXPECT_EQ(w.to.z, 7);
  }
}

TEST(SteerBench, RandomTargetsLieInTheirRegionOrInTheWorld) {
  const std::string anywhere = goal_to("<random>true</random>");
  const std::string near = goal_to("<random>true</random>" + region(2, -6, 6, -2));
  const std::string text =
      agents(15, region(-9, -9, 0, 9), near) + agents(15, region(1, -9, 9, 9), anywhere);
  const Play play = read(text);
  ASSERT_EQ(play.walkers.size(), 30U);
  bool is_far = false;
  for (size_t i = 0; i < 30; ++i) {
    const Vec3d& to = play.walkers[i].to;
    const bool in_region = to.x >= 2 && to.x <= 6 && to.z >= -6 && to.z <= -2;
    if (i < 15) {
      EXPECT_TRUE(in_region) << i;
    }
    is_far = is_far || !in_region;
    EXPECT_LE(std::max(std::fabs(to.x), std::fabs(to.z)), 10 - 0.4);
  }
  EXPECT_TRUE(is_far);
  const Play same = read(text), other = read(text, 2);
  EXPECT_EQ(same.walkers[7].from.x, play.walkers[7].from.x);
  EXPECT_EQ(same.walkers[7].to.z, play.walkers[7].to.z);
  EXPECT_NE(other.walkers[7].from.x, play.walkers[7].from.x);
  EXPECT_NE(other.walkers[7].to.z, play.walkers[7].to.z);
}

TEST(SteerBench, ObstaclesOfAllKindsStandWhereTheyAre) {
  const std::string text =
      agent(9, 9) +
      "<obstacle><xmin>-9</xmin><xmax>-6</xmax><ymin>0</ymin><ymax>1</ymax><zmin>-9</zmin>"
      "<zmax>-8</zmax></obstacle>"
      "<circleObstacle><position>" +
      point(0, 0) +
      "</position><radius>2</radius><height>1</height></circleObstacle>"
      "<orientedBoxObstacle><position>" +
      point(6, -5) + "</position><size>" + point(6, 1) +
      "</size><thetaY>45</thetaY></orientedBoxObstacle>"
      "<polygonObstacle><vertices><vertex>" +
      point(-8, 2) + "</vertex><vertex>" + point(-3, 2) + "</vertex><vertex>" + point(-3, 7) +
      "</vertex><vertex>" + point(-4, 7) + "</vertex><vertex>" + point(-4, 3) +
      "</vertex><vertex>" + point(-8, 3) + "</vertex></vertices></polygonObstacle>";
  const Ground ground(read(text));
  EXPECT_FALSE(ground.is_open(-7.5, -8.5));
  EXPECT_TRUE(ground.is_open(-7.5, -7.5));
  for (const double angle : {0.1, 1.3, 2.9, 4.4}) {
    EXPECT_FALSE(ground.is_open(1.9 * std::cos(angle), 1.9 * std::sin(angle))) << angle;
    EXPECT_TRUE(ground.is_open(2.3 * std::cos(angle), 2.3 * std::sin(angle))) << angle;
  }
  // Its long side leads from +x to -z.
  EXPECT_FALSE(ground.is_open(6 + 1.8, -5 - 1.8));
  EXPECT_FALSE(ground.is_open(6 - 1.8, -5 + 1.8));
  EXPECT_TRUE(ground.is_open(6 + 1.8, -5 + 1.8));
  EXPECT_TRUE(ground.is_open(6 - 1.8, -5 - 1.8));
  // Shaped like an L.
  EXPECT_FALSE(ground.is_open(-7.5, 2.5));
  EXPECT_FALSE(ground.is_open(-3.5, 6.5));
  EXPECT_TRUE(ground.is_open(-6, 5));
}

TEST(SteerBench, ObstaclesOfARegionLeaveStartsAndTargetsFree) {
  const std::string text = agent(-4, -4) +
                           "<obstacleRegion><numObstacles>12</numObstacles><obstacleSize>1.5"
                           "</obstacleSize><obstacleHeight>1</obstacleHeight>" +
                           region(-6, -6, 6, 6) + "</obstacleRegion>";
  for (uint64_t seed = 1; seed <= 3; ++seed) {
    const Ground ground(read(text, seed));
    int blocked = 0;
    for (double x = -9.45; x < 9.5; x += 0.3) {
      for (double z = -9.45; z < 9.5; z += 0.3) {
        const bool is_open = ground.is_open(x, z);
        blocked += is_open ? 0 : 1;
        if (std::max(std::fabs(x), std::fabs(z)) > 6.2) {
          EXPECT_TRUE(is_open) << x << ", " << z;
        }
        if (std::hypot(x + 4, z + 4) < 0.5 || std::hypot(x - 4, z - 4) < 0.5) {
          EXPECT_TRUE(is_open) << x << ", " << z;
        }
      }
    }
    EXPECT_GT(blocked, 4 * 25) << seed;  // 12 of 25 samples each, less where they overlap
  }
}

TEST(SteerBench, WhatIsNotReadIsRefusedWithItsLine) {
  EXPECT_EQ(fault_of("<emitter/>"), "tiny.xml:6: emitter is not read");
  const std::string start = "<agent><initialConditions><radius>1</radius><position>" + point(0, 0) +
                            "</position></initialConditions>\n<goalSequence>\n";
  EXPECT_EQ(fault_of(start + "<fleeStaticTarget/></goalSequence></agent>"),
            "tiny.xml:8: fleeStaticTarget of goalSequence is not read");
  EXPECT_EQ(fault_of(start + "</goalSequence></agent>"),
            "tiny.xml:7: goalSequence without seekStaticTarget");
  const std::string target = "<seekStaticTarget><targetLocation>" + point(1, 1) +
                             "</targetLocation><desiredSpeed>1</desiredSpeed></seekStaticTarget>\n";
  EXPECT_EQ(fault_of(start + target + target + "</goalSequence></agent>"),
            "tiny.xml:9: seekStaticTarget after another is not read");
  EXPECT_EQ(fault_of(agent(1, 1) + "\n<circleObstacle>\n<position>" + point(0, 0) +
                     "</position></circleObstacle>"),
            "tiny.xml:7: circleObstacle without radius");
  EXPECT_EQ(fault_of(agent(1, 1) + "\n<circleObstacle><position>" + point(0, 0) +
                     "</position>\n<radius>wide</radius></circleObstacle>"),
            "tiny.xml:8: radius is no number up to 1e6");
  EXPECT_EQ(fault_of(agent(1, 1) + "\n<polygonObstacle><point>" + point(0, 0) +
                     "</point></polygonObstacle>"),
            "tiny.xml:7: polygonObstacle has fewer than three vertices");
  EXPECT_EQ(fault_of("\n" + agents(100, region(0, 0, 3, 3), goal_to(point(5, 5)))),
            "tiny.xml:7: agentRegion has no room for an agent");
  EXPECT_EQ(fault_of(""), "tiny.xml:1: SteerBenchTestCase has no agents");
}

TEST(SteerBench, DamagedFilesAreRefused) {
  const std::string whole =
      case_of(agent(3, 4) + agents(3, region(0, 0, 5, 5), goal_to(point(1, 1))));
  ASSERT_TRUE(read_steer_bench(whole, "whole", 1));
  for (size_t size = 0; size + 25 < whole.size(); size += 7) {
    const auto play = read_steer_bench(whole.substr(0, size), "half", 1);
    ASSERT_FALSE(play) << size;
    EXPECT_EQ(play.error().code, Errc::kBadFile);
    EXPECT_TRUE(play.error().message.starts_with("half:")) << play.error().message;
  }
  EXPECT_FALSE(load_steer_bench("no such file.xml", 1));
}

TEST(SteerBench, TheCasesOfSteerSuiteAreRead) {
  const std::filesystem::path folder = std::string(THRONG_SHARED_WORLDS) + "/steersuite";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << folder << " is not here";
  int cases = 0;
  for (const auto& file : std::filesystem::directory_iterator(folder)) {
    if (file.path().extension() != ".xml") continue;
    const auto play = load_steer_bench(file.path().string(), 1);
    ASSERT_TRUE(play) << play.error().message;
    EXPECT_EQ(play->name, file.path().stem().string());
    EXPECT_GE(play->walkers.size(), 3U) << play->name;
    EXPECT_EQ(play->avatar.radius, 0.5) << play->name;
    ++cases;
  }
  EXPECT_GT(cases, 0);
}

}  // namespace
}  // namespace throng::test
