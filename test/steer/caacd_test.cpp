// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "core/random.h"
#include "throng/papers.h"

// Each equation of [CAACD] against values worked out by hand, then what must hold for any input.
namespace throng::caacd {
namespace {

constexpr Fields kFields{5, 7.5, 10};

Body body(double x, double z, double vx, double vz, uint32_t id = 0) {
  return {.position = {x, 0, z},
          .velocity = {vx, 0, vz},
          .forward = heading_of({vx, 0, vz}, {1, 0, 0}),
          .fields = kFields,
          .id = id};
}

// Speeds of about 1 a frame, as in the examples below.
Model brisk(Trigger trigger = Trigger::kThreat) {
  return {.mass = 2, .max_speed = 2, .max_force = 0.5, .trigger = trigger};
}

void expect_near(Vec3d a, Vec3d b, double tolerance = 1e-12) {
  EXPECT_NEAR(a.x, b.x, tolerance);
  EXPECT_NEAR(a.y, b.y, tolerance);
  EXPECT_NEAR(a.z, b.z, tolerance);
}

TEST(Caacd, FieldsOfAPairAreSums) {
  const Fields joint = joint_fields({1, 2, 3}, {10, 20, 30});
  EXPECT_EQ(joint.repulsive, 11);
  EXPECT_EQ(joint.precaution, 22);
  EXPECT_EQ(joint.alert, 33);
}

TEST(Caacd, EveryStateAndEveryBoundBetweenThem) {
  const Fields joint{1, 2, 3};
  EXPECT_EQ(state_at(3.5, joint), State::kTolerable);
  EXPECT_EQ(state_at(std::nextafter(3.0, 4.0), joint), State::kTolerable);
  EXPECT_EQ(state_at(3, joint), State::kAlert);
  EXPECT_EQ(state_at(std::nextafter(2.0, 3.0), joint), State::kAlert);
  EXPECT_EQ(state_at(2, joint), State::kCritical);
  EXPECT_EQ(state_at(std::nextafter(1.0, 2.0), joint), State::kCritical);
  EXPECT_EQ(state_at(1, joint), State::kCollision);
  EXPECT_EQ(state_at(0, joint), State::kCollision);
}

TEST(Caacd, TimeOfNearestApproachByEquations1To6) {
  // Rv = (-1, -1), Rs = sqrt 2, Rp = (-10, -4), Rd = 14 / sqrt 2, so A_tau = 14 / 2.
  const Body a = body(0, 0, 1, 0), b = body(10, 4, 0, -1);
  EXPECT_DOUBLE_EQ(nearest_approach(a, b).speed, std::sqrt(2.0));
  EXPECT_NEAR(nearest_approach(a, b).time, 7, 1e-14);
  EXPECT_NEAR(nearest_approach(b, a).time, 7, 1e-14);
  // Back in time: they part.
  EXPECT_NEAR(nearest_approach(body(0, 0, -1, 0), body(10, 4, 0, 1)).time, -7, 1e-14);
}

TEST(Caacd, PositionsThenByEquations7To9) {
  const Body a = body(0, 0, 1, 0), b = body(10, 4, 0, -1);
  expect_near(position_at(a, 7), {7, 0, 0});
  expect_near(position_at(b, 7), {10, 0, -3});
  const Threat threat = threat_of(a, b, brisk());
  expect_near(threat.self_then, {7, 0, 0});
  expect_near(threat.other_then, {10, 0, -3});
  EXPECT_NEAR(threat.distance, std::sqrt(18.0), 1e-12);
  EXPECT_EQ(threat.state, State::kCritical);  // 4.24 <= 15
}

TEST(Caacd, LengthByEquation10) {
  Model model = brisk();
  EXPECT_DOUBLE_EQ(convergence_distance({3, -1, -4}, model), std::sqrt(26.0));
  model.length = Length::kMaxAndSum;
  model.lambda1 = 0.75;  // 4 x 0.75 + (8 - 4) x 0.25
  EXPECT_DOUBLE_EQ(convergence_distance({3, -1, -4}, model), 4);
  model.lambda1 = 1;
  EXPECT_DOUBLE_EQ(convergence_distance({3, -1, -4}, model), 4);
  model.lambda1 = 0.5;
  EXPECT_DOUBLE_EQ(convergence_distance({-6, 0, 2}, model), 4);
}

TEST(Caacd, LengthByEquation10StaysWithinItsBounds) {
  for (uint64_t i = 0; i < 20000; ++i) {
    const auto unit = [&](uint64_t k) { return 2 * random_unit(1, i, k) - 1; };
    const Vec3d flat{unit(0), 0, unit(1)}, any{unit(2), unit(3), unit(4)};
    const double lambda1 = 0.5 + 0.5 * random_unit(1, i, 5);
    const Model model{.lambda1 = lambda1, .length = Length::kMaxAndSum};
    const double low = std::min(lambda1, std::sqrt(0.5));
    const double high = std::hypot(lambda1, 1 - lambda1);
    EXPECT_GE(convergence_distance(flat, model), low * length(flat) * (1 - 1e-12));
    EXPECT_LE(convergence_distance(flat, model), high * length(flat) * (1 + 1e-12));
    EXPECT_GE(convergence_distance(any, model),
              std::min(low, (2 - lambda1) / std::sqrt(3.0)) * length(any) * (1 - 1e-12));
  }
}

TEST(Caacd, AThreatIsJudgedByTimeAndDistanceThen) {
  const Model model = brisk();
  const auto state = [&](double distance_then, double start) {
    return threat_of(body(0, 0, 1, 0), body(start, distance_then, -1, 0), model).state;
  };
  EXPECT_EQ(state(0, 50), State::kCritical);
  EXPECT_EQ(state(15, 50), State::kCritical);  // r_pre = 7.5 + 7.5
  EXPECT_EQ(state(15.01, 50), State::kAlert);
  EXPECT_EQ(state(20, 50), State::kAlert);  // r_alert = 10 + 10
  EXPECT_EQ(state(20.01, 50), State::kTolerable);
  EXPECT_EQ(state(0, 119.9), State::kCritical);  // 59.95 frames
  EXPECT_EQ(state(0, 120), State::kTolerable);   // T3 itself is too late
  EXPECT_EQ(state(0, -1), State::kTolerable);    // they part
  EXPECT_EQ(state(0, 0), State::kCritical);      // now
}

TEST(Caacd, ParallelCoursesAreJudgedByTheirPresentDistance) {
  const Model model = brisk();
  const auto beside = [&](double z) {
    return threat_of(body(0, 0, 1, 0), body(0, z, 1, 0, 1), model);
  };
  EXPECT_EQ(nearest_approach(body(0, 0, 1, 0), body(0, 9, 1, 0)).time, 0);
  EXPECT_EQ(beside(12).state, State::kCritical);
  EXPECT_EQ(beside(18).state, State::kAlert);
  EXPECT_EQ(beside(21).state, State::kTolerable);
  EXPECT_EQ(beside(12).time, 0);
  EXPECT_EQ(beside(12).distance, 12);
}

TEST(Caacd, OnlyABodyInTheAlertFieldIsAThreat) {
  const Model near = brisk(Trigger::kNear);
  EXPECT_EQ(threat_of(body(0, 0, 1, 0), body(20.1, 0, -1, 0), near).state, State::kTolerable);
  EXPECT_EQ(threat_of(body(0, 0, 1, 0), body(20, 0, -1, 0), near).state, State::kCritical);
  // In it, but leaving it.
  EXPECT_EQ(threat_of(body(0, 0, -1, 0), body(12, 0, 1, 0), near).state, State::kTolerable);
  EXPECT_EQ(threat_of(body(0, 0, 1, 0), body(12, 0, -1, 0), brisk(Trigger::kNever)).state,
            State::kTolerable);
}

TEST(Caacd, ZonesAreRectanglesAheadAsWideAsTheRepulsiveField) {
  Model model = brisk(Trigger::kZones);
  const Body a = body(0, 0, 1, 0);  // x from 0 to 7.5, z from -5 to 5
  EXPECT_DOUBLE_EQ(probe_length(a, model), 7.5);
  EXPECT_TRUE(probes_meet(a, body(14.9, 0, -1, 0), model));
  EXPECT_FALSE(probes_meet(a, body(15.1, 0, -1, 0), model));
  EXPECT_TRUE(probes_meet(a, body(3, 9.9, 1, 0), model));
  EXPECT_FALSE(probes_meet(a, body(3, 10.1, 1, 0), model));
  EXPECT_FALSE(probes_meet(a, body(-7.6, 0, 1, 0), model));  // behind, its zone ends at -0.1
  EXPECT_TRUE(probes_meet(a, body(-7.4, 0, 1, 0), model));
  // Corner to corner: at 45 degrees the rectangle's corner is cut, boxes around them overlap.
  EXPECT_FALSE(probes_meet(a, body(16, 13, 1, 1), model));
  model.probe_time = 10;
  EXPECT_DOUBLE_EQ(probe_length(a, model), 17.5);
  EXPECT_TRUE(probes_meet(a, body(22, 0, -1, 0), model));
}

TEST(Caacd, ZonesMeetIffSomePointLiesInBoth) {
  // Oracle: a fine net of points of one rectangle, tested in the other's own axes.
  const Model model = brisk(Trigger::kZones);
  const auto inside = [&](const Body& b, Vec3d p, double slack) {
    const Vec3d d = p - b.position;
    const double along = dot(d, b.forward), aside = dot(d, right_of(b.forward));
    return along >= -slack && along <= probe_length(b, model) + slack &&
           std::fabs(aside) <= b.fields.repulsive + slack;
  };
  int meet = 0, apart = 0;
  for (uint64_t i = 0; i < 3000; ++i) {
    const auto unit = [&](uint64_t k) { return 2 * random_unit(2, i, k) - 1; };
    const Body a = body(0, 0, unit(0), unit(1));
    const Body b = body(14 * unit(2), 14 * unit(3), unit(4), unit(5));
    bool certain = false, possible = false;
    for (int u = 0; u <= 40; ++u) {
      for (int v = -40; v <= 40; ++v) {
        const Vec3d p = a.position + a.forward * (probe_length(a, model) * u / 40) +
                        right_of(a.forward) * (a.fields.repulsive * v / 40);
        certain |= inside(b, p, -1e-9);
        possible |= inside(b, p, 0.25);
      }
    }
    const bool found = probes_meet(a, b, model);
    EXPECT_EQ(found, probes_meet(b, a, model));
    EXPECT_TRUE(found || !certain) << i;
    EXPECT_TRUE(!found || possible) << i;
    meet += certain;
    apart += !possible;
  }
  EXPECT_GT(meet, 500);
  EXPECT_GT(apart, 500);
}

TEST(Caacd, ObstaclesThreatenWhenTheZoneOverlapsTheirPrecautionField) {
  const Model model = brisk();
  const Fields fields{10, 15, 25};
  const auto state = [&](const Body& a, double x, double z) {
    return threat_of(a, Obstacle{{x, 0, z}, fields}, model).state;
  };
  EXPECT_EQ(state(body(0, 0, 1, 0), 22.6, 0), State::kTolerable);  // 7.5 + 15
  EXPECT_EQ(state(body(0, 0, 1, 0), 22.4, 0), State::kCritical);
  EXPECT_EQ(state(body(0, 0, 1, 0), 5, 19.9), State::kCritical);  // 5 + 15 beside
  EXPECT_EQ(state(body(0, 0, 1, 0), 5, 20.1), State::kTolerable);
  EXPECT_EQ(state(body(0, 0, 1, 0), -3, 12), State::kTolerable);  // behind
  const Threat threat = threat_of(body(0, 2, 0.5, 0), Obstacle{{20, 0, 0}, fields}, model);
  EXPECT_DOUBLE_EQ(threat.time, 40);
  EXPECT_DOUBLE_EQ(threat.distance, 2);
  EXPECT_EQ(threat.id, Threat::kObstacle);
  expect_near(threat.other_then, {20, 0, 0});
}

TEST(Caacd, TheGreatestThreatIsTheSoonestThenTheNearestThenTheLowestId) {
  const Model model = brisk();
  const Body self = body(0, 0, 1, 0, 9);
  const std::vector<Body> others = {
      self,                    // not itself
      body(40, 0, -1, 0, 1),   // in 20 frames, through the middle
      body(30, 12, -1, 0, 2),  // in 15, 12 away
      body(30, 3, -1, 0, 7),   // in 15, 3 away
      body(30, -3, -1, 0, 5),  // the same on the other side
      body(2, 30, 0, 0.5, 3),  // parts
  };
  EXPECT_EQ(greatest_threat(self, others, {}, model).id, 5u);
  EXPECT_EQ(greatest_threat(self, std::span(others).first(4), {}, model).id, 7u);
  EXPECT_EQ(greatest_threat(self, std::span(others).first(3), {}, model).id, 2u);
  EXPECT_EQ(greatest_threat(self, std::span(others).first(2), {}, model).id, 1u);
  EXPECT_EQ(greatest_threat(self, std::span(others).first(1), {}, model).state, State::kTolerable);
  const std::vector<Obstacle> wall = {{{20, 0, 0}, {8, 13, 20}}};
  EXPECT_EQ(greatest_threat(self, std::span(others).first(2), wall, model).id, 1u);  // 20 and 20,
  const Body faster = body(20.5, 0, -1.2, 0, 1);
  EXPECT_EQ(greatest_threat(self, std::array<Body, 1>{faster}, wall, model).id, 1u);
  EXPECT_EQ(greatest_threat(self, {}, wall, model).id, Threat::kObstacle);
}

TEST(Caacd, LateralAvoidanceByEquation11) {
  const Model model = brisk();
  // Ap - Bcp = (-20, 4); heading +x, the right is +z: ((Ap - Bcp).side) side = (0, 4).
  Threat threat{.time = 10, .now = {30, 0, -4}, .self_then = {10, 0, 0}, .other_then = {20, 0, -4}};
  expect_near(lateral_avoidance(body(0, 0, 1, 0), threat, model), {0, 0, 4});
  // Heading (3, 4) / 5, right (-4, 3) / 5: (-20, 4).(-4, 3) / 5 = 92 / 5.
  expect_near(lateral_avoidance(body(0, 0, 3, 4), threat, model),
              {-4.0 / 5 * 92 / 5, 0, 3.0 / 5 * 92 / 5});
  // Flyers push up as well.
  Model flyer = model;
  flyer.axes = Axes::kSideAndUp;
  threat.other_then = {20, -3, -4};
  expect_near(lateral_avoidance(body(0, 0, 1, 0), threat, flyer), {0, 3, 4});
  expect_near(lateral_avoidance(body(0, 0, 1, 0), threat, model), {0, 0, 4});
}

TEST(Caacd, ForwardAvoidanceByEquations12And13) {
  Model model = brisk();  // lambda3 x max_speed = 1
  const Threat threat{.now = {20, 0, -5}, .self_then = {8, 0, 3}, .other_then = {10, 0, -5}};
  expect_near(forward_avoidance(body(0, 0, 0.99, 0), threat, model), {1, 0, 0});   // eq. 12
  expect_near(forward_avoidance(body(0, 0, 1.01, 0), threat, model), {-2, 0, 0});  // eq. 13
  expect_near(forward_avoidance(body(0, 0, 1, 0), threat, model), {-2, 0, 0});
  expect_near(forward_avoidance(body(0, 0, 0, 1.5), threat, model), {0, 0, 8});
  model.lambda3 = 0;
  expect_near(forward_avoidance(body(0, 0, 0, 0), threat, model), {-2, 0, 0});
}

TEST(Caacd, SteeringByEquation14AndItsLimit) {
  Model model = brisk();
  model.max_force = 100;
  const Threat threat{.now = {30, 0, -4}, .self_then = {12, 0, 0}, .other_then = {9, 0, -4}};
  expect_near(avoidance(body(0, 0, 1.5, 0), threat, model), {3, 0, 4});
  model.max_force = 0.5;
  expect_near(avoidance(body(0, 0, 1.5, 0), threat, model), {0.3, 0, 0.4});
}

TEST(Caacd, VelocityByEquation15WithMassAndLimits) {
  const Model model = brisk();
  expect_near(steered({1, 0, 0}, {0.3, 0, 0.4}, 1, model), {1.15, 0, 0.2});
  expect_near(steered({1, 0, 0}, {0.3, 0, 0.4}, 0.5, model), {1.075, 0, 0.1});
  expect_near(steered({1, 0, 0}, {3, 0, 4}, 1, model), {1.15, 0, 0.2});  // max_force 0.5
  expect_near(steered({1.99, 0, 0}, {0.5, 0, 0}, 1, model), {2, 0, 0});  // max_speed 2
  expect_near(steered({3, 0, 4}, {}, 1, model), {1.2, 0, 1.6});
}

TEST(Caacd, AChangeIsTangentialAndCentripetal) {
  const Curvilinear change = curvilinear({0.6, 0, 0.8}, {1, 0, 0});
  EXPECT_DOUBLE_EQ(change.tangential, 0.6);
  EXPECT_NEAR(change.centripetal, 0.8, 1e-15);
  EXPECT_LT(curvilinear({1, 0, 0}, {-2, 0, 0}).tangential, 0);
}

TEST(Caacd, PathAmendmentTurnsToTheTargetAndBrakesEvenly) {
  Model model = brisk();
  model.max_force = 100;
  model.deceleration = 32;
  // Full speed from far off, with the root of the distance left from psi on, none at the target.
  expect_near(path_amendment(body(0, 0, 0, 0), {100, 0, 0}, 0, model), {2, 0, 0});
  expect_near(path_amendment(body(0, 0, 0, 0), {0, 0, 8}, 0, model), {0, 0, 1});
  expect_near(path_amendment(body(0, 0, 1, 0.5), {0, 0, 2}, 0, model), {-1, 0, 0});
  expect_near(path_amendment(body(0, 0, 1, 0), {0, 0, 0}, 0, model), {-1, 0, 0});
  // A waiting body stops before the target, and stops at once if it is nearer already.
  expect_near(path_amendment(body(0, 0, 0, 0), {0, 0, 20}, 12, model), {0, 0, 1});
  expect_near(path_amendment(body(0, 0, 0.5, 0), {0, 0, 10}, 12, model), {-0.5, 0, 0});
  model.max_force = 0.5;
  expect_near(path_amendment(body(0, 0, 0, 0), {30, 0, 40}, 0, model), {0.3, 0, 0.4});
}

TEST(Caacd, HeadOnBothGoToTheirRight) {
  const Model model = brisk();
  const Body a = body(0, 0, 1.5, 0, 0), b = body(30, 0, -1.5, 0, 1);
  const Vec3d push_a = avoidance(a, threat_of(a, b, model), model);
  const Vec3d push_b = avoidance(b, threat_of(b, a, model), model);
  expect_near(push_a, {0, 0, 0.5});   // its right is +z
  expect_near(push_b, {0, 0, -0.5});  // and the other's -z
}

TEST(Caacd, OvertakingTheRearGoesRightAndTheFrontLeft) {
  const Model model = brisk();
  const Body rear = body(0, 0, 1.8, 0, 0), front = body(20, 0, 1.1, 0, 1);
  EXPECT_GT(avoidance(rear, threat_of(rear, front, model), model).z, 0.4);
  EXPECT_LT(avoidance(front, threat_of(front, rear, model), model).z, -0.4);
}

TEST(Caacd, CrossingTheLaterOneBrakesAndTheEarlierOneGoesOn) {
  const Model model = brisk();
  const Body early = body(-18, 0, 1.5, 0, 0), late = body(0, -22, 0, 1.5, 1);
  const Threat seen = threat_of(late, early, model);
  EXPECT_EQ(seen.state, State::kCritical);
  EXPECT_LT(forward_avoidance(late, seen, model).z, 0);
  EXPECT_GT(forward_avoidance(early, threat_of(early, late, model), model).x, 0);
}

TEST(Caacd, BodiesAtOnePointPart) {
  const Model model = brisk();
  const Body a = body(3, 3, 1, 0, 4), b = body(3, 3, 1, 0, 8);
  const Threat ta = threat_of(a, b, model), tb = threat_of(b, a, model);
  EXPECT_EQ(ta.state, State::kCritical);
  EXPECT_EQ(ta.distance, 0);
  expect_near(lateral_avoidance(a, ta, model), {0, 0, 0.5});  // the smaller id to its right
  expect_near(lateral_avoidance(b, tb, model), {0, 0, -0.5});
}

TEST(Caacd, TheNearerBodyGoesFirstAndThenTheSmallerId) {
  const Vec3d place{0, 0, 0};
  EXPECT_TRUE(goes_first(body(3, 0, 1, 0, 9), place, body(4, 0, 1, 0, 1), place));
  EXPECT_FALSE(goes_first(body(4, 0, 1, 0, 1), place, body(3, 0, 1, 0, 9), place));
  EXPECT_TRUE(goes_first(body(3, 0, 1, 0, 1), place, body(0, -3, 1, 0, 9), place));
  EXPECT_FALSE(goes_first(body(0, -3, 1, 0, 9), place, body(3, 0, 1, 0, 1), place));
}

TEST(Caacd, SettingsOutOfTheirLimitsAreNamed) {
  EXPECT_TRUE(check_model({}));
  const auto refused = [](const Model& model) {
    const auto ok = check_model(model);
    return ok ? std::string("accepted") : ok.error().message;
  };
  EXPECT_EQ(refused({.mass = 1e-101}), "caacd: mass must be 1e-100 or more and finite");
  EXPECT_EQ(refused({.max_speed = NAN}), "caacd: max_speed must be above 0 and finite");
  EXPECT_EQ(refused({.max_force = INFINITY}), "caacd: max_force must be above 0 and finite");
  EXPECT_EQ(refused({.horizon = -1}), "caacd: horizon must be above 0 and finite");
  EXPECT_EQ(refused({.deceleration = 0}), "caacd: deceleration must be above 0 and finite");
  EXPECT_EQ(refused({.probe_time = -1}), "caacd: zone_time must be 0 or more and finite");
  EXPECT_EQ(refused({.lambda1 = 0.4}), "caacd: lambda1 must be from 0.5 to 1");
  EXPECT_EQ(refused({.lambda3 = 1.1}), "caacd: lambda3 must be from 0 to 1");
}

// What must hold for all inputs.

Body random_body(uint64_t seed, uint64_t i, uint32_t id, double spread, double speed) {
  const auto unit = [&](uint64_t k) { return 2 * random_unit(seed, i, 8 * uint64_t{id} + k) - 1; };
  return body(spread * unit(0), spread * unit(1), speed * unit(2), speed * unit(3), id);
}

Vec3d quarter_turn(Vec3d v) { return {-v.z, v.y, v.x}; }
Vec3d mirrored(Vec3d v) { return {v.x, v.y, -v.z}; }

template <class Map>
Body moved(Body b, Map map) {
  b.position = map(b.position);
  b.velocity = map(b.velocity);
  b.forward = map(b.forward);
  return b;
}

TEST(Caacd, AQuarterTurnOfEverythingTurnsTheForceAndNothingElse) {
  for (const Trigger trigger : {Trigger::kThreat, Trigger::kNear, Trigger::kZones}) {
    int threats = 0;
    for (uint64_t i = 0; i < 4000; ++i) {
      const Model model = brisk(trigger);
      const Body a = random_body(3, i, 0, 15, 1.4), b = random_body(3, i, 1, 15, 1.4);
      const Body a2 = moved(a, quarter_turn), b2 = moved(b, quarter_turn);
      const Threat threat = threat_of(a, b, model), turned = threat_of(a2, b2, model);
      ASSERT_EQ(threat.state, turned.state);
      if (threat.state == State::kTolerable) continue;
      ++threats;
      EXPECT_EQ(threat.time, turned.time);  // bit by bit: sums of two commute
      expect_near(quarter_turn(avoidance(a, threat, model)), avoidance(a2, turned, model), 1e-15);
      const Vec3d target{40, 0, -7};
      expect_near(quarter_turn(path_amendment(a, target, 0, model)),
                  path_amendment(a2, quarter_turn(target), 0, model), 1e-15);
    }
    EXPECT_GT(threats, 500);
  }
}

TEST(Caacd, AMirrorMirrorsTheForceWhereTheOtherIsNotDeadAhead) {
  int threats = 0;
  for (uint64_t i = 0; i < 4000; ++i) {
    const Model model = brisk();
    const Body a = random_body(4, i, 0, 25, 1.4), b = random_body(4, i, 1, 25, 1.4);
    const Threat threat = threat_of(a, b, model);
    if (threat.state == State::kTolerable) continue;
    ++threats;
    const Body a2 = moved(a, mirrored);
    const Threat other = threat_of(a2, moved(b, mirrored), model);
    expect_near(mirrored(avoidance(a, threat, model)), avoidance(a2, other, model), 1e-15);
  }
  EXPECT_GT(threats, 500);
}

TEST(Caacd, NoBodyBeyondTheThreatRadiusIsAThreat) {
  int threats = 0;
  for (const Length kind : {Length::kTrue, Length::kMaxAndSum}) {
    Model model = brisk();
    model.length = kind;
    model.lambda1 = 0.5;
    for (uint64_t i = 0; i < 20000; ++i) {
      const Body a = random_body(5, i, 0, 200, 1.4), b = random_body(5, i, 1, 200, 1.4);
      if (threat_of(a, b, model).state == State::kTolerable) continue;
      ++threats;
      EXPECT_LE(length(a.position - b.position), threat_radius(a, kFields.alert, model));
    }
  }
  EXPECT_GT(threats, 500);
}

TEST(Caacd, TheThreatRadiusAllowsForALengthThatIsTooShort) {
  Model model{.max_speed = 0.01, .horizon = 1, .lambda1 = 0.5};
  model.length = Length::kMaxAndSum;
  model.trigger = Trigger::kThreat;
  const Body a = body(0, 0, 0, 0), b = body(39, 0, 0, 0, 1);  // 19.5 by eq. 10
  EXPECT_EQ(threat_of(a, b, model).state, State::kAlert);
  EXPECT_GE(threat_radius(a, kFields.alert, model), 39);
}

TEST(Caacd, AnyInputGivesFiniteForcesWithinTheLimits) {
  // Everything that is not random here is where formulas break: zero, equal, tiny, huge.
  const std::array<double, 10> hard{0, -0.0, 1, -1, 1e-300, -1e-160, 1e-20, 1e6, -1e90, 1e99};
  uint64_t tested = 0;
  for (uint64_t i = 0; i < 200000; ++i) {
    const auto pick = [&](uint64_t k) {
      return random_below(6, i, k, 3) == 0 ? hard[random_below(6, i, k + 100, hard.size())]
                                           : 100 * random_unit(6, i, k + 200) - 50;
    };
    const auto any = [&](uint64_t k, uint32_t id) {
      Body b = body(pick(k), pick(k + 1), pick(k + 2), pick(k + 3), id);
      if (random_below(6, i, k + 50, 4) == 0) b.velocity.y = pick(k + 4);
      b.forward = heading_of(b.velocity, {0, 0, 1});
      return b;
    };
    Model model{.max_speed = 1, .max_force = 0.5, .probe_time = 3};
    model.trigger = static_cast<Trigger>(1 + i % 3);
    model.axes = static_cast<Axes>(i / 3 % 2);
    model.length = static_cast<Length>(i / 6 % 2);
    const Body a = any(0, 0);
    const Body b = i % 5 == 0 ? a : any(10, 1);
    const std::array<Obstacle, 1> wall{{{{pick(20), 0, pick(21)}, {5, 8, 12}}}};
    const Threat threat = greatest_threat(a, std::array<Body, 1>{b}, wall, model);
    std::vector<Vec3d> forces = {path_amendment(a, {pick(22), 0, pick(23)}, 0, model)};
    if (threat.state != State::kTolerable) forces.push_back(avoidance(a, threat, model));
    for (const Vec3d force : forces) {
      ASSERT_LE(length(force), 0.5 * (1 + 1e-12)) << i;  // false for a NaN as well
      ASSERT_LE(length(steered(a.velocity, force, 1, model)), 1 + 1e-12) << i;
      ++tested;
    }
  }
  EXPECT_GT(tested, 200000u);
}

TEST(Caacd, TheMoreUrgentThreatIsSoonerThenNearerThenOfTheSmallerId) {
  Threat base;
  base.state = State::kAlert, base.time = 4, base.distance = 3, base.id = 7;
  Threat sooner = base, nearer = base, smaller = base;
  sooner.time = 3, sooner.distance = 9, sooner.id = 9;
  nearer.distance = 2, nearer.id = 9;
  smaller.id = 6;
  for (const Threat& more : {sooner, nearer, smaller}) {
    EXPECT_TRUE(more_urgent(more, base));
    EXPECT_FALSE(more_urgent(base, more));
  }
  EXPECT_FALSE(more_urgent(base, base));
  EXPECT_TRUE(more_urgent(base, Threat{})) << "no threat is less urgent than any";
}

TEST(Caacd, ByStateACollisionOutranksWhatIsCriticalAndThatAnAlert) {
  Threat later;
  later.time = 9, later.distance = 9, later.id = 9;
  Threat sooner = later;
  sooner.time = 1, sooner.distance = 1, sooner.id = 1;
  const std::array states = {State::kTolerable, State::kAlert, State::kCritical, State::kCollision};
  for (size_t worse = 1; worse < states.size(); ++worse) {
    later.state = states[worse];
    sooner.state = states[worse - 1];
    EXPECT_TRUE(more_urgent(later, sooner, Order::kState));
    EXPECT_FALSE(more_urgent(sooner, later, Order::kState));
    EXPECT_TRUE(more_urgent(sooner, later, Order::kTime)) << "as printed";
    sooner.state = states[worse];
    EXPECT_TRUE(more_urgent(sooner, later, Order::kState)) << "within a state by time";
  }
}

// As printed a threat is alert or critical; by state it is what the field says in which the nearest
// approach lies, or a collision if the bodies touch now.
TEST(Caacd, ByStateAThreatHasTheStateOfItsNearestApproach) {
  Model printed, by_state;
  printed.trigger = by_state.trigger = Trigger::kThreat;
  by_state.order = Order::kState;
  const Fields fields{5, 7.5, 12};
  Body self{.position = {}, .velocity = {0.4, 0, 0}, .fields = fields, .id = 1};
  const auto state = [&](double aside, double ahead, const Model& model) {
    const Body other{.position = {ahead, 0, aside},
                     .velocity = {-0.4, 0, 0},
                     .forward = {-1, 0, 0},
                     .fields = fields,
                     .id = 2};
    return threat_of(self, other, model).state;
  };
  EXPECT_EQ(state(2, 30, printed), State::kCritical);
  EXPECT_EQ(state(2, 30, by_state), State::kCollision);
  EXPECT_EQ(state(12, 30, printed), State::kCritical);
  EXPECT_EQ(state(12, 30, by_state), State::kCritical);
  EXPECT_EQ(state(20, 30, printed), State::kAlert);
  EXPECT_EQ(state(20, 30, by_state), State::kAlert);
  EXPECT_EQ(state(30, 30, by_state), State::kTolerable);
  self.velocity = {};
  EXPECT_EQ(state(6, 7, by_state), State::kCollision) << "they touch now";
  const Obstacle wall{.position = {14, 0, 0}, .fields = {8, 13, 13}};
  self.velocity = {0.4, 0, 0};
  EXPECT_EQ(threat_of(self, wall, printed).state, State::kCritical);
  EXPECT_EQ(threat_of(self, wall, by_state).state, State::kCollision);
}

// The probe as a grid of points, 1 % of its size apart.
TEST(Caacd, AProbeOverlapsADiscIfOneOfItsPointsIsInside) {
  Model model = brisk();
  model.probe_time = 3;
  int both[2] = {0, 0};
  for (uint64_t k = 0; k < 400; ++k) {
    const auto draw = [&](uint64_t n) { return random_unit(31, k, n); };
    const Body self = body(20 * draw(0), 20 * draw(1), draw(2) - 0.5, draw(3) - 0.5);
    const Vec3d centre{self.position.x + 40 * (draw(4) - 0.5), 50 * draw(5),
                       self.position.z + 40 * (draw(6) - 0.5)};
    const double radius = 0.5 + 6 * draw(7);
    const double reach = probe_length(self, model), half = kFields.repulsive;
    const Vec3d right = right_of(self.forward);
    double nearest = 1e300;
    for (int a = 0; a <= 100; ++a) {
      for (int b = -50; b <= 50; ++b) {
        const Vec3d at = self.position + self.forward * (reach * a / 100) + right * (half * b / 50);
        nearest = std::min(nearest, std::hypot(at.x - centre.x, at.z - centre.z));
      }
    }
    const double apart = 0.01 * (reach + 2 * half);
    if (nearest > radius && nearest < radius + apart) continue;  // Too near to say.
    const bool overlaps = probe_overlaps(self, centre, radius, model);
    EXPECT_EQ(overlaps, nearest <= radius) << k;
    ++both[overlaps ? 1 : 0];
  }
  EXPECT_GT(both[0], 50);
  EXPECT_GT(both[1], 50);
}

}  // namespace
}  // namespace throng::caacd
