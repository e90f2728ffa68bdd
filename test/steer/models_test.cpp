// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "steer/models.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <string>

#include "throng/papers.h"

namespace throng::steer {
namespace {

constexpr SteeringModel kCurves = SteeringModel::kCurvilinear,
                        kForces = SteeringModel::kSocialForce;

View walker(Plane velocity, Plane to_target = {100, 0}) {
  return {.velocity = velocity,
          .preferred = {1.3f, 0},
          .to_target = to_target,
          .fastest = 1.3f,
          .radius = 0.25f,
          .slot = 3,
          .others = {}};
}

TEST(SteeringModels, NamesAreReadAsTheyAreWritten) {
  for (const SteeringModel model : {SteeringModel::kSampled, kCurves, kForces}) {
    EXPECT_EQ(find_steering_model(name_of(model)), model);
    EXPECT_NE(std::string(steering_model_names()).find(name_of(model)), std::string::npos);
  }
  EXPECT_FALSE(find_steering_model("orca"));
}

// v(t) = preferred (1 - e^(-t / 0.5 s)), here by four Euler steps a tenth of a second.
TEST(SteeringModels, AForceApproachesThePreferredVelocityByItsRelaxation) {
  const Plane v = preferred_velocity(kForces, walker({}), 0.1f);
  EXPECT_NEAR(v.x, 1.3 * (1 - std::pow(1 - 0.025 / 0.5, 4)), 1e-6);
  EXPECT_EQ(v.z, 0);
}

// A unit is 0.05 m, the greatest speed 0.4 units a frame: 65 frames a second, in which MaxForce /
// Mass changes the speed by 0.03 units a frame, each.
TEST(SteeringModels, ACurveApproachesThePreferredVelocityByItsMaxForce) {
  const Plane v = preferred_velocity(kCurves, walker({}), 0.1f);
  EXPECT_NEAR(v.x, std::min(1.3, 6.5 * 0.03 * 0.05 * 65), 1e-6);
  EXPECT_EQ(v.z, 0);
  EXPECT_NEAR(preferred_velocity(kCurves, walker({1.3f, 0}), 0.1f).x, 1.3, 1e-6);
}

TEST(SteeringModels, ACurveBrakesBeforeTheGoalAndNotBeforeACorner) {
  View view = walker({1.3f, 0}, {0.5f, 0});  // 10 units; braking begins 30 before
  EXPECT_LT(preferred_velocity(kCurves, view, 0.1f).x, 1.2f);
  view.stops = false;
  EXPECT_NEAR(preferred_velocity(kCurves, view, 0.1f).x, 1.3, 1e-6);
}

// By the equations themselves, in a step that needs no parts.
TEST(SteeringModels, ACurveIsThatOfTheEquations) {
  const std::array<Other, 2> others{
      {{{1, 0.1f}, {-1.3f, 0}, 0.25f, 7}, {{0.6f, 0.9f}, {0, -0.5f}, 0.3f, 8}}};
  View view = walker({1.2f, 0.1f});
  view.others = others;
  const float dt = 2.0f / 65;  // two frames
  caacd::Model model;
  const double speed = 20.0 / 65;
  const auto body = [&](Plane at, Plane velocity, double radius, uint32_t id) {
    return caacd::Body{.position = Vec3d{at.x, 0, at.z} * 20,
                       .velocity = Vec3d{velocity.x, 0, velocity.z} * speed,
                       .fields = {20 * radius, 30 * radius, 48 * radius},
                       .id = id};
  };
  caacd::Body self = body({}, view.velocity, 0.25, 3);
  self.forward = caacd::heading_of(self.velocity, {1, 0, 0});
  const std::array<caacd::Body, 2> near{body(others[0].at, others[0].velocity, 0.25, 7),
                                        body(others[1].at, others[1].velocity, 0.3f, 8)};
  const caacd::Threat threat = caacd::greatest_threat(self, near, {}, model);
  ASSERT_NE(threat.state, caacd::State::kTolerable);
  const Vec3d v = caacd::steered(self.velocity, caacd::avoidance(self, threat, model), 2, model);
  const Plane got = preferred_velocity(kCurves, view, dt);
  EXPECT_NEAR(got.x, v.x / speed, 1e-5);
  EXPECT_NEAR(got.z, v.z / speed, 1e-5);
}

TEST(SteeringModels, AnOpposedAvatarLeavesItsLineAndIsNeverTooFast) {
  for (const SteeringModel model : {kCurves, kForces}) {
    for (int k = 1; k < 200; ++k) {  // exactly head-on forces have no side
      const std::array<Other, 1> other{
          {{{1.1f, 0.3f * std::sin(0.1f * static_cast<float>(k))}, {-1.3f, 0}, 0.25f, 7}}};
      View view = walker({1.3f, 0});
      view.others = other;
      const Plane v = preferred_velocity(model, view, 0.1f);
      EXPECT_NE(v.z, 0) << name_of(model);
      EXPECT_LE(size_of(v), 1.3f + 1e-5f);
    }
  }
}

TEST(SteeringModels, AWallPushesAnAvatarOfTheForceModel) {
  View view = walker({1.3f, 0});
  view.has_wall = true;
  view.wall = {0, 0.3f};
  const Plane v = preferred_velocity(kForces, view, 0.01f);
  EXPECT_NEAR(v.z, -0.01 * 10 / 0.2 * std::exp(-0.3 / 0.2), 1e-3);
}

TEST(SteeringModels, CandidatesBeginWithThePreferredVelocity) {
  const Choices candidates = candidates_about({0, 1});
  EXPECT_EQ(candidates[0].z, 1);
  EXPECT_NEAR(candidates[1].x, -0.5, 1e-6);  // 30 degrees to the right of Z, seen from above
  EXPECT_NEAR(candidates[2].x, 0.5, 1e-6);
  EXPECT_NEAR(candidates[5].x, -1, 1e-6);
  EXPECT_NEAR(candidates[6].x, 1, 1e-6);
  EXPECT_EQ(candidates[7].z, 0.75f);
  for (const Plane& v : candidates_about({})) EXPECT_EQ(size_of(v), 0);
}

// In a plane, along the side axis, the air is the ground.
TEST(SteeringModels, ACurveInTheAirIsThatOnFootIfNothingRises) {
  const std::array<Other, 1> others{{{{1, 0.1f}, {-1.3f, 0}, 0.25f, 7}}};
  View view = walker({1.2f, 0.1f});
  view.others = others;
  AirSituation situation{.velocity = {1.2f, 0, 0.1f},
                         .preferred = {1.3f, 0, 0},
                         .fastest = 1.3f,
                         .height = 1.8f,
                         .size = 1,
                         .near = {}};
  situation.near[0] = {{1, 0, 0.1f}, {-1.3f, 0, 0}, 0.5f, 1.8f, 7};
  const AirView air{.to_target = {100, 0, 0}, .stops = true, .radius = 0.25f, .slot = 3};
  const Plane on_foot = preferred_velocity(kCurves, view, 0.1f);
  const Space in_air = curvilinear_in_air(situation, air, 0.1f, {.axes = caacd::Axes::kSide});
  EXPECT_NEAR(in_air.x, on_foot.x, 1e-6);
  EXPECT_NEAR(in_air.z, on_foot.z, 1e-6);
  EXPECT_EQ(in_air.y, 0);
  // The other comes a little higher: the up axis leads below it, the side axis does not.
  situation.near[0].at.y = 0.5f;
  EXPECT_EQ(curvilinear_in_air(situation, air, 0.1f, {.axes = caacd::Axes::kSide}).y, 0);
  EXPECT_LT(curvilinear_in_air(situation, air, 0.1f, {.axes = caacd::Axes::kSideAndUp}).y, -0.1f);
}

}  // namespace
}  // namespace throng::steer
