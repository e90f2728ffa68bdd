// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "throng/verify.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "fake_world.h"

namespace throng::verify {
namespace {

VerifyReport judge(const FakeWorld& world, uint64_t samples = 4000) {
  Context context;
  const auto report = verify_proposals(world.claims(), world.scene, {.samples = samples}, context);
  EXPECT_TRUE(report) << report.error().message;
  return report ? *report : VerifyReport{};
}

uint64_t faults(const VerifyReport& report, const std::string& what) {
  return static_cast<uint64_t>(
      std::count_if(report.faults.begin(), report.faults.end(),
                    [&](const VerifyFault& fault) { return fault.what == what; }));
}

TEST(Verify, HonestWorldHasNoFault) {
  const VerifyReport report = judge(flat_world(one_wall()), 20000);
  EXPECT_EQ(report.states, 20000u);
  EXPECT_GT(report.moves, 19000u);
  EXPECT_EQ(report.surface_points, 20000u);
  EXPECT_EQ(report.entered, 0u);
  EXPECT_EQ(report.unsupported, 0u);
  EXPECT_EQ(report.broken, 0u);
  EXPECT_EQ(report.no_surface_under_centre, 0u);
  EXPECT_EQ(report.feet_error_mean, 0);
  EXPECT_EQ(report.lost_grown, 0);
  EXPECT_LT(report.lost_exact, 0.003);  // A margin of 1 mm along 66 m of rim, of 130 m^2.
  EXPECT_TRUE(report.faults.empty());
  // The rim and the wall, all around, by the radius: the wall's top is too narrow to stand on.
  const double exact = 11.62 * 11.62 - 0.58 * 9;
  EXPECT_NEAR(report.standable_area_exact, exact, 3);
  EXPECT_LT(report.standable_area_grown, report.standable_area_exact);
}

TEST(Verify, CautiousWorldLosesTheExactBodyButNotTheGrownOne) {
  const VerifyReport report = judge(flat_world(one_wall(), 0.099));
  EXPECT_EQ(report.entered, 0u);
  EXPECT_EQ(report.lost_grown, 0);
  EXPECT_NEAR(report.lost_exact, 0.099 * 62 / 126, 0.012);
  EXPECT_NEAR(report.lost_exact_error, std::sqrt(0.048 * 0.952 / 3500), 0.001);
}

TEST(Verify, ClosedWallThatIsIgnoredIsEntered) {
  FakeWorld world = flat_world(one_wall());
  world.floor = flat_world({}).floor;
  const VerifyReport report = judge(world);
  EXPECT_GT(report.entered, 300u);
  EXPECT_EQ(report.unsupported, 0u);
  ASSERT_GT(faults(report, "entered"), 0u);
  const VerifyFault& fault = report.faults[0];
  EXPECT_LT(one_wall()[0].distance(fault.position.x, fault.position.z), world.avatar.radius);
  EXPECT_GE(fault.triangle, 2u);  // The floor has 0 and 1.
}

TEST(Verify, WallThatOnlyMovesIgnoreIsEnteredInTheMove) {
  FakeWorld world = flat_world(one_wall());
  world.floor_on_moves = flat_world({}).floor;
  const VerifyReport report = judge(world);
  EXPECT_GT(report.entered, 100u);
  EXPECT_LE(report.entered, report.moves);
  EXPECT_EQ(report.broken, 0u);
}

TEST(Verify, BodyIsTestedAlongTheMoveAndNotOnlyAtItsEnds) {
  FakeWorld world = flat_world(one_wall());
  world.moves_look_at_ends_only = true;
  world.floor_found = flat_world({}).floor;
  const VerifyReport report = judge(world);
  EXPECT_GT(report.entered, 20u);
  EXPECT_EQ(report.broken, 0u);
}

TEST(Verify, MoveThatEndsOnAnotherFloorIsTorn) {
  FakeWorld world = flat_world({});
  Claims claims = world.claims();
  claims.move = [honest = claims.move](const Place& from, double dx, double dz) {
    MoveResult result = honest(from, dx, dz);
    if (result.end == MoveEnd::kArrived) result.place.position.y += 0.6;
    return result;
  };
  Context context;
  const auto report = verify_proposals(claims, world.scene, {.samples = 200}, context);
  ASSERT_TRUE(report);
  EXPECT_EQ(report->broken, report->moves);
}

TEST(Verify, MoveThatJumpsOverAWallIsTorn) {
  FakeWorld world = flat_world(one_wall());
  world.moves_look_at_ends_only = true;
  const VerifyReport report = judge(world);
  EXPECT_GT(report.broken, 20u);
  EXPECT_EQ(report.entered, 0u);
  EXPECT_GT(faults(report, "broken"), 0u);
}

TEST(Verify, BodyOneMillimetreTooNearAWallIsEntered) {
  const VerifyReport report = judge(flat_world(one_wall(), -0.001), 20000);
  EXPECT_GT(report.entered, 0u);
}

TEST(Verify, CeilingThatIsTooLowIsEntered) {
  FakeWorld world = flat_world({});
  const double head = world.avatar.height;
  const auto with_ceiling = [&](double y) {
    FakeWorld copy = world;
    copy.scene.add_quad({4, y, 4}, {8, y, 4}, {8, y, 8}, {4, y, 8});
    return copy;
  };
  EXPECT_EQ(judge(with_ceiling(head), 300).entered, 0u);
  EXPECT_GT(judge(with_ceiling(head - 0.01), 300).entered, 0u);
}

TEST(Verify, HeadroomWithinTheResolutionMayBeLostToTheGrownBodyOnly) {
  FakeWorld world = flat_world({});
  const double y = world.avatar.height + 0.05;
  world.scene.add_quad({4, y, 4}, {8, y, 4}, {8, y, 8}, {4, y, 8}, kAreaBlocked);
  world.floor = [honest = world.floor](double x, double z) {
    return Rectangle{4, 4, 8, 8}.distance(x, z) < 0.28 ? std::nullopt : honest(x, z);
  };
  const VerifyReport report = judge(world, 800);
  EXPECT_EQ(report.lost_grown, 0);
  EXPECT_EQ(report.isolated_grown, 0);
  EXPECT_NEAR(report.lost_exact, 4.5 * 4.5 / 135, 0.06);
}

TEST(Verify, FloatingFeetAreMeasuredAndThenUnsupported) {
  const auto floating = [](double height) {
    FakeWorld world = flat_world(one_wall());
    const auto honest = world.floor;
    world.floor = [honest, height](double x, double z) -> std::optional<double> {
      if (!honest(x, z)) return std::nullopt;
      return height;
    };
    return judge(world, 200);
  };
  const VerifyReport low = floating(0.1);
  EXPECT_NEAR(low.feet_error_mean, 0.1, 1e-9);
  EXPECT_NEAR(low.feet_error_p95, 0.1, 1e-9);
  EXPECT_EQ(low.unsupported, 0u);
  const VerifyReport high = floating(0.5);
  EXPECT_EQ(high.unsupported, high.states + high.moves);
  EXPECT_EQ(high.no_surface_under_centre, high.states);
  const VerifyReport sunk = floating(-0.2);
  EXPECT_EQ(sunk.unsupported, sunk.states + sunk.moves);
}

TEST(Verify, PercentileIsNotTheMean) {
  FakeWorld world = flat_world({});
  const auto honest = world.floor;
  world.floor = [honest](double x, double z) -> std::optional<double> {
    if (!honest(x, z)) return std::nullopt;
    return x < 2 ? 0.2 : 0.0;  // A seventh of the floor floats.
  };
  const VerifyReport report = judge(world);
  EXPECT_NEAR(report.feet_error_mean, 0.2 * 1.75 / 11.5, 0.004);
  EXPECT_NEAR(report.feet_error_p95, 0.2, 1e-9);
}

TEST(Verify, NoBodyStandsBesideTheFloor) {
  FakeWorld world = flat_world({});
  world.side = 14;  // Its places reach 2 m over the rim.
  world.floor = [](double, double) { return 0.0; };
  const VerifyReport report = judge(world);
  EXPECT_NEAR(
      static_cast<double>(report.no_surface_under_centre) / static_cast<double>(report.states),
      1 - 144.0 / 196, 0.03);
  EXPECT_GT(report.unsupported, 1000u);
}

TEST(Verify, BlockedAndSteepSurfacesSupportNoBody) {
  FakeWorld blocked = flat_world({});
  for (AreaKind& kind : blocked.scene.area) kind = kAreaBlocked;
  const VerifyReport report = judge(blocked, 500);
  EXPECT_EQ(report.unsupported, report.states + report.moves);
  EXPECT_EQ(report.surface_points, 0u);  // Nothing to lose.
}

TEST(Verify, DeniedHalfIsLost) {
  FakeWorld world = flat_world({});
  const auto honest = world.floor;
  world.floor = [honest](double x, double z) { return x < 6 ? honest(x, z) : std::nullopt; };
  const VerifyReport report = judge(world, 400);
  EXPECT_NEAR(report.lost_grown, 0.5, 0.1);
  EXPECT_NEAR(report.lost_exact, 0.5, 0.1);
  EXPECT_EQ(report.isolated_grown, 0);
  EXPECT_GT(faults(report, "lost"), 0u);
}

TEST(Verify, SmallClosedRoomThatIsDeniedIsIsolatedAndALargeOneIsLost) {
  const auto denied_room = [](double low, double high) {
    FakeWorld world = flat_world(closed_room(low, high));
    const auto honest = world.floor;
    world.floor = [=](double x, double z) {
      const bool inside = x > low && x < high && z > low && z < high;
      return inside ? std::nullopt : honest(x, z);
    };
    return judge(world, 1500);
  };
  const VerifyReport small = denied_room(5, 7);  // 1.5 x 1.5 m to stand on
  EXPECT_EQ(small.lost_grown, 0);
  EXPECT_NEAR(small.isolated_grown, 1.3 * 1.3 / 119.8, 0.009);
  const VerifyReport large = denied_room(3, 9);
  EXPECT_NEAR(large.lost_grown, 5.3 * 5.3 / 105.4, 0.04);
  EXPECT_EQ(large.isolated_grown, 0);
}

TEST(Verify, RampIsFollowedByHonestFeet) {
  FakeWorld world;  // 30 degrees along x.
  const double rise = std::tan(std::acos(-1) / 6);
  world.scene.add_quad({0, 0, 0}, {12, 12 * rise, 0}, {12, 12 * rise, 12}, {0, 0, 12});
  world.floor = [rise](double x, double z) -> std::optional<double> {
    if (x < 0.251 || z < 0.251 || x > 11.749 || z > 11.749) return std::nullopt;
    return x * rise;
  };
  const VerifyReport report = judge(world);
  EXPECT_EQ(report.entered, 0u);
  EXPECT_EQ(report.unsupported, 0u);
  EXPECT_EQ(report.broken, 0u);
  EXPECT_LT(report.feet_error_mean, 1e-9);
  EXPECT_EQ(report.lost_grown, 0);
  EXPECT_NEAR(report.standable_area_grown, 11.3 * 11.3 / std::cos(std::acos(-1) / 6), 5);

  world.avatar.max_slope = 29;  // Now no body may stand there.
  const VerifyReport steep = judge(world, 500);
  EXPECT_EQ(steep.unsupported, steep.states + steep.moves);
  EXPECT_EQ(steep.surface_points, 0u);
}

TEST(Verify, ReportIsTheSameForAnyNumberOfWorkers) {
  FakeWorld world = flat_world(one_wall(), -0.01);
  const auto run = [&](int32_t workers, uint64_t seed) {
    Context context;
    return *verify_proposals(world.claims(), world.scene,
                             {.samples = 3000, .seed = seed, .workers = workers}, context);
  };
  const VerifyReport expected = run(1, 5);
  EXPECT_GT(expected.entered, 0u);
  for (const int32_t workers : {2, 5, 0}) {
    const VerifyReport report = run(workers, 5);
    EXPECT_EQ(report.entered, expected.entered);
    EXPECT_EQ(report.moves, expected.moves);
    EXPECT_EQ(report.lost_exact, expected.lost_exact);
    EXPECT_EQ(report.standable_area_grown, expected.standable_area_grown);
    ASSERT_EQ(report.faults.size(), expected.faults.size());
    for (size_t i = 0; i < report.faults.size(); ++i) {
      EXPECT_EQ(report.faults[i].what, expected.faults[i].what);
      EXPECT_EQ(report.faults[i].position, expected.faults[i].position);
      EXPECT_EQ(report.faults[i].triangle, expected.faults[i].triangle);
    }
  }
  EXPECT_NE(run(1, 6).faults[0].position, expected.faults[0].position);
}

TEST(Verify, BadInputIsRefusedInOneSentence) {
  const FakeWorld world = flat_world({});
  Context context;
  const auto refuse = [&](const Scene& scene, const VerifyConfig& config) {
    const auto report = verify_proposals(world.claims(), scene, config, context);
    EXPECT_FALSE(report);
    return report ? Errc::kOk : report.error().code;
  };
  EXPECT_EQ(refuse(Scene{}, {}), Errc::kBadInput);
  EXPECT_EQ(refuse(world.scene, {.samples = 0}), Errc::kBadConfig);
  EXPECT_EQ(refuse(world.scene, {.workers = -1}), Errc::kBadConfig);
  Scene bad = world.scene;
  bad.triangles[1][2] = 1000;
  EXPECT_EQ(refuse(bad, {}), Errc::kBadInput);
  bad = world.scene;
  bad.positions[3].y = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(refuse(bad, {}), Errc::kBadInput);
  bad = world.scene;
  bad.area.pop_back();
  EXPECT_EQ(refuse(bad, {}), Errc::kBadInput);
}

TEST(Verify, CancelStopsIt) {
  const FakeWorld world = flat_world({});
  Context context;
  uint64_t calls = 0;
  context.on_progress = [&](const Progress& progress) {
    EXPECT_EQ(progress.total, 3000000u);
    if (++calls == 2) context.cancel = true;
  };
  const auto report = verify_proposals(world.claims(), world.scene, {.samples = 1000000}, context);
  ASSERT_FALSE(report);
  EXPECT_EQ(report.error().code, Errc::kCancelled);
  EXPECT_EQ(calls, 2u);
}

}  // namespace
}  // namespace throng::verify
