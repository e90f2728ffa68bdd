// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

#include "baked.h"
#include "crowds.h"
#include "patch_nets.h"
#include "path/overlay/node_finder.h"
#include "prism_shell.h"
#include "simd_targets.h"
#include "throng/avatar.h"
#include "throng/crowd.h"
#include "throng/path.h"
#include "throng/surface.h"
#include "trips.h"
#include "verify/triangle_tree.h"
#include "verify/turned_body.h"
#include "worlds.h"

// Climbers in a crowd: none enters a solid or another avatar, however it leans, and all arrive.
namespace throng {
namespace {

constexpr int32_t kClimber = 0, kGecko = 1, kAdult = 2, kFlyer = 3;

std::vector<AvatarClass> classes() {
  std::vector<AvatarClass> all(2);
  all[0].name = "climber";
  all[0].radius = 0.25;
  all[0].climb_slope = 180;
  all[1] = {.name = "gecko", .height = 0.5, .radius = 0.15, .step_height = 0.2, .climb_slope = 120};
  all.push_back(default_classes()[0]);
  all.back().radius = 0.25;
  all.push_back(flyer_class());
  return all;
}

// A body's true shape: a cylinder along an axis.
struct Solid {
  Vec3d feet, axis;
  double height = 0, radius = 0;

  // Its farthest point in a direction.
  [[nodiscard]] Vec3d farthest(Vec3d offset) const {
    const double along = dot(offset, axis);
    const Vec3d across = offset - axis * along;
    const double size = length(across);
    return feet + axis * (along > 0 ? height : 0) + (size > 0 ? across * (radius / size) : Vec3d{});
  }
};

// Is there a plane between two bodies? By Gilbert's steps towards the point of all differences that
// is nearest to the origin. [Gilbert, An iterative procedure for computing the minimum of a
// quadratic form on a convex set, 1966]
bool are_apart(const Solid& a, const Solid& b) {
  constexpr int kSteps = 3000;
  const Vec3d up{0, 1, 0},
      middles = a.feet + a.axis * (a.height / 2) - b.feet - b.axis * (b.height / 2);
  const auto lies_between = [&](Vec3d offset) {
    return dot(offset, a.farthest(offset * -1) - b.farthest(offset)) > 0;
  };
  for (const Vec3d& offset : {up, up * -1, Vec3d{middles.x, 0, middles.z}}) {
    if (lies_between(offset)) return true;  // the steps converge to these slowly
  }
  Vec3d v = a.feet - b.feet;
  for (int n = 0; n < kSteps; ++n) {
    const Vec3d p = a.farthest(v * -1) - b.farthest(v);
    if (dot(v, p) > 0) return true;
    const Vec3d offset = p - v;
    const double size = dot(offset, offset);
    if (!(size > 0)) return false;
    v = v + offset * std::clamp(-dot(v, offset) / size, 0.0, 1.0);
  }
  return false;
}

TEST(Climbers, ThePlaneBetweenTwoBodiesIsFoundIfThereIsOne) {
  const Solid lying{{0, 0, 0}, {1, 0, 0}, 2, 0.25};
  EXPECT_TRUE(are_apart(lying, {{1, 0.255, 0}, {0, 1, 0}, 2, 0.25}));
  EXPECT_FALSE(are_apart(lying, {{1, 0.249, 0}, {0, 1, 0}, 2, 0.25}));
  EXPECT_TRUE(are_apart(lying, {{2.255, -1, 0}, {0, 1, 0}, 2, 0.25}));
  EXPECT_FALSE(are_apart(lying, {{2.249, -1, 0}, {0, 1, 0}, 2, 0.25}));
  EXPECT_FALSE(are_apart(lying, lying));
  const double half = std::sqrt(0.5);
  EXPECT_TRUE(are_apart(lying, {{0, 0.5, 0}, {half, half, 0}, 2, 0.3}));
  EXPECT_FALSE(are_apart(lying, {{0, 0.4, 0}, {half, half, 0}, 2, 0.3}));
}

// A world, and what is true in it: triangles and cylinders.
class Stage {
 public:
  explicit Stage(const Scene& scene, double cell = 0.25, double size = 0.7,
                 std::vector<AvatarClass> classes = throng::classes())
      : scene_(scene), tree_(scene_, 0), world_(test::bake(scene, cell, std::move(classes))) {
    Context context;
    auto made = Nodes::create(world_, scene_, {.size = size}, context);
    EXPECT_TRUE(made) << made.error().message;
    if (made) nodes_ = *made;
  }
  [[nodiscard]] const World& world() const { return world_; }
  [[nodiscard]] const Nodes& nodes() const { return nodes_; }
  [[nodiscard]] Crowd crowd(CrowdConfig config = {}) const {
    config.nodes = nodes_;
    return made(world_, config);
  }
  /// In the largest component of a class.
  [[nodiscard]] NodePlace place(int32_t avatar_class, uint64_t seed, uint64_t n) {
    if (parts_.size() <= static_cast<size_t>(avatar_class)) parts_.resize(kMaxAvatarClasses);
    std::vector<uint32_t>& part = parts_[static_cast<size_t>(avatar_class)];
    if (part.empty()) (void)nodes_.components(avatar_class, &part);
    for (uint64_t tries = 0;; ++tries) {
      const NodePlace place = nodes_.random_place(avatar_class, seed, n << 16 | tries);
      EXPECT_TRUE(place);
      if (!place || part[place.node1 - 1] == 0) return place;
    }
  }

  struct Faults {
    uint64_t overlaps = 0, entered = 0, bodies = 0, pairs = 0, leaning = 0;
  };
  void look(const Crowd& crowd, Faults& faults) {
    crowd.read(states_);
    const std::vector<AvatarClass> classes = world_.summary().classes;
    const auto of = [&](const AvatarState& s) -> const AvatarClass& {
      return classes[static_cast<size_t>(s.avatar_class)];
    };
    for (size_t i = 0; i < states_.size(); ++i) {
      const AvatarState& a = states_[i];
      if (a.mode != MoveMode::kFly) {  // (flyers_test.cpp tests these)
        const verify::Pose pose{a.position, a.up};
        faults.entered += verify::turned_intruder(tree_, of(a), pose).has_value() ? 1 : 0;
      }
      ++faults.bodies;
      faults.leaning += a.up.y < 0.7 ? 1 : 0;
      for (size_t j = i + 1; j < states_.size(); ++j) {
        const AvatarState& b = states_[j];
        constexpr double kTouch = 1e-6;  // [m] Bodies may touch.
        const auto solid = [&](const AvatarState& s) {
          return Solid{s.position, s.up, of(s).height - kTouch, s.radius - kTouch};
        };
        const double reach = of(a).height + of(b).height + a.radius + b.radius;
        if (length(a.position - b.position) > reach) continue;
        ++faults.pairs;
        const bool apart = are_apart(solid(a), solid(b));
        faults.overlaps += apart ? 0 : 1;
      }
    }
    const CrowdCheck check = crowd.check();
    faults.overlaps += check.overlaps;
    faults.entered += check.wall_entries + check.obstacle_entries;
  }

 private:
  Scene scene_;
  verify::TriangleTree tree_;
  World world_;
  Nodes nodes_;
  std::vector<std::vector<uint32_t>> parts_;
  std::vector<AvatarState> states_;
};

AvatarId added_on(Crowd& crowd, const NodePlace& place, int32_t avatar_class = kClimber) {
  return added(crowd, {}, {.avatar_class = avatar_class, .on_nodes = place});
}

Scene net() { return test::net_scene({.side = 3, .cell = 8, .relief = 6}); }

// Climbers and geckos, each with a goal of its own.
Crowd on_net(Stage& stage, uint32_t count, int32_t workers = 0) {
  Crowd crowd = stage.crowd({.workers = workers});
  for (uint32_t i = 0; i < count; ++i) {
    const int32_t avatar_class = i % 2 == 0 ? kClimber : kGecko;
    const AvatarId id = added_on(crowd, stage.place(avatar_class, 3, i), avatar_class);
    const NodePlace goal = stage.place(avatar_class, 4, i);
    if (id) crowd.set_goals(std::span(&id, 1), std::span(&goal, 1));
  }
  return crowd;
}

TEST(Climbers, ManyThatCrossANetAllArrive) {
  Stage stage(net());
  Crowd crowd = on_net(stage, 80);
  EXPECT_GE(crowd.size(), 60u);
  const TripRun<Stage> climbed = go(crowd, stage, crowd.size(), 9000, 10);
  expect_all(climbed, crowd.size());
  EXPECT_GT(climbed.faults.leaning, 0u);
  EXPECT_GT(climbed.faults.pairs, 0u);
}

// Pairs that would meet on the shortest path, and an avatar that stands on it.
TEST(Climbers, PassOthersThatComeTowardsThemAndThatStand) {
  Stage stage(net());
  Crowd crowd = stage.crowd();
  uint32_t bound = 0;
  // Goals are apart: no two want one place.
  std::vector<Vec3d> chosen;
  const auto draw = [&](uint64_t& n) {
    for (;;) {
      const NodePlace place = stage.place(kClimber, 15, n++);
      const bool is_apart = std::all_of(chosen.begin(), chosen.end(), [&](const Vec3d& other) {
        return length(other - place.feet) > 3;
      });
      if (!is_apart) continue;
      chosen.push_back(place.feet);
      return place;
    }
  };
  uint64_t drawn = 0;
  for (int pair = 0; pair < 6; ++pair) {
    const NodePlace a = draw(drawn), b = draw(drawn);
    const AvatarId ids[] = {added_on(crowd, a), added_on(crowd, b)};
    const NodePlace goals[] = {b, a};
    crowd.set_goals(ids, goals);
    bound += (ids[0] ? 1 : 0) + (ids[1] ? 1 : 0);
  }
  EXPECT_GE(bound, 8u);
  for (uint64_t n = 0; n < 30; ++n) added_on(crowd, stage.place(kGecko, 12, n), kGecko);
  EXPECT_GT(crowd.size(), bound + 20);
  expect_all(go(crowd, stage, bound, 1500, 5), bound);
}

// Walkers, climbers and flyers over one ground. Random goals; an avatar that arrives gets another.
struct Mixed {
  uint64_t steps = 0, arrived = 0;
  Stage::Faults faults;
};
Mixed mix(Stage& stage, uint32_t of_each, int steps, int every) {
  Crowd crowd = stage.crowd();
  std::vector<AvatarId> all;
  for (const AvatarSpawn& like :
       {AvatarSpawn{.avatar_class = kAdult}, AvatarSpawn{.avatar_class = kClimber},
        AvatarSpawn{.avatar_class = kGecko},
        AvatarSpawn{.place = air_place({}), .avatar_class = kFlyer}}) {
    const auto ids = scattered(crowd, of_each, like);
    all.insert(all.end(), ids.begin(), ids.end());
  }
  uint64_t goals = 0;
  const auto send = [&](std::span<const AvatarId> ids) {
    for (const AvatarId id : ids) {
      const AvatarState state = *crowd.read(id);
      const uint64_t n = goals++;
      if (state.mode == MoveMode::kClimb) {
        const NodePlace goal = stage.place(state.avatar_class, 7, n);
        crowd.set_goals(std::span(&id, 1), std::span(&goal, 1));
      } else {
        const Place goal = stage.world().random_place(state.avatar_class, 7, n);
        crowd.set_goals(std::span(&id, 1), std::span(&goal, 1));
      }
    }
  };
  send(all);
  Mixed mixed;
  std::vector<AvatarState> before, now;
  double ahead = 0, flown = 0;  // sums of cosines
  uint64_t looked = 0, flights = 0;
  crowd.read(before);
  for (int step = 0; step < steps; ++step) {
    const CrowdReport report = crowd.step();
    crowd.read(now);
    for (size_t i = 0; i < now.size(); ++i) {  // of 5 m/s at most
      const Vec3d displacement = now[i].position - before[i].position;
      EXPECT_LE(length(displacement), 0.8) << step << " " << i;
      // A climber faces its direction of motion, as it leans, unless it has just turned; a flyer
      // the plan of it. Orientations follow at 120 degrees a second, and flyers turn at once.
      if (now[i].mode == MoveMode::kFly) {
        const double size = std::hypot(displacement.x, displacement.z);
        if (size < 0.05) continue;
        flown += (now[i].heading_x * displacement.x + now[i].heading_z * displacement.z) / size;
        ++flights;
      }
      if (now[i].mode != MoveMode::kClimb || length(displacement) < 0.05) continue;
      const Vec3d heading = leaned({now[i].heading_x, 0, now[i].heading_z}, now[i].up);
      EXPECT_NEAR(length(heading), 1, 1e-6);
      EXPECT_NEAR(dot(heading, now[i].up), 0, 1e-6);
      ahead += dot(heading, displacement) / length(displacement);
      ++looked;
    }
    std::swap(before, now);
    EXPECT_EQ(report.climbing, 2 * of_each);
    mixed.steps += report.avatars;
    mixed.arrived += report.arrived;
    const std::vector<AvatarId> there(crowd.arrived().begin(), crowd.arrived().end());
    send(there);
    if (step % every == 0) stage.look(crowd, mixed.faults);
  }
  EXPECT_GT(ahead, 0.7 * static_cast<double>(looked));
  EXPECT_GT(looked, 100u);
  EXPECT_GT(flown, 0.5 * static_cast<double>(flights));
  EXPECT_GT(flights, 50u);
  EXPECT_EQ(mixed.faults.overlaps, 0u);
  EXPECT_EQ(mixed.faults.entered, 0u);
  EXPECT_GT(mixed.faults.pairs, 0u);
  testing::Test::RecordProperty("avatar_steps", std::to_string(mixed.steps));
  testing::Test::RecordProperty("bodies", std::to_string(mixed.faults.bodies));
  testing::Test::RecordProperty("leaning", std::to_string(mixed.faults.leaning));
  testing::Test::RecordProperty("pairs", std::to_string(mixed.faults.pairs));
  testing::Test::RecordProperty("arrived", std::to_string(mixed.arrived));
  return mixed;
}

TEST(Climbers, GoAmongWalkersAndFlyers) {
  Stage stage(net());
  const Mixed mixed = mix(stage, 16, 300, 5);
  EXPECT_GT(mixed.arrived, 20u);
}

// A million avatar-steps, each checked.
TEST(Climbers, AMillionStepsOverALandscapeSlow) {
  Stage stage(test::builtin({.name = "landscape", .size = 100, .seed = 3}), 0.5, 1.5);
  const Mixed mixed = mix(stage, 125, 2000, 1);
  EXPECT_GE(mixed.faults.bodies, 1000000u);
  EXPECT_GT(mixed.arrived, 500u);
}

TEST(Climbers, SameStateForAnyWorkersAndMachines) {
  Stage stage(net());
  const auto walk = [&](const char* name, std::initializer_list<int32_t> of) {
    for (const int32_t workers : of) {
      Crowd crowd = on_net(stage, 80, workers);
      for (int step = 0; step < 150; ++step) crowd.step();
      ASSERT_EQ(crowd.state_hash(), 4285069707934481589u) << name << ' ' << workers;
    }
  };
  walk("best", {1, 2, 8});
  test::for_every_simd_target([&](const char* name) { walk(name, {1}); });
}

TEST(Climbers, ARestoredCrowdContinuesAsTheSavedOneWould) {
  Stage stage(net());
  Crowd crowd = on_net(stage, 80);
  for (int step = 0; step < 50; ++step) crowd.step();
  const std::vector<uint8_t> saved = crowd.save();
  Context context;
  auto restored =
      Crowd::restore(stage.world(), {.workers = 1, .nodes = stage.nodes()}, saved, context);
  ASSERT_TRUE(restored) << restored.error().message;
  for (int step = 0; step < 40; ++step) {
    ASSERT_EQ(crowd.state_hash(), restored->state_hash()) << step;
    crowd.step();
    restored->step();
  }
  EXPECT_FALSE(Crowd::restore(stage.world(), {.workers = 1}, saved, context));
}

// If a body is saved at a place where it cannot be, nothing is restored.
TEST(Climbers, SavedBodiesAreChecked) {
  Stage stage(net());
  Crowd crowd = on_net(stage, 6);
  for (int step = 0; step < 20; ++step) crowd.step();
  std::vector<uint8_t> saved = crowd.save();
  Context context;
  for (size_t i = 0; i < saved.size(); i += 7) {
    std::vector<uint8_t> other = saved;
    other[i] ^= 0x40;
    EXPECT_FALSE(Crowd::restore(stage.world(), {.nodes = stage.nodes()}, other, context)) << i;
  }
}

// Down from a block as high as an adult, over its edge.
TEST(Climbers, LetThemselvesDownOverEdges) {
  AvatarClass jumper = default_classes()[0];
  jumper.name = "jumper";
  jumper.max_drop = 2.5;
  Scene scene = worlds::flat(16);
  scene.add_box({5, 0, 5}, {11, 2, 11});
  Stage stage(scene, 0.25, 1, {jumper});
  Crowd crowd = stage.crowd();
  std::vector<AvatarId> ids;
  std::vector<Place> goals;
  for (int i = 0; i < 9; ++i) {
    const Vec3d top{6.5 + 1.5 * (i % 3), 2, 6.5 + 1.5 * (i / 3)};
    ids.push_back(added(crowd, stage.world().find_place(0, top, 0.5), {.avatar_class = 0}));
    ASSERT_TRUE(ids.back());
    goals.push_back(stage.world().find_place(0, {1.5 + 1.6 * i, 0, 2}, 0.5));
    ASSERT_TRUE(goals.back());
  }
  crowd.set_goals(ids, goals);
  expect_all(go(crowd, stage, ids.size(), 900), ids.size());
  // None climbs back.
  const Place top = stage.world().find_place(0, {8, 2, 8}, 0.5);
  crowd.set_goals(std::span(ids).first(1), std::span(&top, 1));
  EXPECT_EQ(crowd.step().no_path, 1u);
  ASSERT_EQ(crowd.goal_unreachable().size(), 1u);
  EXPECT_EQ(crowd.goal_unreachable()[0], ids[0]);
}

TEST(Climbers, KeepOutOfObstaclesThatWaitForThem) {
  Stage stage(net());
  Edits edits;
  Crowd crowd = stage.crowd({.edits = edits});
  const NodePlace here = stage.place(kClimber, 5, 1);
  const AvatarId id = added_on(crowd, here);
  ASSERT_TRUE(id);
  const Vec3d& p = here.feet;
  const Prism box =
      Prism::box({p.x - 0.5, p.y - 0.5, p.z - 0.5}, {p.x + 0.5, p.y + 0.5, p.z + 0.5});
  const EditId at_it = put_up(crowd, edits, box);
  EXPECT_TRUE(crowd.obstacle(at_it)->waits());
  EXPECT_EQ(crowd.step().waiting, 1u);
  const NodePlace away = stage.place(kClimber, 5, 2);
  crowd.set_goals(std::span(&id, 1), std::span(&away, 1));
  expect_all(go(crowd, stage, 1, 400), 1);
  EXPECT_FALSE(crowd.obstacle(at_it)->waits());
  EXPECT_FALSE(added_on(crowd, here));
}

// While it walks, at rest, or when it has just begun.
TEST(Climbers, GetOutOfWhatClosesAroundThemAndEnterNoOther) {
  Stage stage(net());
  for (const uint64_t n : {1, 2, 3, 4}) {
    Edits edits;
    Crowd crowd = stage.crowd({.edits = edits});
    const NodePlace here = stage.place(kClimber, 5, n), away = stage.place(kClimber, 6, n);
    const AvatarId id = added_on(crowd, here);
    ASSERT_TRUE(id);
    if (n % 2 == 0) {
      crowd.set_goals(std::span(&id, 1), std::span(&away, 1));
      for (int step = 0; step < 20; ++step) crowd.step();
    }
    const Vec3d p = crowd.read(id)->position;
    const Prism box =
        Prism::box({p.x - 0.5, p.y - 0.5, p.z - 0.5}, {p.x + 0.5, p.y + 0.5, p.z + 0.5});
    const EditId crate = put_up(crowd, edits, box);
    EXPECT_TRUE(crowd.obstacle(crate)->waits());
    Stage::Faults faults;
    for (int step = 0; step < 100; ++step) {
      crowd.step();
      if (step % 5 == 0) stage.look(crowd, faults);
    }
    EXPECT_EQ(faults.overlaps + faults.entered, 0u);
    EXPECT_TRUE(crowd.obstacle(crate)->is_up()) << n;
  }
}

// Walls across all paths, put up before the climbers begin or while they move, with an opening at
// one end.
TEST(Climbers, GoAroundObstaclesThatArePutUpOnTheirPaths) {
  Stage stage(net());
  std::vector<Prism> walls;
  for (int i = 0; i < 2; ++i) {
    const double x = 8.0 + 8 * i;
    const double from = i % 2 == 0 ? -1 : 10, to = i % 2 == 0 ? 14 : 25;
    walls.push_back(Prism::box({x, -30, from}, {x + 0.2, 30, to}));
  }
  Scene shell;
  for (const Prism& wall : walls) test::add_to(shell, test::shell_of(wall));
  const verify::TriangleTree tree(shell, 1);
  for (const bool ahead : {true, false}) {
    Edits edits;
    Crowd crowd = stage.crowd({.edits = edits});
    std::vector<AvatarId> ids;
    const auto put_up_all = [&] {
      for (const Prism& wall : walls) put_up(crowd, edits, wall);
    };
    if (ahead) put_up_all();
    for (uint64_t n = 0; ids.size() < 6 && n < 400; ++n) {
      const int32_t avatar_class = n % 3 == 2 ? kGecko : kClimber;
      const NodePlace from = stage.place(avatar_class, 21, n),
                      to = stage.place(avatar_class, 22, n);
      // From one end to the other, and not where a wall will be.
      const auto clear = [&](Vec3d p) {
        return std::all_of(walls.begin(), walls.end(), [&](const Prism& wall) {
          return std::fabs(p.x - wall.corners[0][0]) > 2.2;
        });
      };
      if (std::fabs(from.feet.x - to.feet.x) < 13 || !clear(from.feet) || !clear(to.feet)) continue;
      const AvatarId id = added_on(crowd, from, avatar_class);
      if (!id) continue;
      crowd.set_goals(std::span(&id, 1), std::span(&to, 1));
      ids.push_back(id);
    }
    ASSERT_EQ(ids.size(), 6u);
    if (!ahead) {
      for (int step = 0; step < 10; ++step) crowd.step();
      put_up_all();
    }
    std::set<uint32_t> there;
    uint64_t inside = 0, bodies = 0;
    Stage::Faults faults;
    std::vector<AvatarState> states;
    for (int step = 0; step < 4000 && there.size() < ids.size(); ++step) {
      crowd.step();
      for (const AvatarId id : crowd.arrived()) there.insert(id.slot1);
      crowd.read(states);
      for (const AvatarState& s : states) {
        const AvatarClass avatar = classes()[static_cast<size_t>(s.avatar_class)];
        ++bodies;
        inside += verify::turned_intruder(tree, avatar, {s.position, s.up}) ? 1 : 0;
      }
      if (step % 5 == 0) stage.look(crowd, faults);
    }
    EXPECT_EQ(there.size(), ids.size());
    EXPECT_EQ(inside, 0u);
    EXPECT_EQ(faults.overlaps + faults.entered, 0u);
    EXPECT_GT(bodies, 1000u);
    EXPECT_EQ(crowd.obstacles().size(), walls.size());
  }
}

TEST(Climbers, AnExternallyControlledOneMovesAsItIsControlled) {
  Stage stage(test::net_scene({.side = 2, .cell = 8, .relief = 0, .sideways = 0}));
  Crowd crowd = stage.crowd();
  Context context;
  const auto finder = path::NodeFinder::create(stage.nodes(), {.avatar_class = kGecko}, context);
  ASSERT_TRUE(finder);
  const AvatarId id = added_on(crowd, finder->find_place({8, 0, 8}, 2), kGecko);
  ASSERT_TRUE(id);
  const Vec3d before = crowd.read(id)->position;
  const Vec3d offset{1, 0, 0.2};
  crowd.set_velocities(std::span(&id, 1), std::span(&offset, 1));
  Stage::Faults faults;
  for (int step = 0; step < 40; ++step) {
    crowd.step();
    stage.look(crowd, faults);
  }
  EXPECT_EQ(faults.entered, 0u);
  const Vec3d after = crowd.read(id)->position;
  EXPECT_NEAR(after.x - before.x, 4, 0.6);
  EXPECT_NEAR(after.z - before.z, 0.8, 0.4);
}

TEST(Climbers, AreSentToRegionsAndSeenToComeIn) {
  Stage stage(test::net_scene({.side = 2, .cell = 8, .relief = 1}));
  Crowd crowd = stage.crowd();
  const AvatarId id = added_on(crowd, stage.place(kClimber, 9, 1));
  ASSERT_TRUE(id);
  const Prism area = Prism::box({11, -20, 11}, {15, 20, 15});
  Context context;
  const auto target = crowd.add_target(std::span(&area, 1), context);
  ASSERT_TRUE(target) << target.error().message;
  ASSERT_TRUE(crowd.watch_area(std::span(&area, 1)));
  crowd.set_targets(std::span(&id, 1), *target);
  bool entered = false;
  for (int step = 0; step < 400 && !entered; ++step) {
    crowd.step();
    entered = !crowd.entered().empty();
  }
  EXPECT_TRUE(entered);
}

TEST(Climbers, NoneIsAddedWhereItCannotClimb) {
  Stage stage(net());
  Crowd crowd = stage.crowd();
  const NodePlace place = stage.place(kClimber, 2, 1);
  EXPECT_TRUE(added_on(crowd, place));
  EXPECT_FALSE(added_on(crowd, place));  // an avatar stands there
  EXPECT_FALSE(added_on(crowd, {}));
  NodePlace wrong = stage.place(kClimber, 2, 2);
  wrong.node1 = 1u << 30;
  EXPECT_FALSE(added_on(crowd, wrong));
  wrong = stage.place(kClimber, 2, 2);
  wrong.s = 7;
  EXPECT_FALSE(added_on(crowd, wrong));
  EXPECT_FALSE(added(crowd, air_place({12, 3, 12}), {.avatar_class = kClimber}));
  EXPECT_FALSE(added(crowd, Place{{12, 1e6, 12}, 1}, {.avatar_class = kClimber}));
  const NodePlace nowhere;
  const AvatarId id = added_on(crowd, stage.place(kClimber, 2, 3));
  crowd.set_goals(std::span(&id, 1), std::span(&nowhere, 1));
  EXPECT_EQ(crowd.step().no_path, 0u);
  NodePlace lost = stage.place(kClimber, 2, 4);
  lost.node1 = 1u << 30;
  crowd.set_goals(std::span(&id, 1), std::span(&lost, 1));
  EXPECT_EQ(crowd.step().no_path, 1u);
}

// Classes that climb, in a crowd without nodes: on level tiles they are as others.
TEST(Climbers, WalkWhereTheyCanAsOtherClassesDo) {
  AvatarClass climber = default_classes()[0], adult = climber;
  climber.name = "climber";
  climber.climb_slope = 120;
  const World world = test::bake(worlds::two_floors(), 0.1, {adult, climber});
  for (const int32_t avatar_class : {0, 1}) {
    Crowd crowd = made(world);
    std::vector<AvatarId> ids;
    std::vector<Place> goals;
    for (int i = 0; i < 8; ++i) {
      const double x = 2.0 + 0.8 * (i % 4), z = 3.0 + i / 4;
      ids.push_back(added(crowd, world.find_place(avatar_class, {x, 0, z}, 0.5),
                          {.avatar_class = avatar_class}));
      goals.push_back(world.find_place(avatar_class, {x + 4.5, 3, z}, 0.5));  // upstairs
      ASSERT_TRUE(ids.back() && goals.back());
    }
    crowd.set_goals(ids, goals);
    std::set<uint32_t> there;
    for (int step = 0; step < 600 && there.size() < ids.size(); ++step) {
      crowd.step();
      for (const AvatarId id : crowd.arrived()) there.insert(id.slot1);
      const CrowdCheck check = crowd.check();
      ASSERT_EQ(check.overlaps + check.wall_entries, 0u);
    }
    EXPECT_EQ(there.size(), ids.size()) << avatar_class;
    std::vector<AvatarState> states;
    crowd.read(states);
    for (const AvatarState& state : states) EXPECT_NEAR(state.position.y, 3, 0.01);
  }
}

}  // namespace
}  // namespace throng
