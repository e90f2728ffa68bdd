// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "validate/walked_path.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

namespace throng::validate {
namespace {

// A door 1 m wide at x = 10, its middle at z = 0.
const CrossedLine kDoor{{10, -0.5}, {10, 0.5}};

// A path through corners, `each` steps of 0.1 s from one to the next.
WalkedPath through(const std::vector<Point2>& corners, int each) {
  WalkedPath path;
  for (size_t i = 1; i < corners.size(); ++i) {
    for (int k = 0; k < each; ++k) {
      const double part = static_cast<double>(k) / each;
      path.at.push_back({corners[i - 1].x + part * (corners[i].x - corners[i - 1].x),
                         corners[i - 1].z + part * (corners[i].z - corners[i - 1].z)});
    }
  }
  path.at.push_back(corners.back());
  return path;
}

PathMeasures measured(const WalkedPath& path) { return measure_paths({&path, 1}, kDoor); }

TEST(WalkedPath, AStraightWalkIsAsLongAsItsStraightLineAndTurnsNowhere) {
  const PathMeasures m = measured(through({{0, 0}, {12, 0}}, 120));  // 1 m/s
  EXPECT_EQ(m.people, 1U);
  EXPECT_NEAR(m.detour, 1, 1e-12);
  EXPECT_EQ(m.turns, 0);
  EXPECT_NEAR(m.speed_change, 0, 1e-12);
  EXPECT_EQ(m.walked_away, 0);
}

TEST(WalkedPath, AZigzagTurnsAtEachOfItsCorners) {
  // Moves of 0.4 s by (0.1, 0.2) and (0.1, -0.2) in turn: 127 degrees each, 0.56 m/s all along.
  std::vector<Point2> corners;
  for (int k = 0; k <= 40; ++k) corners.push_back({7 + 0.1 * k, k % 2 == 0 ? 0.0 : 0.2});
  PathMeasures m = measured(through(corners, 4));
  EXPECT_EQ(m.turns, 1);
  EXPECT_NEAR(m.speed_change, 0, 1e-9);
  // The last move ends before the line: at x = 9.9, 0.2 m aside, or at x = 10 if rounding has it.
  EXPECT_NEAR(m.detour, std::hypot(0.1, 0.2) / 0.1, 0.02);
  // Turns of a right angle or less do not count: (0.2, 0.1) and (0.2, -0.1) turn by 53 degrees.
  for (int k = 0; k <= 40; ++k) corners[k] = {4 + 0.2 * k, k % 2 == 0 ? 0.0 : 0.1};
  m = measured(through(corners, 4));
  EXPECT_EQ(m.turns, 0);
  EXPECT_NEAR(m.detour, std::hypot(0.2, 0.1) / 0.2, 0.01);
}

TEST(WalkedPath, AStepBackCountsOnceInEachDirection) {
  // 1.6 m on, 0.4 m back, and on: moves of 0.4 m, until the last position before x = 10.
  const WalkedPath path = [] {
    WalkedPath walk = through({{8.05, 0}, {9.65, 0}}, 16);
    const WalkedPath back = through({{9.65, 0}, {9.25, 0}}, 4);
    const WalkedPath on = through({{9.25, 0}, {10.45, 0}}, 12);
    walk.at.insert(walk.at.end(), back.at.begin() + 1, back.at.end());
    walk.at.insert(walk.at.end(), on.at.begin() + 1, on.at.end());
    return walk;
  }();
  const PathMeasures m = measured(path);
  // Moves end at 8.05, 8.45, 8.85, 9.25, 9.65, 9.25, 9.65; the next, 10.05, is beyond the line.
  EXPECT_NEAR(m.detour, (1.6 + 0.4 + 0.4) / 1.6, 1e-9);
  EXPECT_NEAR(m.turns, 2.0 / 5, 1e-12);
  EXPECT_NEAR(m.walked_away, 0.4, 1e-9);
  EXPECT_NEAR(m.speed_change, 0, 1e-9);  // 1 m/s in each direction
}

TEST(WalkedPath, SpeedsThatAlternateChangeByTheirDifference) {
  // Moves of 0.4 s by 0.4 m and by 0.2 m in turn: 1 and 0.5 m/s.
  std::vector<Point2> corners{{0, 0}};
  for (int k = 0; k < 40; ++k) corners.push_back({corners.back().x + (k % 2 == 0 ? 0.4 : 0.2), 0});
  const PathMeasures m = measured(through(corners, 4));
  EXPECT_NEAR(m.speed_change, 0.5, 1e-9);
  EXPECT_EQ(m.turns, 0);
}

TEST(WalkedPath, SwayingHeadsDoNotTurn) {
  // A person that stands and sways by 4 cm, then by 6 cm, 0.4 s each, and then leaves.
  for (const double sway : {0.04, 0.06}) {
    std::vector<Point2> corners;
    for (int k = 0; k < 20; ++k) corners.push_back({9, k % 2 == 0 ? 0 : sway});
    corners.push_back({11, 0});
    const PathMeasures m = measured(through(corners, 4));
    if (sway < 0.05) {
      EXPECT_EQ(m.turns, 0);
    } else {
      EXPECT_GT(m.turns, 0.9);
    }
    EXPECT_TRUE(std::isnan(m.detour)) << "a straight line of less than half a metre";
  }
}

TEST(WalkedPath, MeasuresAreMeansOverPeople) {
  // One walks straight; one walks 1 m aside, away from the door, back, and around a corner.
  const std::vector<WalkedPath> paths{through({{4, 0}, {12, 0}}, 80),
                                      through({{6.8, 3}, {6.8, 4}, {6.8, 0}, {12, 0}}, 52)};
  const PathMeasures m = measure_paths(paths, kDoor);
  EXPECT_EQ(m.people, 2U);
  const PathMeasures a = measured(paths[0]), b = measured(paths[1]);
  EXPECT_NEAR(b.detour, 7.8 / std::hypot(2.8, 3), 0.1);  // until x = 9.6, or 10 by rounding
  EXPECT_NEAR(b.walked_away, std::hypot(3.2, 4) - std::hypot(3.2, 3), 1e-9);
  EXPECT_NEAR(m.detour, (a.detour + b.detour) / 2, 1e-12);
  EXPECT_NEAR(m.walked_away, (a.walked_away + b.walked_away) / 2, 1e-12);
}

TEST(WalkedPath, WhatDoesNotCrossOrHardlyWalkedIsNotMeasured) {
  const std::vector<WalkedPath> paths{
      {},
      {.first = 3, .at = {{0, 0}}},
      through({{0, 0}, {9, 0}}, 90),       // stays before the line
      through({{9.9, 0}, {10.5, 0}}, 2)};  // less than a move before it
  const PathMeasures m = measure_paths(paths, kDoor);
  EXPECT_EQ(m.people, 0U);
  for (const double value : {m.detour, m.turns, m.speed_change, m.walked_away}) {
    EXPECT_TRUE(std::isnan(value));
  }
  EXPECT_TRUE(std::isnan(measure_paths({}, kDoor).detour));
  for (const WalkedPath& path : {paths[0], paths[1], paths[2]}) {
    EXPECT_EQ(crossing_index(path, kDoor), 0U);
    EXPECT_EQ(crossing_time(path, kDoor), -1);
  }
}

TEST(WalkedPath, TheFirstCrossingCountsInEitherDirectionAndOverEitherAxis) {
  WalkedPath path = through({{8.05, 0}, {11.05, 0}, {8.05, 0}}, 30);
  path.first = 100;
  EXPECT_EQ(crossing_index(path, kDoor), 20U);
  EXPECT_NEAR(crossing_time(path, kDoor), 10 + 1.95, 1e-9);
  for (Point2& p : path.at) p = {p.z, -p.x};
  const CrossedLine across{{-0.5, -10}, {0.5, -10}};
  EXPECT_NEAR(crossing_time(path, across), 10 + 1.95, 1e-9);
}

TEST(WalkedPath, TracksAreResampledBetweenTheirFrames) {
  // 16 frames a second, 1 m/s: the first step within it is that of 0.2 s, the last that of 0.6 s.
  Track track;
  for (int frame = 2; frame <= 10; ++frame) track.points.push_back({frame, frame / 16.0, 1});
  const WalkedPath path = resampled(track, 16);
  EXPECT_EQ(path.first, 2);
  ASSERT_EQ(path.at.size(), 5U);
  for (size_t i = 0; i < path.at.size(); ++i) {
    EXPECT_NEAR(path.at[i].x, 0.1 * static_cast<double>(2 + i), 1e-12);
  }
  EXPECT_TRUE(resampled({.person = 1, .points = {{1, 0, 0}}}, 16).at.empty());
}

TEST(WalkedPath, OrientationsTurnByTheSmallerAngle) {
  const auto at = [](double degrees) {
    const double angle = degrees * std::numbers::pi / 180;
    return Point2{std::cos(angle), std::sin(angle)};
  };
  // 10 degrees each 0.1 s, over the half turn; then back.
  const std::vector<std::vector<Point2>> steady{{at(170), at(180), at(190), at(180)}};
  EXPECT_NEAR(mean_turning_rate(steady, 0.1), 100, 1e-9);
  EXPECT_NEAR(mean_turning_rate(steady, 0.2), 50, 1e-9);
  // Another with as many that never turns, and two without any change.
  const std::vector<std::vector<Point2>> two{steady[0], {at(5), at(5), at(5), at(5)}, {at(90)}, {}};
  EXPECT_NEAR(mean_turning_rate(two, 0.1), 50, 1e-9);
  EXPECT_NEAR(mean_turning_rate(std::vector<std::vector<Point2>>{{at(0), at(180)}}, 0.1), 1800,
              1e-9);
  EXPECT_TRUE(std::isnan(mean_turning_rate({}, 0.1)));
}

}  // namespace
}  // namespace throng::validate
