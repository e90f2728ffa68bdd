// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "crowd/walk/sense_kernel.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "core/arrays/compress-inl.h"
#include "core/random.h"

namespace throng::crowd {
namespace {

constexpr uint64_t kSeed = 17;

TEST(Compress, OrdersHaveAllLanesOnceAndThoseThatAreSetFirst) {
  for (uint32_t mask = 0; mask < kCompressOrders.size(); ++mask) {
    std::vector<uint32_t> lanes, expected;
    for (uint32_t k = 0; k < 8; ++k) lanes.push_back(kCompressOrders[mask] >> (4 * k) & 15);
    for (const bool set : {true, false}) {
      for (uint32_t lane = 0; lane < 8; ++lane) {
        if (((mask >> lane & 1) != 0) == set) expected.push_back(lane);
      }
    }
    EXPECT_EQ(lanes, expected) << mask;
  }
}

// Random bodies on a plane with two floors; a plain loop finds what is seen and touched.
TEST(SenseKernel, FindsWhatAPlainLoopFinds) {
  constexpr size_t kBodies = 300;
  uint64_t draws = 0;
  const auto draw = [&](uint64_t below) { return random_below(kSeed, 0, draws++, below); };
  std::vector<int32_t> x(kBodies + kSeenSpare), z(x.size()), y(x.size());
  size_t seen = 0, touched = 0, kept = 0;
  for (int run = 0; run < 400; ++run) {
    for (size_t i = 0; i < kBodies; ++i) {
      x[i] = static_cast<int32_t>(draw(20000));
      z[i] = static_cast<int32_t>(draw(20000));
      y[i] = draw(3) == 0 ? 3000 : static_cast<int32_t>(draw(100));
    }
    const auto self = static_cast<uint32_t>(draw(kBodies));
    const float sight = run % 4 == 0 ? 0 : static_cast<float>(1000 + draw(9000));
    const float reach = run % 3 == 0 ? 0 : static_cast<float>(draw(3000));
    const Eye eye{.x = x[self],
                  .z = z[self],
                  .y = y[self],
                  .self = self,
                  .max_square = sight * sight,
                  .tall = 1700,
                  .touch = reach * reach,
                  .touch_tall = 2000};
    std::vector<Entries> pieces;
    for (uint32_t at = 0; at < kBodies;) {
      const auto first = static_cast<uint32_t>(at + draw(30));
      const auto last = std::min<uint32_t>(kBodies, first + 1 + static_cast<uint32_t>(draw(40)));
      if (first < last) pieces.push_back({first, last});
      at = last;
    }
    std::vector<float> squares(2 * kBodies);
    std::vector<uint32_t> entries(2 * kBodies), touches(2 * kBodies), near, close;
    std::vector<float> far;
    SeenLists lists{squares.data(), entries.data(), touches.data()};
    find_seen({x.data(), z.data(), y.data()}, pieces, eye, lists);
    for (const Entries& piece : pieces) {
      for (uint32_t i = piece.first; i < piece.last; ++i) {
        if (i == self) continue;
        const auto dx = static_cast<float>(x[i] - eye.x), dz = static_cast<float>(z[i] - eye.z);
        const float square = dx * dx + dz * dz;
        if (square < eye.max_square && std::abs(y[i] - eye.y) < eye.tall) {
          near.push_back(i);
          far.push_back(square);
        }
        if (square < eye.touch && std::abs(y[i] - eye.y) < eye.touch_tall) close.push_back(i);
      }
    }
    ASSERT_EQ(std::vector<uint32_t>(entries.begin(),
                                    entries.begin() + static_cast<ptrdiff_t>(lists.seen)),
              near)
        << run;
    ASSERT_EQ(
        std::vector<float>(squares.begin(), squares.begin() + static_cast<ptrdiff_t>(lists.seen)),
        far)
        << run;
    ASSERT_EQ(std::vector<uint32_t>(touches.begin(),
                                    touches.begin() + static_cast<ptrdiff_t>(lists.touches)),
              close)
        << run;
    constexpr size_t kNearest = 8;
    const size_t count = keep_nearest(lists, kNearest);
    std::vector<uint32_t> nearest;
    for (size_t n = 0; n < near.size(); ++n) {
      const auto nearer =
          std::count_if(far.begin(), far.end(), [&](float f) { return f < far[n]; });
      if (nearer < static_cast<ptrdiff_t>(kNearest)) nearest.push_back(near[n]);
    }
    ASSERT_EQ(
        std::vector<uint32_t>(entries.begin(), entries.begin() + static_cast<ptrdiff_t>(count)),
        nearest)
        << run;
    seen += near.size();
    touched += close.size();
    kept += count;
  }
  EXPECT_GT(seen, 5000u);
  EXPECT_GT(touched, 500u);
  EXPECT_GT(kept, 1500u);
}

}  // namespace
}  // namespace throng::crowd
