// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "command.h"
#include "run/rerun.h"
#include "run/run_recorder.h"
#include "scratch_folder.h"
#include "throng/bake.h"
#include "worlds.h"

// A repeated run has the hashes of its recording, or the first step that differs is named.
namespace throng::app {
namespace {

class ReplayCheck : public testing::Test {
 protected:
  void SetUp() override {
    Context context;
    BakeConfig config;
    ASSERT_TRUE(bake_world_to(folder_.path() + "/w.throng", worlds::flat(12), config, context));
    world_ = *World::open(folder_.path() + "/w.throng");
  }

  // A run of 20 steps, frames at each third, the hash of step `wrong` spoiled.
  std::string record(uint64_t wrong, const Json& settings) {
    const std::string path = folder_.path() + "/run.replay";
    auto crowd = Wanderers::create(world_, {.avatars = 20, .dt = 0.25, .seed = 5});
    EXPECT_TRUE(crowd);
    RunRecorder recorder;
    EXPECT_TRUE(recorder.open(path,
                              {.world = folder_.path() + "/w.throng",
                               .dt = 0.25,
                               .model = kWanderersModel,
                               .settings = settings.dump()},
                              world_));
    std::vector<AvatarState> states;
    for (uint64_t step = 0; step <= 20; ++step) {
      if (step > 0) crowd->step();
      const uint64_t hash = crowd->state_hash() + (step == wrong ? 1 : 0);
      crowd->read(states);
      EXPECT_TRUE(step % 3 == 0 ? recorder.add(step, hash, states) : recorder.add_hash(step, hash));
    }
    EXPECT_TRUE(recorder.finish(""));
    return path;
  }

  Json settings() const {
    WanderRun run;
    run.class_name = "adult";
    run.config = {.avatars = 20, .dt = 0.25, .seed = 5};
    return wanderers_settings(run);
  }

  // Exit code and output.
  static std::pair<int, std::string> check(const std::string& path) {
    const char* const words[] = {"throng", "replay", path.c_str(), "--check", "--json"};
    testing::internal::CaptureStdout();
    testing::internal::CaptureStderr();
    const int code = run_program(5, words, add_replay);
    const std::string out = testing::internal::GetCapturedStdout();
    return {code, out + testing::internal::GetCapturedStderr()};
  }

  test::ScratchFolder folder_;
  World world_;
};

TEST_F(ReplayCheck, ARepeatedRunHasTheSameHashes) {
  const auto [code, text] = check(record(999, settings()));
  EXPECT_EQ(code, kDone) << text;
  const Json said = Json::parse(text);
  EXPECT_EQ(said["same"], 21);
  EXPECT_TRUE(said["first_difference"].is_null());
}

TEST_F(ReplayCheck, TheFirstStepThatDiffersIsNamedWithOrWithoutAFrame) {
  for (const uint64_t wrong : {0u, 6u, 7u, 20u}) {
    const auto [code, text] = check(record(wrong, settings()));
    EXPECT_EQ(code, kAnswerIsNo) << text;
    EXPECT_EQ(Json::parse(text)["first_difference"], wrong);
  }
  Json other = settings();
  other["seed"] = 6;
  const auto [code, text] = check(record(999, other));
  EXPECT_EQ(code, kAnswerIsNo) << text;
  EXPECT_EQ(Json::parse(text)["first_difference"], 0);
}

TEST_F(ReplayCheck, IncompleteSettingsAreRefused) {
  const auto refused = [&](const Json& bad, const std::string& word) {
    const auto [code, text] = check(record(999, bad));
    EXPECT_EQ(code, kBadUsage) << text;
    EXPECT_NE(text.find(word), std::string::npos) << text;
  };
  Json bad = settings();
  bad.erase("seed");
  refused(bad, "seed");
  bad = settings();
  bad["avatars"] = "many";
  refused(bad, "avatars");
  bad = settings();
  bad["class"] = "horse";
  refused(bad, "horse");
  refused(Json::array(), "cannot run again");
  // Another world of the same name.
  Context context;
  BakeConfig config;
  const std::string path = record(999, settings());
  ASSERT_TRUE(bake_world_to(folder_.path() + "/w.throng", worlds::flat(13), config, context));
  const auto [code, text] = check(path);
  EXPECT_EQ(code, kBadUsage);
  EXPECT_NE(text.find("not the world that was recorded"), std::string::npos) << text;
}

}  // namespace
}  // namespace throng::app
