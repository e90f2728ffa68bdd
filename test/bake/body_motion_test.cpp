// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "bake/surface/body_motion.h"

#include <gtest/gtest.h>

namespace throng {
namespace {

// A strip of three pieces, the middle one of which may be blocked.
Scene strip(AreaKind middle) {
  Scene scene;
  for (int i = 0; i < 3; ++i) {
    scene.add_quad({2.0 * i, 0, 0}, {2.0 * i, 0, 2}, {2.0 * i + 2, 0, 2}, {2.0 * i + 2, 0, 0},
                   i == 1 ? middle : kAreaWalkable);
  }
  return scene;
}

TEST(MotionJudge, OnlyGroundThatIsNotBlockedCarries) {
  for (const AreaKind kind : {kAreaWalkable, kAreaBlocked}) {
    const Scene scene = strip(kind);
    const bake::TriangleSquares triangles(scene, 1);
    bake::MotionJudge judge(triangles);
    EXPECT_TRUE(judge.is_supported({0.5, 0, 1}, {1.5, 0, 1}, 0.1, 0.1));
    EXPECT_EQ(judge.is_supported({0.5, 0, 1}, {5.5, 0, 1}, 0.1, 0.1), kind == kAreaWalkable);
    EXPECT_FALSE(judge.is_supported({4.5, 0, 1}, {6.5, 0, 1}, 0.1, 0.1));  // beyond the end
    EXPECT_FALSE(judge.is_supported({0.5, 1, 1}, {1.5, 1, 1}, 0.1, 0.1));  // over it
  }
}

}  // namespace
}  // namespace throng
