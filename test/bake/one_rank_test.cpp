// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cstdlib>
#include <string>
#include <utility>
#include <vector>

#include "folder_bytes.h"
#include "scratch_folder.h"
#include "throng/bake.h"
#include "worlds.h"

// Functions of ranks in a process that was started alone: test/apps/ranks_test.py has the others.
namespace throng {
namespace {

// Environment variables while this lives; the ones of before come back.
class Environment {
 public:
  explicit Environment(const std::vector<std::pair<const char*, const char*>>& values) {
    for (const char* name :
         {"OMPI_COMM_WORLD_RANK", "OMPI_COMM_WORLD_SIZE", "PMI_RANK", "PMI_SIZE"}) {
      const char* before = std::getenv(name);
      before_.emplace_back(name, before != nullptr ? before : "");
      unsetenv(name);
    }
    for (const auto& [name, value] : values) setenv(name, value, 1);
  }
  ~Environment() {
    for (const auto& [name, value] : before_) {
      if (value.empty()) {
        unsetenv(name);
      } else {
        setenv(name, value.c_str(), 1);
      }
    }
  }
  Environment(const Environment&) = delete;
  Environment& operator=(const Environment&) = delete;

 private:
  std::vector<std::pair<const char*, std::string>> before_;
};

std::pair<int32_t, int32_t> rank_and_size() {
  const RankInfo info = rank_info();
  return {info.rank, info.size};
}

TEST(RankInfo, IsWhatMpirunSetsAndElseOneOfOne) {
  using Pair = std::pair<int32_t, int32_t>;
  {
    const Environment alone({});
    EXPECT_EQ(rank_and_size(), (Pair{0, 1}));
  }
  {
    const Environment open_mpi({{"OMPI_COMM_WORLD_RANK", "2"}, {"OMPI_COMM_WORLD_SIZE", "5"}});
    EXPECT_EQ(rank_and_size(), (Pair{2, 5}));
  }
  {
    const Environment mpich({{"PMI_RANK", "1"}, {"PMI_SIZE", "3"}});
    EXPECT_EQ(rank_and_size(), (Pair{1, 3}));
  }
  for (const auto& [rank, size] : std::vector<std::pair<const char*, const char*>>{
           {"5", "5"}, {"-1", "4"}, {"x", "4"}, {"0", "0"}, {"", ""}, {"1", "999999999999"}}) {
    const Environment broken({{"OMPI_COMM_WORLD_RANK", rank}, {"OMPI_COMM_WORLD_SIZE", size}});
    EXPECT_EQ(rank_and_size(), (Pair{0, 1})) << rank << " of " << size;
  }
}

TEST(OneRank, AgreesWithItself) {
  const Environment alone({});
  Context context;
  EXPECT_TRUE(agree_over_ranks({}));
  EXPECT_TRUE(meet_over_ranks({}, context));
  const Error error{Errc::kBadInput, "scene: no triangle"};
  const Result<void> agreed = agree_over_ranks(error);
  ASSERT_FALSE(agreed);
  EXPECT_EQ(agreed.error().message, error.message);
  const Result<void> met = meet_over_ranks(error, context);
  ASSERT_FALSE(met);
  EXPECT_EQ(met.error().code, error.code);
}

TEST(OneRank, BakesAWorldAndItsNodesAsOneProcessDoes) {
  const Environment alone({});
  const test::ScratchFolder folder;
  const std::string by_rank = folder.path() + "/by_rank", by_process = folder.path() + "/process";
  const Scene scene = worlds::doorway(1.2);
  const BakeConfig config{.cell = 0.2};
  Context context;
  const auto report = bake_over_ranks(by_rank, scene, config, context);
  ASSERT_TRUE(report) << report.error().message;
  EXPECT_GT(report->zones, 0u);
  EXPECT_EQ(report->zones_baked, report->zones);
  ASSERT_TRUE(bake_world_to(by_process, scene, config, context));
  EXPECT_EQ(test::folder_bytes(by_rank), test::folder_bytes(by_process));

  const auto world = World::open(by_rank), other = World::open(by_process);
  ASSERT_TRUE(world && other);
  const auto summary = nodes_over_ranks(*world, scene, {}, context);
  ASSERT_TRUE(summary) << summary.error().message;
  const auto nodes = Nodes::create_in_folder(*other, scene, {}, context);
  ASSERT_TRUE(nodes) << nodes.error().message;
  EXPECT_GT(summary->nodes, 0u);
  EXPECT_EQ(summary->nodes, nodes->summary().nodes);
  EXPECT_EQ(summary->arcs, nodes->summary().arcs);
  const test::FolderBytes made = test::folder_bytes(by_rank + "/nodes");
  EXPECT_FALSE(made.empty());
  EXPECT_EQ(made, test::folder_bytes(by_process + "/nodes"));
  // Again: all is there.
  const auto again = bake_over_ranks(by_rank, scene, config, context);
  ASSERT_TRUE(again) << again.error().message;
  EXPECT_EQ(again->zones_reused, report->zones);
}

TEST(OneRank, RefusesWhatOneProcessRefuses) {
  const Environment alone({});
  const test::ScratchFolder folder;
  const std::string path = folder.path() + "/w";
  const Scene scene = worlds::flat(6);
  Context context;
  const auto of = [](const auto& result) { return result ? Errc::kOk : result.error().code; };
  EXPECT_EQ(of(bake_over_ranks(path, {}, {}, context)), Errc::kBadInput);
  EXPECT_EQ(of(bake_over_ranks(path, scene, {.cell = 0}, context)), Errc::kBadConfig);
  context.cancel = true;
  EXPECT_EQ(of(bake_over_ranks(path, scene, {}, context)), Errc::kCancelled);
  EXPECT_FALSE(World::open(path)) << "nothing was baked";
  context.cancel = false;
  ASSERT_TRUE(bake_over_ranks(path, scene, {.cell = 0.2}, context));
  const auto world = World::open(path);
  ASSERT_TRUE(world) << world.error().message;
  EXPECT_EQ(of(nodes_over_ranks(*world, scene, {.size = 1000}, context)), Errc::kBadConfig);
  context.cancel = true;
  EXPECT_EQ(of(nodes_over_ranks(*world, scene, {}, context)), Errc::kCancelled);
  EXPECT_FALSE(Nodes::exist(*world));
}

}  // namespace
}  // namespace throng
