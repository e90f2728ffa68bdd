// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "validate/maze.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <set>
#include <utility>
#include <vector>

// Mazes are drawn on a grid, box by box, and looked at there.
namespace throng::validate {
namespace {

constexpr int kCellsInMetre = 10;  // All walls lie on its lines.
constexpr int kCells = 192;        // along each side

class Drawing {
 public:
  explicit Drawing(const Maze& maze) : free_(kCells * kCells, 1) {
    for (const Polygon& obstacle : maze.plane.obstacles) {
      const auto& low = obstacle.outer[0];
      const auto& high = obstacle.outer[2];
      for (int z = line(low[1]); z < line(high[1]); ++z) {
        for (int x = line(low[0]); x < line(high[0]); ++x) {
          free_[static_cast<size_t>(z * kCells + x)] = 0;
        }
      }
    }
  }
  static int line(double metres) { return static_cast<int>(std::lround(metres * kCellsInMetre)); }
  [[nodiscard]] bool is_free(int x, int z) const {
    return x >= 0 && z >= 0 && x < kCells && z < kCells &&
           free_[static_cast<size_t>(z * kCells + x)] != 0;
  }
  // Free cells in a row through (x, z) along (dx, dz), that one counted.
  [[nodiscard]] int run(int x, int z, int dx, int dz) const {
    int count = 1;
    for (const int sign : {-1, 1}) {
      for (int k = 1; is_free(x + sign * k * dx, z + sign * k * dz); ++k) ++count;
    }
    return count;
  }
  // Which cells a flood from one of them reaches.
  [[nodiscard]] std::vector<uint8_t> flood(int x, int z) const {
    std::vector<uint8_t> reached(free_.size(), 0);
    std::vector<std::pair<int, int>> open{{x, z}};
    while (!open.empty()) {
      const auto [i, k] = open.back();
      open.pop_back();
      if (!is_free(i, k) || reached[static_cast<size_t>(k * kCells + i)] != 0) continue;
      reached[static_cast<size_t>(k * kCells + i)] = 1;
      open.insert(open.end(), {{i + 1, k}, {i - 1, k}, {i, k + 1}, {i, k - 1}});
    }
    return reached;
  }

 private:
  std::vector<uint8_t> free_;
};

TEST(Maze, AllPassingPlacesAreConnectedAndHaveRoomForTwo) {
  for (uint64_t seed = 1; seed <= 20; ++seed) {
    const Maze maze = make_maze(seed);
    const Drawing drawing(maze);
    ASSERT_GE(maze.places.size(), 36U) << seed;
    const auto reached =
        drawing.flood(Drawing::line(maze.places[0].x), Drawing::line(maze.places[0].z));
    for (const Point2& place : maze.places) {
      const int x = Drawing::line(place.x), z = Drawing::line(place.z);
      EXPECT_EQ(reached[static_cast<size_t>(z * kCells + x)], 1) << seed;
      for (int i = -7; i < 7; ++i) {
        for (int k = -7; k < 7; ++k) ASSERT_TRUE(drawing.is_free(x + i, z + k)) << seed;
      }
    }
  }
}

// Outside passing places and bends a free cell lies in a corridor: across it there are 0.6 m.
TEST(Maze, CorridorsAreOneBodyWide) {
  for (uint64_t seed = 1; seed <= 20; ++seed) {
    const Maze maze = make_maze(seed);
    const Drawing drawing(maze);
    std::set<std::pair<int, int>> places;
    for (const Point2& p : maze.places) {
      places.insert({Drawing::line(p.x) / 24, Drawing::line(p.z) / 24});
    }
    int cells = 0;
    for (int z = 0; z < kCells; ++z) {
      for (int x = 0; x < kCells; ++x) {
        const int half = places.contains({x / 24, z / 24}) ? 7 : 3;
        const bool in_middle = std::abs(2 * (x % 24) + 1 - 24) < 2 * half &&
                               std::abs(2 * (z % 24) + 1 - 24) < 2 * half;
        if (!drawing.is_free(x, z) || in_middle) continue;
        ++cells;
        ASSERT_EQ(std::min(drawing.run(x, z, 1, 0), drawing.run(x, z, 0, 1)), 6)
            << seed << ": " << x << ", " << z;
      }
    }
    // A tree of 64 blocks has 63 corridors, each at least 1 m long between the places.
    EXPECT_GE(cells, 63 * 6 * 10) << seed;
  }
}

TEST(Maze, DeadEndsArePassingPlaces) {
  for (uint64_t seed = 1; seed <= 20; ++seed) {
    const Maze maze = make_maze(seed);
    const Drawing drawing(maze);
    std::set<std::pair<int, int>> places;
    for (const Point2& p : maze.places) {
      places.insert({Drawing::line(p.x) / 24, Drawing::line(p.z) / 24});
    }
    for (int z = 0; z < 8; ++z) {
      for (int x = 0; x < 8; ++x) {
        const int i = 24 * x + 12, k = 24 * z + 12;  // the middle
        int sides = 0;
        sides += drawing.is_free(i + 11, k) ? 1 : 0;
        sides += drawing.is_free(i - 12, k) ? 1 : 0;
        sides += drawing.is_free(i, k + 11) ? 1 : 0;
        sides += drawing.is_free(i, k - 12) ? 1 : 0;
        EXPECT_GE(sides, 1) << seed;
        EXPECT_TRUE(sides == 2 || places.contains({x, z})) << seed;
      }
    }
  }
}

TEST(Maze, AnotherSeedGivesAnotherMazeAndTheSameSeedTheSame) {
  const auto corners = [](uint64_t seed) {
    std::vector<double> all;
    for (const Polygon& p : make_maze(seed).plane.obstacles) {
      for (const auto& corner : p.outer) all.insert(all.end(), corner.begin(), corner.end());
    }
    return all;
  };
  EXPECT_EQ(corners(1), corners(1));
  EXPECT_NE(corners(1), corners(2));
}

TEST(Maze, TripsShareNoStartAndNoGoal) {
  for (uint64_t seed = 1; seed <= 20; ++seed) {
    const Maze maze = make_maze(seed);
    const Trips trips = maze_trips(maze, 30, seed);
    ASSERT_EQ(trips.starts.size(), 30U);
    ASSERT_EQ(trips.goals.size(), 30U);
    std::set<std::pair<double, double>> starts, goals;
    for (size_t n = 0; n < 30; ++n) {
      const Point2 &from = trips.starts[n], &to = trips.goals[n];
      EXPECT_TRUE(starts.insert({from.x, from.z}).second) << seed;
      EXPECT_TRUE(goals.insert({to.x, to.z}).second) << seed;
      EXPECT_NE(std::pair(from.x, from.z), std::pair(to.x, to.z)) << seed;
    }
  }
}

}  // namespace
}  // namespace throng::validate
