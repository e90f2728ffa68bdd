// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cstdlib>
#include <string>
#include <utility>
#include <vector>

#include "throng/bake.h"

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

}  // namespace
}  // namespace throng
