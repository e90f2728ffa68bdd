// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <set>
#include <vector>

#include "baked.h"
#include "crowds.h"
#include "path/air/flight_finder.h"
#include "simd_targets.h"
#include "throng/crowd.h"
#include "throng/path.h"
#include "trips.h"
#include "verify/cylinder.h"
#include "verify/triangle_tree.h"
#include "worlds.h"

// Flyers in a crowd: none enters a solid or another avatar, and all arrive.
namespace throng {
namespace {

constexpr int32_t kFlyer = 0, kAdult = 1;

// A world, and what is true in it: triangles and cylinders, and nothing of what was baked but where
// a body that takes off has left the ground.
class Stage {
 public:
  explicit Stage(const Scene& scene, double cell = 0.1)
      : scene_(scene),
        tree_(scene_, 0),
        world_(test::bake(scene, cell, {flyer_class(), default_classes()[0]})) {
    Context context;
    auto made = path::FlightFinder::create(world_, {.avatar_class = kFlyer}, context);
    EXPECT_TRUE(made) << made.error().message;
    if (made) flight_.emplace(std::move(*made));
  }
  [[nodiscard]] const World& world() const { return world_; }
  [[nodiscard]] path::FlightFinder& flight() { return *flight_; }
  [[nodiscard]] Place ground(Vec3d at, int32_t avatar_class = kFlyer) const {
    const Place place = world_.find_place(avatar_class, at, 1);
    EXPECT_TRUE(place) << at.x << ' ' << at.y << ' ' << at.z;
    return place;
  }

  // Pairs whose cylinders overlap, and bodies inside a solid.
  struct Faults {
    uint64_t overlaps = 0, entered = 0, bodies = 0, pairs = 0;
  };
  void look(const Crowd& crowd, Faults& faults) {
    crowd.read(states_);
    const std::vector<AvatarClass> classes = world_.summary().classes;
    const auto of = [&](const AvatarState& s) -> const AvatarClass& {
      return classes[static_cast<size_t>(s.avatar_class)];
    };
    for (size_t i = 0; i < states_.size(); ++i) {
      const AvatarState& a = states_[i];
      faults.entered += is_in_matter(a, of(a)) ? 1 : 0;
      ++faults.bodies;
      for (size_t j = i + 1; j < states_.size(); ++j) {
        const AvatarState& b = states_[j];
        const double level = std::hypot(a.position.x - b.position.x, a.position.z - b.position.z);
        const bool beside = level >= a.radius + b.radius - 1e-9;
        const bool over = a.position.y >= b.position.y + of(b).height - 1e-9 ||
                          b.position.y >= a.position.y + of(a).height - 1e-9;
        faults.overlaps += beside || over ? 0 : 1;
        ++faults.pairs;
      }
    }
    const CrowdCheck check = crowd.check();
    faults.overlaps += check.overlaps;
    faults.entered += check.wall_entries + check.obstacle_entries;
  }

 private:
  [[nodiscard]] bool is_in_matter(const AvatarState& state, const AvatarClass& avatar) {
    double low = state.position.y;
    if (state.mode != MoveMode::kFly) {
      low += body_bottom(avatar);
    } else if (!flight_->is_legal(state.position)) {  // between the ground and the air
      const Place place = world_.find_place(
          state.avatar_class,
          {state.position.x, state.position.y - avatar.height / 2, state.position.z},
          avatar.height / 2 + 0.01);
      if (!place) return true;
      low = std::max(low, place.position.y + body_bottom(avatar));
    }
    const verify::Cylinder body{.x = state.position.x,
                                .z = state.position.z,
                                .low = low,
                                .high = state.position.y + avatar.height,
                                .radius = avatar.radius};
    return tree_.find(body.bounds(), [&](uint32_t, const verify::Corners& corners) {
      return verify::meets(body, corners);
    });
  }

  Scene scene_;
  verify::TriangleTree tree_;
  World world_;
  std::optional<path::FlightFinder> flight_;
  std::vector<AvatarState> states_;
};

std::vector<AvatarId> added(Crowd& crowd, const std::vector<AvatarSpawn>& spawns) {
  Context context;
  const auto ids = crowd.add(spawns, context);
  EXPECT_TRUE(ids) << ids.error().message;
  if (!ids) return {};
  for (const AvatarId id : *ids) EXPECT_TRUE(id);
  return *ids;
}

AvatarSpawn flyer_at(Vec3d feet) { return {.place = air_place(feet), .avatar_class = kFlyer}; }

// A floor of side `side`, and a box at `height`, so that there is air up to there.
Scene open_air(double side, double height) {
  Scene scene = worlds::flat(side);
  scene.add_box({0, height, 0}, {1, height + 0.5, 1});
  return scene;
}

// A tunnel along X, 4 m wide and 6 m high.
Scene tunnel(double length) {
  Scene scene;
  scene.add_box({0, -1, 0}, {length, 0, 6});
  scene.add_box({0, 0, 0}, {length, 6.5, 1});
  scene.add_box({0, 0, 5}, {length, 6.5, 6});
  scene.add_box({0, 6, 1}, {length, 6.5, 5});
  return scene;
}

// Two halls of 12 x 10 x 8 m with a wall between them; a window of 2.4 x 3.2 m is the only opening.
Scene window() {
  Scene scene;
  scene.add_box({0, -1, 0}, {24.4, 0, 10});
  scene.add_box({12, 0, 0}, {12.4, 8, 3.8});
  scene.add_box({12, 0, 6.2}, {12.4, 8, 10});
  scene.add_box({12, 0, 3.8}, {12.4, 2.4, 6.2});
  scene.add_box({12, 5.6, 3.8}, {12.4, 8, 6.2});
  scene.add_box({0, 8, 0}, {24.4, 8.4, 10});
  return scene;
}

TEST(Flyers, FiveHundredThatCrossASphereAllArrive) {
  Stage stage(open_air(80, 60), 0.2);
  Crowd crowd = made(stage.world());
  std::vector<AvatarSpawn> spawns;
  std::vector<Place> goals;
  constexpr size_t kCount = 500;
  const Vec3d middle{40, 30, 40};
  for (size_t i = 0; i < kCount; ++i) {  // evenly over the sphere
    const double y = 1 - (2 * static_cast<double>(i) + 1) / kCount;
    const double r = std::sqrt(1 - y * y), turn = 2.399963 * static_cast<double>(i);
    const Vec3d offset{25 * r * std::cos(turn), 25 * y, 25 * r * std::sin(turn)};
    spawns.push_back(flyer_at(middle + offset));
    goals.push_back(air_place(middle - offset));
  }
  crowd.set_goals(added(crowd, spawns), goals);
  expect_all(go(crowd, stage, kCount, 600, 3), kCount);
}

TEST(Flyers, TwoGroupsThatMeetInATunnelPassEachOther) {
  Stage stage(tunnel(40));
  Crowd crowd = made(stage.world());
  std::vector<AvatarSpawn> spawns;
  std::vector<Place> goals;
  for (int i = 0; i < 24; ++i) {
    const Vec3d near{3.0 + 1.5 * (i / 4), 0.9 + 1.9 * (i / 2 % 2), 2.4 + 1.2 * (i % 2)};
    const Vec3d far{40 - near.x, near.y, near.z};
    spawns.push_back(flyer_at(near));
    goals.push_back(air_place(far));
    spawns.push_back(flyer_at(far));
    goals.push_back(air_place(near));
  }
  crowd.set_goals(added(crowd, spawns), goals);
  expect_all(go(crowd, stage, spawns.size(), 900, 2), spawns.size());
}

TEST(Flyers, ThirtyThatHeadThroughAWindowAllPass) {
  Stage stage(window());
  Crowd crowd = made(stage.world());
  std::vector<AvatarSpawn> spawns;
  std::vector<Place> goals;
  for (int i = 0; i < 30; ++i) {
    const Vec3d here{1.5 + 1.1 * (i % 5), 0.5 + 2.1 * (i / 5 % 3), 1.0 + 1.2 * (i / 15)};
    spawns.push_back(flyer_at(here));
    goals.push_back(air_place({24.4 - here.x, here.y, here.z}));
  }
  crowd.set_goals(added(crowd, spawns), goals);
  expect_all(go(crowd, stage, spawns.size(), 1500, 3), spawns.size());
}

TEST(Flyers, ThirtyWhoseGoalIsOnePlaceOfTheGroundAllLandAroundIt) {
  Stage stage(open_air(40, 20));
  Crowd crowd = made(stage.world());
  std::vector<AvatarSpawn> spawns;
  for (int i = 0; i < 30; ++i) {
    spawns.push_back(flyer_at({8.0 + 2 * (i % 6), 6.0 + 2.5 * (i / 6), 20.0 + (i % 2)}));
  }
  const std::vector<Place> goals(spawns.size(), stage.ground({20, 0, 20}));
  crowd.set_goals(added(crowd, spawns), goals);
  Stage::Faults faults;
  CrowdReport report;
  for (int step = 0; step < 600; ++step) {
    report = crowd.step();
    stage.look(crowd, faults);
  }
  EXPECT_EQ(report.flying, 0u);
  EXPECT_EQ(faults.overlaps + faults.entered, 0u);
  std::vector<AvatarState> states;
  crowd.read(states);
  for (const AvatarState& s : states) {
    EXPECT_LT(std::hypot(s.position.x - 20, s.position.z - 20), 8);
  }
}

// Two floors 20 m apart: no path on foot leads from one to the other.
TEST(Flyers, TakeOffAndLandWhereNoPathOnFootLeads) {
  Scene scene;
  scene.add_quad({0, 0, 0}, {0, 0, 8}, {8, 0, 8}, {8, 0, 0});
  scene.add_quad({28, 3, 0}, {28, 3, 8}, {36, 3, 8}, {36, 3, 0});
  scene.add_box({1, 1.9, 1}, {3.5, 2.5, 5.5});  // no take-off under this table
  Stage stage(scene);
  Crowd crowd = made(stage.world());
  EXPECT_FALSE(crowd.random_air_point(kFlyer, 1, 0)) << "no flyer yet";
  std::vector<AvatarSpawn> spawns;
  std::vector<Place> goals;
  for (int i = 0; i < 12; ++i) {
    const Vec3d here{1.8 + 1.5 * (i % 4), 0, 1.5 + 1.6 * (i / 4)};
    spawns.push_back({.place = stage.ground(here), .avatar_class = kFlyer});
    goals.push_back(stage.ground({here.x + 27.5, 3, here.z}));
  }
  const auto ids = added(crowd, spawns);
  const auto point = crowd.random_air_point(kFlyer, 1, 0);
  ASSERT_TRUE(point);
  EXPECT_TRUE(crowd.may_fly(kFlyer, *point));
  EXPECT_FALSE(crowd.may_fly(kFlyer, {2, 2.2, 3})) << "in the table";
  EXPECT_FALSE(crowd.may_fly(kFlyer, {1e9, 0, 0}));
  EXPECT_FALSE(crowd.random_air_point(kAdult, 1, 0)) << "adults do not fly";
  EXPECT_FALSE(crowd.may_fly(kAdult, *point) || crowd.may_fly(-1, *point));
  crowd.set_goals(ids, goals);
  const TripRun<Stage> flown = go(crowd, stage, spawns.size(), 600);
  expect_all(flown, spawns.size());
  EXPECT_EQ(crowd.step().flying, 0u);
}

// Walkers on a floor, on stairs and on a deck, flyers among them, above them and down to them.
TEST(Flyers, ShareStairsAndLevelsWithWalkers) {
  for (const char* name : {"garage", "stairs", "bridge"}) {
    Stage stage(test::builtin({.name = name, .seed = 3}));
    Crowd crowd = made(stage.world());
    std::vector<AvatarId> walkers = scattered(crowd, 120, {.avatar_class = kAdult});
    std::vector<AvatarId> flyers = scattered(crowd, 40, {.avatar_class = kFlyer});
    const auto above = scattered(crowd, 40, {.place = air_place({}), .avatar_class = kFlyer});
    flyers.insert(flyers.end(), above.begin(), above.end());
    uint64_t goals = 0;
    const auto send = [&](const std::vector<AvatarId>& ids, int32_t avatar_class) {
      std::vector<Place> to;
      for (size_t i = 0; i < ids.size(); ++i) {
        const uint64_t n = goals++;
        const bool in_air = avatar_class == kFlyer && n % 2 == 0;
        to.push_back(in_air ? air_place(*stage.flight().random_point(7, n))
                            : stage.world().random_place(avatar_class, 7, n));
      }
      crowd.set_goals(ids, to);
    };
    send(walkers, kAdult);
    send(flyers, kFlyer);
    Stage::Faults faults;
    uint64_t arrived = 0, took_off = 0, landed = 0;
    uint64_t flying = 0;
    for (int step = 0; step < 160; ++step) {
      const CrowdReport report = crowd.step();
      arrived += report.arrived;
      if (report.flying > flying) ++took_off;
      if (report.flying < flying) ++landed;
      flying = report.flying;
      if (step % 5 == 0) stage.look(crowd, faults);
      if (step == 80) send(flyers, kFlyer);
    }
    EXPECT_EQ(faults.overlaps, 0u) << name;
    EXPECT_EQ(faults.entered, 0u) << name;
    EXPECT_GT(arrived, 20u) << name;
    EXPECT_GT(took_off, 0u) << name;
    EXPECT_GT(landed, 0u) << name;
  }
}

// A moving crowd of walkers and flyers.
Crowd mixed(Stage& stage, int32_t workers) {
  Crowd crowd = made(stage.world(), {.workers = workers});
  const auto walkers = scattered(crowd, 60, {.avatar_class = kAdult});
  auto flyers = scattered(crowd, 25, {.avatar_class = kFlyer});
  const auto above = scattered(crowd, 35, {.place = air_place({}), .avatar_class = kFlyer});
  flyers.insert(flyers.end(), above.begin(), above.end());
  std::vector<Place> to;
  for (size_t i = 0; i < walkers.size(); ++i)
    to.push_back(stage.world().random_place(kAdult, 5, i));
  crowd.set_goals(walkers, to);
  to.clear();
  for (size_t i = 0; i < flyers.size(); ++i) {
    to.push_back(i % 2 == 0 ? air_place(*stage.flight().random_point(5, i))
                            : stage.world().random_place(kFlyer, 5, i));
  }
  crowd.set_goals(flyers, to);
  return crowd;
}

TEST(Flyers, SameStateForAnyWorkersAndMachines) {
  Stage stage(test::builtin({.name = "garage", .seed = 3}));
  const auto walk = [&](const char* name, std::initializer_list<int32_t> of) {
    for (const int32_t workers : of) {
      Crowd crowd = mixed(stage, workers);
      for (int step = 0; step < 12; ++step) crowd.step();
      ASSERT_EQ(crowd.state_hash(), 1242916049193714905u) << name << ' ' << workers;
    }
  };
  walk("best", {1, 2, 8});
  test::for_every_simd_target([&](const char* name) { walk(name, {1}); });
}

TEST(Flyers, ThousandsOverACityAmongWalkersSlow) {
  Stage stage(test::builtin({.name = "city", .size = 120, .seed = 2}), 0.2);
  Crowd crowd = made(stage.world());
  const auto walkers = scattered(crowd, 1000, {.avatar_class = kAdult});
  auto flyers = scattered(crowd, 400, {.avatar_class = kFlyer});
  const auto above = scattered(crowd, 800, {.place = air_place({}), .avatar_class = kFlyer});
  flyers.insert(flyers.end(), above.begin(), above.end());
  uint64_t goals = 0;
  const auto give = [&](std::span<const AvatarId> ids) {
    for (const AvatarId id : ids) {
      const AvatarState state = *crowd.read(id);
      const uint64_t n = goals++;
      const bool in_air = state.avatar_class == kFlyer && n % 2 == 0;
      Place goal = stage.world().random_place(state.avatar_class, 11, n);
      for (uint64_t tries = 0; in_air && tries < 50; ++tries) {  // not too far away
        const Vec3d at = *stage.flight().random_point(11, n << 8 | tries);
        if (std::hypot(at.x - state.position.x, at.z - state.position.z) > 40) continue;
        goal = air_place(at);
        break;
      }
      crowd.set_goals(std::span(&id, 1), std::span(&goal, 1));
    }
  };
  give(walkers);
  give(flyers);
  Stage::Faults faults;
  uint64_t arrived = 0;
  for (int step = 1; step <= 60; ++step) {
    const CrowdReport report = crowd.step();
    arrived += report.arrived;
    const std::vector<AvatarId> there(crowd.arrived().begin(), crowd.arrived().end());
    give(there);
    if (step % 10 == 0) stage.look(crowd, faults);
  }
  EXPECT_EQ(faults.overlaps, 0u);
  EXPECT_EQ(faults.entered, 0u);
  EXPECT_GT(arrived, 100u);
  EXPECT_EQ(faults.bodies, 6u * 2200);
}

TEST(Flyers, ARestoredCrowdContinuesAsTheSavedOneWould) {
  Stage stage(test::builtin({.name = "garage", .seed = 3}));
  Crowd crowd = mixed(stage, 2);
  for (int step = 0; step < 30; ++step) crowd.step();
  const std::vector<uint8_t> saved = crowd.save();
  Context context;
  auto restored = Crowd::restore(stage.world(), {.workers = 1}, saved, context);
  ASSERT_TRUE(restored) << restored.error().message;
  for (int step = 0; step < 40; ++step) {
    crowd.step();
    restored->step();
    ASSERT_EQ(crowd.state_hash(), restored->state_hash()) << step;
  }
}

TEST(Flyers, AnExternallyControlledOneTakesOffFliesAndLands) {
  Stage stage(open_air(30, 15));
  Crowd crowd = made(stage.world());
  const AvatarId id = added(crowd, stage.ground({5, 0, 15}), {.avatar_class = kFlyer});
  const auto drive = [&](Vec3d velocity, int steps) {
    crowd.set_velocities(std::span(&id, 1), std::span(&velocity, 1));
    Stage::Faults faults;
    for (int step = 0; step < steps; ++step) {
      crowd.step();
      stage.look(crowd, faults);
    }
    EXPECT_EQ(faults.entered, 0u);
    return *crowd.read(id);
  };
  EXPECT_EQ(crowd.read(id)->mode, MoveMode::kWalk);
  const AvatarState up = drive({0, 2, 0}, 30);
  EXPECT_EQ(up.mode, MoveMode::kFly);
  EXPECT_GT(up.position.y, 4);
  const AvatarState across = drive({2, 0, 0}, 20);
  EXPECT_NEAR(across.position.x, up.position.x + 4, 0.1);
  EXPECT_NEAR(across.position.y, up.position.y, 0.1);
  const AvatarState down = drive({0, -2, 0}, 60);
  EXPECT_EQ(down.mode, MoveMode::kWalk);
  EXPECT_NEAR(down.position.y, 0, 0.01);
}

// Also in steps in which it rises by less than a millimetre.
TEST(Flyers, AnExternallyControlledOneIsWhereItsVelocityLeads) {
  const Stage stage(open_air(30, 15));
  for (const double dt : {0.001, 0.01, 0.1}) {
    Crowd crowd = made(stage.world(), {.dt = dt, .workers = 1});
    const AvatarId id = added(crowd, air_place({5, 5, 15}), {.avatar_class = kFlyer});
    const Vec3d from = crowd.read(id)->position, velocity{0.9, 0.07, 0.31};
    crowd.set_velocities({&id, 1}, {&velocity, 1});
    const int steps = std::min(2000, static_cast<int>(10 / dt));
    for (int step = 1; step <= steps; ++step) {
      crowd.step();
      const Vec3d off = crowd.read(id)->position - from - velocity * (step * dt);
      ASSERT_LE(std::hypot(off.x, off.z), 0.1 / 2048) << "dt " << dt << " step " << step;
      ASSERT_LE(std::fabs(off.y), 1e-3) << "dt " << dt << " step " << step;
    }
  }
}

TEST(Flyers, FlyAsFarAsTheirSpeedRequiresInShortSteps) {
  const Stage stage(open_air(30, 15));
  for (const double dt : {0.001, 0.01, 0.1}) {
    for (const double speed : {0.05, 0.5, 1.3}) {
      Crowd crowd = made(stage.world(), {.dt = dt, .workers = 1});
      const AvatarId id =
          added(crowd, air_place({4, 4, 15}), {.avatar_class = kFlyer, .speed = speed});
      const Place goal = air_place({26, 10, 17});
      crowd.set_goals({&id, 1}, {&goal, 1});
      const Vec3d from = crowd.read(id)->position;
      const int steps = std::min(4000, static_cast<int>(15 / (speed * dt)));
      for (int step = 0; step < steps; ++step) crowd.step();
      const double whole = speed * dt * steps;
      EXPECT_NEAR(length(crowd.read(id)->position - from), whole, std::max(0.01 * whole, 2e-3))
          << "dt " << dt << " speed " << speed;
    }
  }
}

TEST(Flyers, KeepOutOfObstaclesThatWaitForThem) {
  Stage stage(open_air(40, 20));
  Edits edits;
  Crowd crowd = made(stage.world(), {.edits = edits});
  const AvatarId hovers = added(crowd, air_place({20, 5, 20}), {.avatar_class = kFlyer});
  ASSERT_TRUE(hovers);
  const EditId at_it = put_up(crowd, edits, Prism::box({19, 4, 19}, {21, 6, 21}));
  EXPECT_TRUE(crowd.obstacle(at_it)->waits());
  EXPECT_EQ(crowd.step().waiting, 1u);
  ASSERT_EQ(crowd.blockers().size(), 1u);
  EXPECT_EQ(crowd.blockers()[0], hovers);
  const EditId beside = put_up(crowd, edits, Prism::box({25, 0, 10}, {26, 12, 30}));
  EXPECT_FALSE(crowd.obstacle(beside)->waits());
  const Place goal = air_place({34, 5, 20});
  crowd.set_goals(std::span(&hovers, 1), std::span(&goal, 1));
  expect_all(go(crowd, stage, 1, 600), 1);
  EXPECT_FALSE(crowd.obstacle(at_it)->waits());
}

// From wall to wall and higher than the air, except for an opening at one end; and a room around
// one flyer.
TEST(Flyers, GoAroundAWallThatIsPutUpAndReportUnreachableGoals) {
  Stage stage(open_air(40, 12));
  Edits edits;
  Crowd crowd = made(stage.world(), {.edits = edits});
  std::vector<AvatarSpawn> spawns;
  std::vector<Place> goals;
  for (int i = 0; i < 12; ++i) {
    spawns.push_back(flyer_at({6, 1.0 + 2.5 * (i % 3), 4.0 + 2 * (i / 3)}));
    goals.push_back(i % 4 == 3 ? stage.ground({34, 0, 6.0 + i})
                               : air_place({34, 1.0 + 2.5 * (i % 3), 4.0 + 2 * (i / 3)}));
  }
  const std::vector<AvatarId> ids = added(crowd, spawns);
  crowd.set_goals(ids, goals);
  for (int i = 0; i < 20; ++i) crowd.step();  // They fly to their goals.
  const EditId wall = put_up(crowd, edits, Prism::box({19, -1, -5}, {19.5, 40, 33}));
  ASSERT_FALSE(crowd.obstacle(wall)->waits());
  expect_all(go(crowd, stage, 12, 1200), 12);

  const EditId rest = put_up(crowd, edits, Prism::box({19, -1, 32}, {19.5, 40, 45}));
  const Place back = air_place({6, 5, 20});
  crowd.set_goals(std::span(&ids[0], 1), std::span(&back, 1));
  // Floods on foot look for air that leads there, which takes some steps.
  int steps = 0;
  for (; steps < 60 && crowd.goal_unreachable().empty(); ++steps) crowd.step();
  ASSERT_EQ(crowd.goal_unreachable().size(), 1u);
  EXPECT_EQ(crowd.goal_unreachable()[0], ids[0]);
  RecordProperty("steps_to_unreachable", steps);
  ASSERT_TRUE(edits.remove(rest));
  crowd.set_goals(std::span(&ids[0], 1), std::span(&back, 1));
  expect_all(go(crowd, stage, 1, 1200), 1);
}

// Some hover so near to a wall that the finder's cells around them are not free.
TEST(Flyers, FindPathsFromAndToWhereTheyTouchAWall) {
  Stage stage(open_air(40, 12));
  Edits edits;
  Crowd crowd = made(stage.world(), {.edits = edits});
  std::vector<AvatarSpawn> spawns;
  std::vector<Place> goals;
  for (int i = 0; i < 6; ++i) {
    spawns.push_back(flyer_at({18.59 - 0.05 * i, 2, 6.0 + 3 * i}));
    goals.push_back(air_place({19.92 + 0.05 * i, 2, 6.0 + 3 * i}));
  }
  put_up(crowd, edits, Prism::box({19, -1, -5}, {19.5, 40, 33}));
  crowd.set_goals(added(crowd, spawns), goals);
  expect_all(go(crowd, stage, 6, 1200), 6);
}

TEST(Flyers, FlyStraightWherePathsAreNotRequested) {
  Stage stage(open_air(30, 15));
  Crowd crowd = made(stage.world(), {.routing = Routing::kStraight});
  std::vector<AvatarSpawn> spawns = {flyer_at({5, 5, 5}),
                                     {.place = stage.ground({8, 0, 8}), .avatar_class = kFlyer},
                                     flyer_at({9, 9, 9})};
  const std::vector<Place> goals = {air_place({20, 8, 20}), air_place({20, 4, 8}),
                                    stage.ground({12, 0, 20})};
  crowd.set_goals(added(crowd, spawns), goals);
  expect_all(go(crowd, stage, 3, 200), 3);
}

TEST(Flyers, NoneIsAddedWhereItCannotFly) {
  Stage stage(open_air(20, 10));
  Crowd crowd = made(stage.world());
  const AvatarSpawn flyer{.avatar_class = kFlyer}, adult{.avatar_class = kAdult};
  EXPECT_TRUE(added(crowd, air_place({10, 3, 10}), flyer));
  EXPECT_FALSE(added(crowd, air_place({10, 4, 10}), flyer));  // an avatar is there
  EXPECT_TRUE(added(crowd, air_place({10, 5, 10}), flyer));   // above it
  EXPECT_FALSE(added(crowd, air_place({10, -3, 10}), flyer));
  EXPECT_FALSE(added(crowd, air_place({10, 1e9, 10}), flyer));
  EXPECT_FALSE(added(crowd, air_place({NAN, 3, 10}), flyer));
  EXPECT_FALSE(added(crowd, air_place({-5, 3, 10}), flyer));
  EXPECT_FALSE(added(crowd, air_place({5, 3, 5}), adult));  // it does not fly
  Context context;
  const auto none = crowd.scatter(5, {.place = air_place({}), .avatar_class = kAdult}, context);
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().code, Errc::kBadConfig);
}

TEST(Flyers, UnreachableGoalsAreReported) {
  Stage stage(window());
  Crowd crowd = made(stage.world());
  const AvatarId id = added(crowd, air_place({5, 2, 5}), {.avatar_class = kFlyer});
  const Place inside = air_place({12.2, 1, 1});  // of the wall
  crowd.set_goals(std::span(&id, 1), std::span(&inside, 1));
  EXPECT_EQ(crowd.step().no_path, 1u);
  ASSERT_EQ(crowd.goal_unreachable().size(), 1u);
  EXPECT_EQ(crowd.goal_unreachable()[0], id);
  EXPECT_EQ(crowd.step().flying, 1u);
}

TEST(Flyers, AreSentToRegionsAndSeenToComeIn) {
  Stage stage(open_air(30, 15));
  Crowd crowd = made(stage.world());
  const AvatarId flyer = added(crowd, air_place({4, 6, 4}), {.avatar_class = kFlyer});
  const AvatarId walker = added(crowd, stage.ground({4, 0, 12}, kAdult), {.avatar_class = kAdult});
  const Prism area = Prism::box({20, -0.5, 5}, {26, 0.5, 20});
  Context context;
  const auto target = crowd.add_target(std::span(&area, 1), context);
  ASSERT_TRUE(target) << target.error().message;
  const auto watched = crowd.watch_area(std::span(&area, 1));
  ASSERT_TRUE(watched);
  const AvatarId both[] = {flyer, walker};
  crowd.set_targets(both, *target);
  std::set<uint32_t> entered;
  Stage::Faults faults;
  for (int step = 0; step < 250; ++step) {
    crowd.step();
    for (const AreaEntry& entry : crowd.entered()) entered.insert(entry.id.slot1);
    stage.look(crowd, faults);
  }
  EXPECT_EQ(entered, (std::set<uint32_t>{flyer.slot1, walker.slot1}));
  EXPECT_EQ(crowd.read(flyer)->mode, MoveMode::kWalk);
  EXPECT_EQ(faults.overlaps + faults.entered, 0u);
}

}  // namespace
}  // namespace throng
