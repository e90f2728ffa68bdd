// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "view/timeline_frame.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "throng/avatar.h"

// Hand-made frames of few avatars.
namespace throng {
namespace {

struct Body {
  uint64_t id;
  float x, z, heading;
};

view::TimelineFrame frame_of(double time, const std::vector<Body>& bodies) {
  view::TimelineFrame m;
  m.time = time;
  m.resize(bodies.size());
  for (size_t i = 0; i < bodies.size(); ++i) {
    m.ids[i] = bodies[i].id;
    m.x[i] = bodies[i].x;
    m.z[i] = bodies[i].z;
    m.heading[i] = bodies[i].heading;
  }
  return m;
}

view::Figures one_figure() {
  view::Figures figures;
  figures.of_class = {{0}};
  figures.shapes.resize(1);
  figures.shapes[0].clips = {
      {.name = "Walk", .first_frame = 0, .frames = 10, .seconds = 1, .stride = 1.5},
      {.name = "Idle", .first_frame = 10, .frames = 10, .seconds = 2, .stride = 0}};
  return figures;
}

TEST(TimelineFrame, FollowSumsTheDistanceOfEachAvatarWhileOthersComeAndGo) {
  view::TimelineFrame a = frame_of(0, {{3, 0, 0, 0.25F}, {5, 9, 9, 0.1F}});
  view::follow({}, a);
  view::TimelineFrame b = frame_of(1, {{3, 3, 4, 0.25F}, {4, 1, 1, 0.5F}});
  view::follow(a, b);
  EXPECT_NEAR(b.walked[0] - a.walked[0], 5, 1e-5);
  EXPECT_NEAR(b.speed[0], 5 * (1 - std::exp(-1 / 0.4)), 1e-4);
  EXPECT_EQ(b.speed[1], 0);
  view::TimelineFrame back = frame_of(0, {{3, 0, 0, 0.25F}});
  view::follow(b, back);  // Backwards in time: the distance shrinks again.
  EXPECT_NEAR(back.walked[0], a.walked[0], 1e-5);
}

TEST(TimelineFrame, FiguresTurnByTheSmallerAngleAndNotAtOnce) {
  view::TimelineFrame a = frame_of(0, {{1, 0, 0, 0.95F}});
  view::TimelineFrame b = frame_of(0.1, {{1, 0.2F, 0, 0.45F}});
  view::follow(a, b);  // Half a turn is required; 0.9 turns a second are allowed.
  const double turned = std::abs(std::remainder(b.heading[0] - 0.95, 1.0));
  EXPECT_NEAR(turned, 0.09, 1e-5);
  view::TimelineFrame c = frame_of(0.2, {{1, 0.4F, 0, 0.02F}});
  a.heading[0] = 0.97F;
  view::follow(a, c);  // Over zero: 0.05 turns, within the limit of 0.18.
  EXPECT_NEAR(c.heading[0], 0.02, 1e-5);
}

// Before a door people stop and start all the time; a figure that shuffles goes on standing.
TEST(TimelineFrame, FiguresDoNotChangeTheirClipWithEachSmallMove) {
  view::TimelineFrame before = frame_of(0, {{1, 0, 0, 0}});
  view::follow({}, before);
  const auto moves_after = [&](double speed, int steps) {
    for (int step = 0; step < steps; ++step) {
      view::TimelineFrame now = frame_of(before.time + 0.1, {{1, 0, before.z[0], 0}});
      now.z[0] += static_cast<float>(speed * 0.1);
      view::follow(before, now);
      before = now;
    }
    return before.moves[0] != 0;
  };
  EXPECT_FALSE(moves_after(0.15, 40));
  EXPECT_TRUE(moves_after(0.3, 40));
  EXPECT_TRUE(moves_after(0.15, 40));
  EXPECT_FALSE(moves_after(0.05, 40));
}

// Up and down 20 treads of 0.28 m by 0.17 m: floors are level within each.
TEST(TimelineFrame, FiguresDoNotHopOnStairs) {
  for (const double sign : {1.0, -1.0}) {
    view::TimelineFrame before = frame_of(0, {{1, 0, 0, 0}});
    view::follow({}, before);
    double most = 0;
    for (int step = 1; step < 80; ++step) {
      const double x = 0.07 * step, floor = sign * 0.17 * std::floor(x / 0.28);
      view::TimelineFrame now = frame_of(0.1 * step, {{1, static_cast<float>(x), 0, 0}});
      now.y[0] = static_cast<float>(floor);
      view::follow(before, now);
      most = std::max<double>(most, std::abs(now.y[0] - before.y[0]));
      EXPECT_NEAR(now.y[0], floor, 0.11) << x;
      before = now;
    }
    EXPECT_LT(most, 0.104);
  }
  // On ramps, and where a lift or a fall moves it, it stays near its floor.
  view::TimelineFrame low = frame_of(0, {{1, 0, 0, 0}}), high = frame_of(0.1, {{1, 0.1F, 0, 0}});
  high.y[0] = 0.1F;
  view::follow(low, high);
  EXPECT_FLOAT_EQ(high.y[0], 0.1F);
  high.y[0] = 5;
  view::follow(low, high);
  EXPECT_NEAR(high.y[0], 4.6, 1e-5);
}

TEST(TimelineFrame, AStandingAvatarKeepsItsHeading) {
  view::TimelineFrame a = frame_of(0, {{1, 0, 0, 0.4F}});
  view::TimelineFrame b = frame_of(0.1, {{1, 0, 0, 0}});
  view::follow(a, b);
  EXPECT_NEAR(b.heading[0], 0.4, 1e-6);
}

AvatarState climber(Vec3d at, Vec3d up, Vec3d goes) {
  const Vec3d ahead = unleaned(goes, up);
  return {.id = 1,
          .position = at,
          .heading_x = ahead.x,
          .heading_z = ahead.z,
          .velocity = {},
          .up = up};
}

Vec3d looks(const view::TimelineFrame& m, size_t i) {
  const double angle = 2 * std::numbers::pi * m.heading[i];
  return leaned({std::sin(angle), 0, std::cos(angle)}, m.up(i));
}

TEST(TimelineFrame, AClimberLeansAndFacesItsMove) {
  const double r = std::sqrt(0.5);
  view::TimelineFrame a, b;
  a.time = 1;
  b.time = 1.5;
  view::put_states({climber({0, 0, 0}, {0, 1, 0}, {-1, 0, 0})}, {}, a);
  EXPECT_TRUE(a.ups.empty());
  EXPECT_NEAR(length(looks(a, 0) - Vec3d{-1, 0, 0}), 0, 1e-6);
  view::follow({}, a);
  // Against a wall that faces +X, and up.
  view::put_states({climber({-0.3, 0.4, 0}, {1, 0, 0}, {0, 1, 0}),
                    AvatarState{.id = 5, .position = {}, .velocity = {}}},
                   {}, b);
  ASSERT_EQ(b.ups.size(), 2U);
  view::follow(a, b);
  EXPECT_NEAR(length(looks(b, 0) - Vec3d{0, 1, 0}), 0, 1e-5) << "no turn but that over the edge";
  EXPECT_NEAR(b.walked[0] - a.walked[0], 0.5, 1e-5);
  view::BlendedCrowd crowd;
  crowd.blend(a, b, 0.5, one_figure(), 1e9);
  EXPECT_NEAR(length(crowd.now().ups[0] - Vec3d{r, r, 0}), 0, 1e-6);
  EXPECT_NEAR(length(looks(crowd.now(), 0) - Vec3d{-r, r, 0}), 0, 1e-5);
  ASSERT_EQ(crowd.crowds().size(), 2U);  // One leans, one does not.
  size_t leaning = 0;
  for (const DrawnCrowd& drawn : crowd.crowds()) {
    EXPECT_TRUE(drawn.up_vectors.empty() || drawn.up_vectors.size() == drawn.avatars.x.size());
    leaning += drawn.up_vectors.size();
  }
  EXPECT_EQ(leaning, 1U);
  crowd.blend(a, a, 1, one_figure(), 1e9);
  EXPECT_TRUE(crowd.now().ups.empty());
}

// Along a ceiling, with axes that tilt a little to all sides.
TEST(TimelineFrame, AnAvatarUnderAnUnevenCeilingDoesNotSpin) {
  view::TimelineFrame before;
  for (int step = 0; step < 40; ++step) {
    const double turn = 2.1 * step, lean = 0.05;
    const Vec3d up{lean * std::cos(turn), -std::sqrt(1 - lean * lean), lean * std::sin(turn)};
    Vec3d goes = Vec3d{0, 0, 1} - up * up.z;
    goes = goes * (1 / length(goes));
    view::TimelineFrame now;
    now.time = 0.1 * step;
    view::put_states({climber({0, 0, 0.1 * step}, up, goes)}, {}, now);
    view::follow(before, now);
    EXPECT_TRUE(step < 7 || dot(looks(now, 0), goes) > 0.99) << step;  // (once it has turned)
    before = now;
  }
}

TEST(TimelineFrame, BlendsBetweenTwoFramesAndShowsNewAvatars) {
  view::TimelineFrame a = frame_of(1, {{1, 0, 0, 0.9F}, {2, 5, 5, 0}});
  view::TimelineFrame b = frame_of(2, {{1, 4, 8, 0.1F}, {7, 1, 2, 0.5F}});
  b.speed = {1.2F, 0};
  b.moves = {1, 0};
  view::BlendedCrowd crowd;
  crowd.blend(a, b, 0.25, one_figure(), 1e9);
  const view::TimelineFrame& now = crowd.now();
  ASSERT_EQ(now.size(), 2U);
  EXPECT_NEAR(now.time, 1.25, 1e-12);
  EXPECT_NEAR(now.x[0], 1, 1e-6);
  EXPECT_NEAR(now.z[0], 2, 1e-6);
  EXPECT_NEAR(now.heading[0], 0.95, 1e-6);
  EXPECT_EQ(now.ids[1], 7U);
  EXPECT_EQ(now.find(7), 1U);
  EXPECT_EQ(now.find(2), 2U);
  ASSERT_EQ(crowd.crowds().size(), 2U);  // One walks, one stands.
  EXPECT_EQ(crowd.crowds()[0].avatars.x.size(), 1U);
  EXPECT_EQ(crowd.crowds()[0].clip, 0U);
  EXPECT_EQ(crowd.crowds()[1].clip, 1U);
}

TEST(TimelineFrame, DoesNotDrawAvatarsAboveTheCutOrWithTheEye) {
  view::TimelineFrame a = frame_of(0, {{1, 0, 0, 0}, {2, 1, 0, 0}, {3, 2, 0, 0}});
  a.y = {0, 6, 0};
  view::BlendedCrowd crowd;
  crowd.hide(3);
  crowd.blend(a, a, 1, one_figure(), 5);
  ASSERT_EQ(crowd.crowds().size(), 1U);
  EXPECT_EQ(crowd.crowds()[0].avatars.x.size(), 1U);
  EXPECT_EQ(crowd.now().size(), 3U);
}

}  // namespace
}  // namespace throng
