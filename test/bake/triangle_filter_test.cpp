// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "bake/surface/triangle_filter.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/random.h"
#include "simd_targets.h"

namespace throng {
namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();

// Random numbers one after the other.
struct Dice {
  uint64_t seed, count = 0;
  double between(double low, double high) {
    return low + (high - low) * random_unit(seed, 7, count++);
  }
  Vec3d point(double size) {
    return {between(-size, size), between(-size, size), between(-size, size)};
  }
};

// A body somewhere near the origin, and triangles of all sizes around it: slivers, points, and such
// as touch the body's lid or bottom as closely as numbers go.
struct Case {
  bake::BodyFrame frame;
  std::vector<bake::FilterTube> tubes;
  std::vector<bake::LocalTriangle> triangles;  // in the world
  bake::FilterQuery question;

  explicit Case(Dice& dice) {
    Vec3d up = dice.point(1);
    if (length(up) < 0.1 || dice.between(0, 1) < 0.3) up = {0, 1, 0};
    frame = bake::BodyFrame::around(dice.point(5), up * (1 / length(up)));
    bake::BodySweep all{.radius = 0, .low = kNever, .high = -kNever};
    for (int i = 0; i < 4; ++i) {
      const double low = dice.between(-0.5, 1);
      const bake::BodySweep body{dice.between(0.1, 1.5), low, low + dice.between(0.1, 2)};
      all = {std::max(all.radius, body.radius), std::min(all.low, body.low),
             std::max(all.high, body.high)};
      tubes.push_back({body, body});
    }
    tubes[0].decisive.high = tubes[0].decisive.low + 0.1;
    question = {.frame = frame, .first = all, .second = tubes[1].whole, .tubes = tubes};
    for (int i = 0; i < 37; ++i) {
      const double size = std::pow(10, dice.between(-3, 1.5));
      Vec3d at = dice.point(2.5);
      const bake::BodySweep& body = tubes[static_cast<size_t>(dice.between(0, 4))].whole;
      const double kind = dice.between(0, 1);
      if (kind < 0.2) at.z = kind < 0.1 ? body.high : body.low;
      bake::LocalTriangle local{at, at + dice.point(size), at + dice.point(size)};
      if (kind < 0.2) {
        for (Vec3d& p : local) p.z = at.z + dice.between(-1e-7, 1e-7);
      } else if (kind < 0.3) {
        local[2] = local[0] * 0.3 + local[1] * 0.7;
      } else if (kind < 0.4) {  // beside the body, along its wall
        const double turn = dice.between(0, 7), r = body.radius + dice.between(-1e-6, 1e-6);
        const Vec3d out{std::cos(turn), std::sin(turn), 0}, along{-out.y, out.x, 0};
        local = {out * r + along * -size, out * r + along * size, out * r + Vec3d{0, 0, 9}};
      }
      for (Vec3d& p : local) {
        p = frame.centre + frame.side * p.x + frame.front * p.y + frame.up * p.z;
      }
      triangles.push_back(local);
    }
  }

  [[nodiscard]] bool enters(size_t triangle, const bake::BodySweep& body) const {
    bake::LocalTriangle local = triangles[triangle];
    for (Vec3d& p : local) p = frame.local(p);
    return bake::lowest_entry(local, body) < kNever;
  }
};

TEST(TriangleFilter, LosesNoTriangleThatEntersAndAnswersOnlyWhatIsSo) {
  test::for_every_simd_target([](const char* target) {
    SCOPED_TRACE(target);
    Dice dice{.seed = 3};
    bake::FilterHits hits;
    size_t answers = 0, kept = 0, entered = 0;
    for (int round = 0; round < 3000; ++round) {
      const Case c(dice);
      bake::FilterList list;
      list.clear(c.frame.centre + dice.point(20));
      for (size_t i = 0; i < c.triangles.size(); ++i) {
        list.add(static_cast<uint32_t>(i), c.triangles[i]);
      }
      list.close();
      const uint32_t answered = bake::filter(list, c.question, hits);
      const bool all = answered == (1u << c.tubes.size()) - 1;
      kept += hits.count;
      for (size_t b = 0; b < c.tubes.size(); ++b) {
        bool enters = false;
        for (size_t i = 0; i < c.triangles.size(); ++i) {
          enters |= c.enters(i, c.tubes[b].decisive);
          if (all || (answered >> b & 1) != 0 || !c.enters(i, c.tubes[b].whole)) continue;
          ++entered;
          const auto end = hits.triangle.begin() + static_cast<ptrdiff_t>(hits.count);
          const auto hit = std::find(hits.triangle.begin(), end, i);
          ASSERT_NE(hit, end) << "round " << round << ", triangle " << i << ", tube " << b;
          ASSERT_NE(hits.tubes[static_cast<size_t>(hit - hits.triangle.begin())] >> b & 1, 0u);
        }
        if ((answered >> b & 1) == 0) continue;
        ++answers;
        ASSERT_TRUE(enters) << "round " << round << ", tube " << b;
      }
    }
    EXPECT_GT(answers, 1000u);
    EXPECT_GT(entered, 1000u);
    EXPECT_LT(kept, 3000u * 37 / 4);  // It is of use.
  });
}

TEST(TriangleFilter, AGlanceOverlooksNoTubeThatATriangleEnters) {
  test::for_every_simd_target([](const char* target) {
    SCOPED_TRACE(target);
    Dice dice{.seed = 5};
    size_t met = 0, entered = 0, passed = 0;
    for (int round = 0; round < 3000; ++round) {
      const Case c(dice);
      bake::FilterList list;
      list.clear(c.frame.centre + dice.point(20));
      const size_t few = 1 + static_cast<size_t>(round) % 20;  // else hardly a tube stays empty
      for (size_t i = 0; i < few; ++i) list.add(static_cast<uint32_t>(i), c.triangles[i]);
      list.close();
      std::vector<bake::BodySweep> tubes;
      for (const bake::FilterTube& tube : c.tubes) tubes.push_back(tube.whole);
      const uint32_t all = (1u << tubes.size()) - 1, some = static_cast<uint32_t>(round) & all;
      const uint32_t found = bake::glance(list, c.frame, tubes, all);
      // Others may grow the margin, but a tube that is not queried gets no answer.
      ASSERT_EQ(bake::glance(list, c.frame, tubes, some) & ~(found & some), 0u)
          << "round " << round;
      for (size_t b = 0; b < tubes.size(); ++b) {
        bool enters = false;
        for (size_t i = 0; i < few; ++i) enters |= c.enters(i, tubes[b]);
        ASSERT_TRUE(!enters || (found >> b & 1) != 0) << "round " << round << ", tube " << b;
        met += found >> b & 1;
        entered += enters;
        passed += !enters && (found >> b & 1) == 0;
      }
    }
    EXPECT_GT(entered, 1000u);
    EXPECT_GT(passed, 1000u);
    EXPECT_LT(met, 2 * entered);  // It is of use.
  });
}

TEST(TriangleFilter, WhatSurelyEntersAnUprightTubeDoesSo) {
  test::for_every_simd_target([](const char* target) {
    SCOPED_TRACE(target);
    Dice dice{.seed = 6};
    size_t sure = 0, rims = 0, entered = 0;
    for (int round = 0; round < 3000; ++round) {
      const Case c(dice);
      if (c.frame.up.y != 1) continue;
      bake::FilterList list;
      list.clear(c.frame.centre + dice.point(20));
      const size_t few = 1 + static_cast<size_t>(round) % 20;
      for (size_t i = 0; i < few; ++i) list.add(static_cast<uint32_t>(i), c.triangles[i]);
      list.close();
      for (const bake::FilterTube& tube : c.tubes) {
        bool enters = false;
        for (size_t i = 0; i < few; ++i) enters |= c.enters(i, tube.whole);
        const bool surely = bake::surely_enters(list, c.frame.centre, tube.whole);
        ASSERT_TRUE(enters || !surely) << "round " << round;
        sure += surely;
        entered += enters;
        const bool uphill =
            bake::surely_enters_uphill(list, c.frame.centre, {&tube.whole, 1}, 1) != 0;
        ASSERT_TRUE(enters || !uphill) << "round " << round;
        rims += uphill;
      }
    }
    EXPECT_GT(sure, 500u);
    EXPECT_GT(2 * sure, entered);  // It is of use.
    EXPECT_GT(rims, 150u);
  });
}

TEST(TriangleFilter, NarrowKeepsAllThatOverlapsTheBoxAndLittleElse) {
  test::for_every_simd_target([](const char* target) {
    SCOPED_TRACE(target);
    Dice dice{.seed = 4};
    bake::FilterList near;
    for (int round = 0; round < 300; ++round) {
      const Case c(dice);
      bake::FilterList list;
      list.clear(dice.point(5));
      for (size_t i = 0; i < c.triangles.size(); ++i) {
        list.add(static_cast<uint32_t>(i), c.triangles[i]);
      }
      list.close();
      Box3d box;
      box.add(c.frame.centre + dice.point(1));
      box.add(c.frame.centre + dice.point(1));
      bake::narrow(list, box, near);
      const auto gap = [&](size_t i) {  // between the boxes; negative: they overlap
        Box3d b;
        for (const Vec3d& p : c.triangles[i]) b.add(p);
        return std::max({b.min.x - box.max.x, box.min.x - b.max.x, b.min.y - box.max.y,
                         box.min.y - b.max.y, b.min.z - box.max.z, box.min.z - b.max.z});
      };
      const auto end = near.triangle.begin() + static_cast<ptrdiff_t>(near.count);
      for (size_t i = 0; i < c.triangles.size(); ++i) {
        const bool kept = std::find(near.triangle.begin(), end, i) != end;
        EXPECT_TRUE(kept || gap(i) > 0);
        EXPECT_FALSE(kept && gap(i) > 0.01);
      }
    }
  });
}

}  // namespace
}  // namespace throng
