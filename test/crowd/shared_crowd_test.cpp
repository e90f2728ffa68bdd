// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "crowd/shared_crowd.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "baked.h"
#include "thread_ranks.h"
#include "throng/bake.h"
#include "throng/crowd.h"
#include "throng/scene.h"

// A crowd that ranks share does what it does in one process, avatar by avatar.
namespace throng {
namespace {

// What a crowd did: a hash after each step, and what it said.
struct Course {
  std::vector<uint64_t> hashes;
  std::vector<uint64_t> counts;  // of reports and events
  std::vector<AvatarState> states;
  uint64_t faults = 0;
  uint64_t sent_bytes = 0;
};

using Program = std::function<void(Crowd&, Edits, Course&)>;

void note(Crowd& crowd, const CrowdReport& report, Course& course) {
  course.hashes.push_back(crowd.state_hash());
  course.sent_bytes += report.sent_bytes;
  course.counts.insert(
      course.counts.end(),
      {report.avatars, report.stood, report.arrived, report.planned, report.no_path,
       report.jam_searches, report.changed_route, report.waiting, crowd.entered().size(),
       crowd.no_progress().size(), static_cast<uint64_t>(1e9 * report.progress)});
  for (const AvatarId id : crowd.arrived()) course.counts.push_back(id.slot1);
  for (const AvatarId id : crowd.goal_unreachable()) course.counts.push_back(id.slot1);
}

Course alone(const World& world, const CrowdConfig& config, const Program& program) {
  CrowdConfig own = config;
  own.edits = Edits();
  auto crowd = Crowd::create(world, own);
  EXPECT_TRUE(crowd) << crowd.error().message;
  Course course;
  program(*crowd, own.edits, course);
  crowd->read(course.states);
  return course;
}

// The courses of all ranks, with all avatars of all of them in order.
std::vector<Course> shared(const World& world, const CrowdConfig& config, int32_t ranks,
                           const Program& program) {
  std::vector<Course> courses(static_cast<size_t>(ranks));
  test::ThreadRanks(ranks).run([&](RankGroup& group) {
    Course& course = courses[static_cast<size_t>(group.rank())];
    CrowdConfig own = config;
    own.edits = Edits();
    auto crowd = crowd::share_crowd(Crowd::create(world, own), group);
    ASSERT_TRUE(crowd) << crowd.error().message;
    program(*crowd, own.edits, course);
    course.states = crowd::own_avatars(*crowd);
  });
  return courses;
}

void expect_same(const World& world, const CrowdConfig& config, const std::vector<int32_t>& ranks,
                 const Program& program, const std::string& name) {
  const Course one = alone(world, config, program);
  EXPECT_EQ(one.faults, 0u) << name;
  for (const int32_t count : ranks) {
    const std::vector<Course> many = shared(world, config, count, program);
    std::map<uint32_t, AvatarState> by_id;
    for (size_t rank = 0; rank < many.size(); ++rank) {
      for (size_t step = 0; step < one.hashes.size(); ++step) {
        ASSERT_EQ(many[rank].hashes[step], one.hashes[step])
            << name << ", " << count << " ranks, rank " << rank << ", step " << step;
      }
      EXPECT_EQ(many[rank].counts, one.counts) << name << ", " << count << " ranks";
      EXPECT_EQ(many[rank].faults, 0u) << name;
      EXPECT_EQ(many[rank].sent_bytes > 0, count > 1) << name << ": there was nothing to share";
      EXPECT_GT(many[rank].states.size(), 0u) << name << ": rank " << rank << " has no avatars";
      for (const AvatarState& state : many[rank].states) {
        EXPECT_TRUE(by_id.emplace(state.id, state).second) << "two ranks have " << state.id;
      }
    }
    ASSERT_EQ(by_id.size(), one.states.size()) << name;
    for (const AvatarState& state : one.states) {
      const AvatarState& other = by_id[state.id];
      EXPECT_EQ(other.position, state.position) << name;
      EXPECT_EQ(other.heading_x, state.heading_x) << name;
      EXPECT_EQ(other.velocity, state.velocity) << name;
    }
  }
}

// Random goals, one after the other.
Program wanders(const World& world, uint32_t avatars, int steps) {
  return [&world, avatars, steps](Crowd& crowd, const Edits&, Course& course) {
    Context context;
    const auto ids = crowd.scatter(avatars, {}, context);
    ASSERT_TRUE(ids) << ids.error().message;
    std::vector<uint64_t> given(avatars, 0);
    const auto give = [&](std::span<const AvatarId> those) {
      std::vector<Place> goals;
      for (const AvatarId id : those) {
        goals.push_back(world.random_place(0, 7, uint64_t{id.slot1} << 32 | given[id.slot1 - 1]++));
      }
      crowd.set_goals(those, goals);
    };
    give(*ids);
    for (int step = 0; step < steps; ++step) {
      const CrowdReport report = crowd.step();
      note(crowd, report, course);
      give(std::vector(crowd.arrived().begin(), crowd.arrived().end()));
      give(std::vector(crowd.goal_unreachable().begin(), crowd.goal_unreachable().end()));
      if (step % 20 == 19) {
        const CrowdCheck check = crowd.check();
        course.faults += check.overlaps + check.wall_entries;
      }
    }
  };
}

// Box across the whole world, between two values of x. [m from its corner]
Prism slab(const World& world, double x0, double x1) {
  const Box3d all = world.summary().bounds;
  return {.corners = {{all.min.x + x0, all.min.z},
                      {all.min.x + x1, all.min.z},
                      {all.min.x + x1, all.max.z},
                      {all.min.x + x0, all.max.z}},
          .low = all.min.y - 1,
          .high = all.max.y + 1};
}

const World& garage() {
  static const World world = test::bake(test::builtin({.name = "garage", .seed = 3}), 0.1);
  return world;
}

TEST(SharedCrowd, WandersAsOneProcessDoes) {
  expect_same(garage(), {.workers = 1}, {1, 2, 3, 5}, wanders(garage(), 400, 150), "garage");
}

// Corridors as wide as one body: those that meet there stand aside for each other, over borders
// too.
TEST(SharedCrowd, StandsAsideAsOneProcessDoes) {
  const World world = test::bake(test::builtin({.name = "maze", .seed = 3}), 0.1);
  expect_same(world, {.workers = 1}, {2, 4}, wanders(world, 150, 400), "maze");
}

TEST(SharedCrowd, WithEveryModelAndInSubSteps) {
  for (const SteeringModel model : {SteeringModel::kSocialForce, SteeringModel::kCurvilinear}) {
    expect_same(garage(), {.workers = 1, .model = model}, {3}, wanders(garage(), 300, 60),
                "model " + std::to_string(static_cast<int>(model)));
  }
  CrowdConfig config{.dt = 0.4, .workers = 2};
  expect_same(garage(), config, {3}, wanders(garage(), 300, 60), "long steps");
  config = {.workers = 1};
  config.tuning.let_push();
  expect_same(garage(), config, {3}, wanders(garage(), 300, 60), "pushing");
  config = {.workers = 1};
  config.routing = Routing::kStraight;
  expect_same(garage(), config, {3}, wanders(garage(), 300, 60), "straight");
  // Low detail beyond a view, where avatars take four steps at once.
  config = {.workers = 1};
  config.tuning.low_detail_steps = 4;
  const Box3d all = garage().summary().bounds;
  const CrowdView view{.position = (all.min + all.max) * 0.5, .radius = 8};
  const auto seen = [&](Crowd& crowd, const Edits& edits, Course& course) {
    crowd.set_views({&view, 1});
    wanders(garage(), 300, 60)(crowd, edits, course);
  };
  expect_same(garage(), config, {2, 3}, seen, "levels of detail");
}

// Avatars that come, go, change their speeds, are driven, head to targets and are watched.
TEST(SharedCrowd, TakesEveryCall) {
  const World& world = garage();
  const auto program = [&](Crowd& crowd, const Edits&, Course& course) {
    Context context;
    const auto first = crowd.scatter(200, {}, context);
    ASSERT_TRUE(first);
    const auto target = crowd.add_target(std::vector{slab(world, 0, 4)}, context);
    ASSERT_TRUE(target) << target.error().message;
    const auto area = crowd.watch_area(std::vector{slab(world, 10, 14)});
    ASSERT_TRUE(area);
    crowd.set_targets(*first, *target);
    std::vector<AvatarId> later;
    for (int step = 0; step < 120; ++step) {
      note(crowd, crowd.step(), course);
      const std::vector<AvatarId> there(crowd.arrived().begin(), crowd.arrived().end());
      if (step % 3 == 0) crowd.remove(there);
      for (AvatarId forged : there) {  // The next one of its slot, which is not there yet.
        ++forged.generation;
        course.counts.push_back(step % 3 == 0 && crowd.read_here(forged) ? 1 : 0);
      }
      std::vector<AvatarSpawn> spawns;
      for (uint64_t n = 0; n < 4; ++n) {
        spawns.push_back({.place = world.random_place(0, 11, 4 * static_cast<uint64_t>(step) + n),
                          .speed = 1 + 0.1 * static_cast<double>(n)});
      }
      const auto ids = crowd.add(spawns, context);
      ASSERT_TRUE(ids);
      for (const AvatarId id : *ids) {
        course.counts.push_back(id.slot1);
        if (id) later.push_back(id);
      }
      std::vector<AvatarId> some;
      std::vector<Place> goals;
      std::vector<Vec3d> velocities;
      std::vector<double> speeds;
      for (size_t n = static_cast<size_t>(step) % 5; n < later.size(); n += 5) {
        some.push_back(later[n]);
        goals.push_back(world.random_place(0, 13, n));
        velocities.push_back({0.5, 0, n % 2 == 0 ? 0.7 : -0.7});
        speeds.push_back(0.8 + 0.01 * static_cast<double>(n % 60));
      }
      if (step % 7 == 1) crowd.set_goals(some, goals);
      if (step % 7 == 3) crowd.set_velocities(some, velocities);
      if (step % 7 == 5) crowd.set_speeds(some, speeds);
      if (step % 30 == 20) {
        const auto more = crowd.scatter(30, {}, context);
        ASSERT_TRUE(more);
        for (const AvatarId id : *more) course.counts.push_back(id.slot1);
      }
      course.counts.push_back(crowd.size());
      if (!later.empty()) {
        const AvatarId one = later[later.size() / 2];
        course.counts.push_back(crowd.is_alive(one) ? 1 : 0);
        course.counts.push_back(
            static_cast<uint64_t>(std::min(1e9, 1e3 * crowd.distance(one, *target))));
        const auto state = crowd.read(one);
        course.counts.push_back(state ? static_cast<uint64_t>(1e6 * state->position.x + 1e9) : 0);
      }
      if (step % 20 == 19) {
        const CrowdCheck check = crowd.check();
        course.faults += check.overlaps + check.wall_entries + check.obstacle_entries;
      }
    }
  };
  expect_same(world, {.workers = 1}, {2, 4}, program, "every call");
}

// Saved by so many ranks, restored by others or in one process: the same steps as undisturbed.
TEST(SharedCrowd, IsSavedAndRestoredByAnyNumberOfRanks) {
  const World& world = garage();
  const CrowdConfig config{.workers = 1};
  constexpr int kSteps = 60;
  std::vector<std::set<uint64_t>> hashes(40);  // of each step, whichever ranks
  std::mutex adding;
  const Course whole = alone(world, config, wanders(world, 300, 2 * kSteps));
  for (const int32_t savers : {1, 3}) {
    std::vector<std::vector<uint8_t>> saved(static_cast<size_t>(savers));
    test::ThreadRanks(savers).run([&](RankGroup& group) {
      CrowdConfig own = config;
      own.edits = Edits();
      auto crowd = crowd::share_crowd(Crowd::create(world, own), group);
      ASSERT_TRUE(crowd);
      Course course;
      wanders(world, 300, kSteps)(*crowd, own.edits, course);
      saved[static_cast<size_t>(group.rank())] = crowd->save();
      ASSERT_EQ(course.hashes.back(), whole.hashes[kSteps - 1]);
    });
    for (const auto& of_rank : saved) ASSERT_EQ(of_rank, saved[0]);
    for (const int32_t restorers : {1, 2, 4}) {
      test::ThreadRanks(restorers).run([&](RankGroup& group) {
        Context context;
        CrowdConfig own = config;
        own.edits = Edits();
        auto crowd = crowd::share_crowd(Crowd::restore(world, own, saved[0], context), group);
        ASSERT_TRUE(crowd) << crowd.error().message;
        ASSERT_EQ(crowd->state_hash(), whole.hashes[kSteps - 1]);
        ASSERT_EQ(crowd->size(), 300u);
        for (int step = 0; step < 40; ++step) {
          crowd->step();
          const uint64_t hash = crowd->state_hash();
          const std::lock_guard lock(adding);
          hashes[static_cast<size_t>(step)].insert(hash);
        }
        const CrowdCheck check = crowd->check();
        EXPECT_EQ(check.overlaps + check.wall_entries, 0u);
      });
    }
  }
  for (const auto& of_step : hashes) EXPECT_EQ(of_step.size(), 1u);
}

// Obstacles that avatars block, that others leave, and that move.
TEST(SharedCrowd, ObstaclesWaitForAvatarsOfAllRanks) {
  const World& world = garage();
  const auto program = [&](Crowd& crowd, Edits edits, Course& course) {
    Context context;
    const auto ids = crowd.scatter(250, {}, context);
    ASSERT_TRUE(ids);
    std::vector<Place> goals;
    for (size_t n = 0; n < ids->size(); ++n) goals.push_back(world.random_place(0, 17, n));
    crowd.set_goals(*ids, goals);
    std::vector<EditId> put;
    for (int step = 0; step < 120; ++step) {
      if (step % 40 == 5) {
        for (const ObstaclePolicy policy : {ObstaclePolicy::kRefuseEntry, ObstaclePolicy::kWait}) {
          const double x = 6 + 5 * static_cast<double>(put.size());
          const auto id = edits.add_obstacle(slab(world, x, x + 1), ObstacleKind::kStatic, policy);
          ASSERT_TRUE(id) << id.error().message;
          put.push_back(*id);
        }
      }
      if (step % 40 == 30) {
        ASSERT_TRUE(edits.remove(put.back()));
        put.pop_back();
      }
      note(crowd, crowd.step(), course);
      for (const AvatarId id : crowd.blockers()) course.counts.push_back(id.slot1);
      if (step % 10 == 9) {
        const CrowdCheck check = crowd.check();
        course.faults += check.overlaps + check.wall_entries + check.obstacle_entries;
      }
    }
  };
  expect_same(world, {.workers = 1}, {2, 4}, program, "obstacles");
}

}  // namespace
}  // namespace throng
