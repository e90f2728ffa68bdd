// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>

#include "core/random.h"
#include "scratch_folder.h"
#include "throng/scenario.h"
#include "validate/tracks.h"

namespace throng {
namespace {

namespace fs = std::filesystem;

class Recorded : public testing::Test {
 protected:
  std::string write(const std::string& name, const std::string& text) {
    const fs::path path = folder_ / name;
    fs::create_directories(path.parent_path());
    std::ofstream(path) << text;
    return path.string();
  }
  test::ScratchFolder scratch_;
  fs::path folder_ = scratch_.path();
};

double value_of(const ValidationResult& result, const std::string& name) {
  for (const ValidationMeasure& m : result.measures) {
    if (m.name == name) return m.value;
  }
  ADD_FAILURE() << name;
  return std::nan("");
}

TEST_F(Recorded, JuelichFilesStateTheirUnitAndTime) {
  const auto metres = validate::load_juelich(
      write("a.txt",
            "# framerate: 25 fps\n# id frame x/m y/m z/m\n1\t0\t2.5\t-1\t1.76\n"
            "1\t1\t2.6\t-1\t1.76\n\n7\t3\t0\t0\t1.8\n"));
  ASSERT_TRUE(metres) << metres.error().message;
  EXPECT_EQ(metres->fps, 25);
  ASSERT_EQ(metres->people.size(), 2U);
  EXPECT_EQ(metres->people[0].points[1].frame, 1);
  EXPECT_DOUBLE_EQ(metres->people[0].points[1].x, 2.6);
  EXPECT_EQ(metres->people[1].person, 7);
  const auto plain = validate::load_juelich(write("b.txt", "1 43 79.035 774.009 183.02\n"));
  ASSERT_TRUE(plain);
  EXPECT_EQ(plain->fps, 16);
  EXPECT_DOUBLE_EQ(plain->people[0].points[0].x, 0.79035);
}

TEST_F(Recorded, DamagedFilesAreRefusedWithTheLine) {
  const std::pair<const char*, const char*> cases[] = {
      {"1 0 2 3 4\n1 1 two 3 4\n", "bad.txt:2: numbers are expected"},
      {"1 0 2 3\n", "bad.txt:1: it has 4 numbers, 5 are expected"},
      {"1 5 2 3 4\n1 5 2 3 4\n", "bad.txt:2: frames of a person must ascend"},
      {"1 0 nan 3 4\n", "bad.txt:1: numbers"},
      {"1 -1 2 3 4\n", "bad.txt:1: a frame must be within 0 to 1000000"},
      {"1 1e8 2 3 4\n", "bad.txt:1: a frame must be within"},
      {"# framerate: 0 fps\n1 0 2 3 4\n", "bad.txt:1: the frames a second"},
      {"# framerate: many\n1 0 2 3 4\n", "bad.txt:1: the frames a second"},
      {"# nothing\n", "bad.txt: it has no positions"},
      {"", "bad.txt: it has no positions"},
  };
  for (const auto& [text, why] : cases) {
    const auto tracks = validate::load_juelich(write("bad.txt", text));
    ASSERT_FALSE(tracks) << text;
    EXPECT_EQ(tracks.error().code, Errc::kBadFile);
    EXPECT_NE(tracks.error().message.find(why), std::string::npos) << tracks.error().message;
  }
  EXPECT_FALSE(validate::load_juelich((folder_ / "none.txt").string()));
}

// Any file is either read or refused.
TEST_F(Recorded, DamagedFilesNeverDoHarm) {
  std::string good;
  for (int k = 0; k < 30; ++k) {
    for (int n = 1; n <= 2; ++n) {
      good += std::to_string(10 * k) + " " + std::to_string(n) + " " + std::to_string(0.5 * k) +
              " 0 " + std::to_string(3 * n) + " 0 0 0\n";
    }
  }
  const std::string bytes = "0123456789.-+eE \n\t#x\xff";
  int read = 0, refused = 0;
  for (uint64_t seed = 0; seed < 300; ++seed) {
    std::string text = good;
    for (uint64_t k = 0; k < 3; ++k) {
      const uint64_t at = random_below(seed, 1, k, text.size());
      text[at] = bytes[random_below(seed, 2, k, bytes.size())];
    }
    const auto tracks = validate::load_obsmat(write("obsmat.txt", text));
    ++(tracks ? read : refused);
    if (!tracks) {
      EXPECT_NE(tracks.error().message.find("obsmat.txt:"), std::string::npos);
    }
  }
  EXPECT_GT(read, 50);
  EXPECT_GT(refused, 50);
}

// Two people: one walks straight, the other turns aside by 0.1 m a sample. Constant velocity is
// right about the first; about the second it is off by 0.1 k after k samples: 0.65 in the mean of
// 12, 1.2 at the end.
TEST_F(Recorded, ErrorsOfConstantVelocityAreThoseWorkedOutByHand) {
  std::string text;
  const auto line = [&](int frame, int person, double x, double y) {
    text += std::to_string(frame) + " " + std::to_string(person) + " " + std::to_string(x) + " 0 " +
            std::to_string(y) + " 0 0 0\n";
  };
  for (int k = -1; k <= 12; ++k) {
    line(10 * k + 10, 1, 0.5 * k, 0);
    line(10 * k + 10, 2, 0.5 * k, 20 + 0.1 * std::max(0, k));
  }
  write("scene/obsmat.txt", text);
  Context context;
  const auto result = run_recorded_validation("walkers", folder_.string(), {}, context);
  ASSERT_TRUE(result) << result.error().message;
  EXPECT_EQ(value_of(*result, "scene: people predicted"), 2);
  EXPECT_NEAR(value_of(*result, "scene: mean error, constant velocity"), 0.65 / 2, 1e-5);
  EXPECT_NEAR(value_of(*result, "scene: error after 4.8 s, constant velocity"), 1.2 / 2, 1e-5);
  // Alone, [CAACD] and the social force keep on as well.
  EXPECT_NEAR(value_of(*result, "scene: mean error, [CAACD]"), 0.65 / 2, 1e-5);
  EXPECT_NEAR(value_of(*result, "scene: mean error, social force [HM95]"), 0.65 / 2, 1e-5);
  // No other is near, so ours walks straight as well, within a tenth of a millimetre.
  EXPECT_NEAR(value_of(*result, "scene: mean error, throng"), 0.65 / 2, 1e-3);
  EXPECT_NEAR(value_of(*result, "scene: min distance, half of people, real"), 20.1, 1e-5);
  EXPECT_NEAR(value_of(*result, "scene: min distance, half of people, constant velocity"), 20,
              1e-5);
  EXPECT_EQ(value_of(*result, "scene: bodies overlap, throng"), 0);
  EXPECT_EQ(result->faults.overlaps, 0U);
  // The folder itself may be the scene; the same for any workers.
  for (const int32_t workers : {1, 2, 4}) {
    const auto again = run_recorded_validation("walkers", (folder_ / "scene").string(),
                                               {.workers = workers}, context);
    ASSERT_TRUE(again) << again.error().message;
    ASSERT_EQ(again->measures.size(), result->measures.size());
    for (size_t i = 0; i < result->measures.size(); ++i) {
      EXPECT_EQ(again->measures[i].value, result->measures[i].value) << i;
    }
  }
}

// Every 2 s a person walks straight through an open corridor at 1 m/s: 2 are in the 7.2 m2 of the
// box at a time. Our avatars have a desired speed of 1.34 m/s: the same flow, a lower density.
TEST_F(Recorded, ARecordedCorridorIsMeasuredAsWorkedOutByHand) {
  std::string text = "# framerate: 10 fps\n# id frame x/m y/m z/m\n";
  for (int n = 0; n < 40; ++n) {
    for (int k = 0; k <= 140; ++k) {
      text += std::to_string(n) + " " + std::to_string(20 * n + k) + " 0.9 " +
              std::to_string(7.55 - 0.1 * k) + " 1.7\n";
    }
  }
  write("uo-180-180-180.txt", text);
  Context context;
  const auto result = run_recorded_validation("laboratory", folder_.string(), {}, context);
  ASSERT_TRUE(result) << result.error().message;
  const std::string at = "one way, open: ";
  EXPECT_EQ(value_of(*result, at + "people recorded over the line"), 40);
  EXPECT_EQ(value_of(*result, at + "people walked over the line"), 40);
  EXPECT_NEAR(value_of(*result, at + "flow, real"), 0.5, 1e-6);
  EXPECT_NEAR(value_of(*result, at + "speed, real"), 1, 1e-6);
  EXPECT_NEAR(value_of(*result, at + "density, real"), 2 / 7.2, 0.02);
  EXPECT_NEAR(value_of(*result, at + "path by straight line, real"), 1, 1e-9);
  EXPECT_EQ(value_of(*result, at + "turns of more than 90 degrees, real"), 0);
  EXPECT_NEAR(value_of(*result, at + "change of speed in 0.4 s, real"), 0, 1e-6);
  EXPECT_EQ(value_of(*result, at + "walked away from the line, real"), 0);
  EXPECT_NEAR(value_of(*result, at + "path by straight line, throng"), 1, 0.01);
  EXPECT_EQ(value_of(*result, at + "turns of more than 90 degrees, throng"), 0);
  EXPECT_NEAR(value_of(*result, at + "flow, throng"), 0.5, 0.01);
  EXPECT_NEAR(value_of(*result, at + "speed, throng"), 1.34, 0.02);
  EXPECT_NEAR(value_of(*result, at + "density, throng"), 2 / 1.34 / 7.2, 0.02);
  EXPECT_EQ(result->faults.overlaps + result->faults.wall_entries, 0U);
  write("uo-180-180-180.txt", "# x/m\n1 1 50 50 1.7\n1 2 50 50 1.7\n");
  const auto far = run_recorded_validation("laboratory", folder_.string(), {}, context);
  ASSERT_FALSE(far);
  EXPECT_NE(far.error().message.find("another experiment's file"), std::string::npos);
}

TEST_F(Recorded, FoldersWithoutScenesAreRefused) {
  Context context;
  for (const auto& recorded : recorded_validation_tests()) {
    for (const std::string& folder : {folder_.string(), (folder_ / "none").string()}) {
      const auto result = run_recorded_validation(recorded.name, folder, {}, context);
      ASSERT_FALSE(result) << recorded.name;
      EXPECT_EQ(result.error().code, Errc::kNotFound);
      EXPECT_NE(result.error().message.find(folder), std::string::npos);
    }
  }
  EXPECT_FALSE(run_recorded_validation("nosuch", folder_.string(), {}, context));
  write("short/obsmat.txt", "1 1 0 0 0 0 0 0\n11 1 1 0 0 0 0 0\n");
  const auto shorter = run_recorded_validation("walkers", folder_.string(), {}, context);
  ASSERT_FALSE(shorter);
  EXPECT_NE(shorter.error().message.find("too short"), std::string::npos);
}

}  // namespace
}  // namespace throng
