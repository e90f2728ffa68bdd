// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <fstream>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "baked.h"
#include "scratch_folder.h"
#include "throng/bake.h"
#include "throng/world.h"

// Worlds that are larger than the memory that they may use.
namespace throng {
namespace {

// Of the memory that this process has mapped from files. [bytes]
uint64_t mapped_from_files() {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);) {
    std::istringstream words(line);
    std::string key;
    uint64_t kilobytes = 0;
    if (words >> key >> kilobytes && key == "RssFile:") return kilobytes << 10;
  }
  return 0;
}

class Residency : public testing::Test {
 protected:
  void SetUp() override {
    Context context;
    const auto report = bake_world_to(path(), test::builtin({.name = "city", .size = 500}),
                                      {.cell = 0.25, .zone = 48}, context);
    ASSERT_TRUE(report) << report.error().message;
    bytes_ = report->bytes;
    ASSERT_GT(report->zones, 80u);
  }

  [[nodiscard]] std::string path() const { return folder_.path() + "/city.throng"; }
  [[nodiscard]] World open(uint64_t budget) const {
    auto world = World::open(path(), {.resident_bytes = budget});
    EXPECT_TRUE(world);
    return *world;
  }

  // What walks from random places over all the world come to.
  static double walk(const World& world, uint64_t seed, uint64_t count) {
    double sum = 0;
    for (uint64_t n = 0; n < count; ++n) {
      const Place from = world.random_place(0, seed, n);
      const MoveResult move = world.move(0, from, double(n % 7) - 3, double(n % 5) - 2);
      sum += move.place.position.x + move.place.position.y + move.place.position.z;
    }
    return sum;
  }

  test::ScratchFolder folder_;
  uint64_t bytes_ = 0;
};

TEST_F(Residency, OpeningTouchesNoZone) {
  const World world = open(1 << 20);
  EXPECT_EQ(world.residency().zones, 0u);
  const Box3d bounds = world.summary().bounds;
  const double x = (bounds.min.x + bounds.max.x) / 2, z = (bounds.min.z + bounds.max.z) / 2;
  (void)world.find_place(0, {x, 0, z}, 1);
  EXPECT_EQ(world.residency().zones, 1u);
}

TEST_F(Residency, ABudgetCapsWhatIsInMemory) {
  const World all = open(0);
  const uint64_t budget = bytes_ / 8;
  const World some = open(budget);
  for (uint64_t seed = 0; seed < 3; ++seed) {
    EXPECT_EQ(walk(all, seed, 2000), walk(some, seed, 2000));
    EXPECT_LE(some.residency().bytes, budget);
    EXPECT_GT(some.residency().zones, 2u);
  }
  EXPECT_TRUE(some.check_all());
  EXPECT_LE(some.residency().bytes, budget);
}

TEST_F(Residency, WhatIsGivenBackLeavesTheMemory) {
  const uint64_t before = mapped_from_files();
  if (before == 0) GTEST_SKIP() << "this system does not say";
  {
    const World some = open(bytes_ / 8);
    ASSERT_TRUE(some.check_all());
    EXPECT_LT(mapped_from_files(), before + bytes_ / 2);
  }
  const World all = open(0);
  ASSERT_TRUE(all.check_all());
  EXPECT_GT(mapped_from_files(), before + bytes_ * 3 / 4);
}

TEST_F(Residency, AZoneLargerThanTheBudgetCanStillBeRead) {
  const World tight = open(1);
  EXPECT_EQ(walk(tight, 5, 300), walk(open(0), 5, 300));
  EXPECT_LE(tight.residency().zones, 1u);
}

TEST_F(Residency, ManyReadersSeeTheSameWorld) {
  const World all = open(0), some = open(bytes_ / 16);
  std::atomic<int> wrong{0};
  std::vector<std::thread> threads;
  for (uint64_t t = 0; t < 6; ++t) {
    threads.emplace_back(
        [&, t] { wrong += walk(all, 100 + t, 1500) != walk(some, 100 + t, 1500); });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(wrong, 0);
  EXPECT_LE(some.residency().bytes, bytes_ / 16);
}

}  // namespace
}  // namespace throng
