// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "report/avatars_csv.h"

#include <gtest/gtest.h>

#include <string>

#include "scratch_folder.h"

// Trajectory files: what is read from them, and the message for each fault.
namespace throng::app {
namespace {

const std::string kHead = "step,id,class,x,y,z,radius\n";

class AvatarsCsv : public testing::Test {
 protected:
  Result<std::vector<PictureAvatar>> read(const std::string& text) {
    folder_.write("avatars.csv", text);
    return read_avatars(path_);
  }
  // The message after the file's name.
  std::string refusal(const std::string& text) {
    const auto result = read(text);
    return result ? "accepted" : result.error().message.substr(path_.size());
  }

  test::ScratchFolder folder_;
  std::string path_ = folder_.path() + "/avatars.csv";
};

TEST_F(AvatarsCsv, WalkersKnowWhereTheyCameFrom) {
  ASSERT_TRUE(read(kHead + "0,1,adult,1,2,3,0.25\n0,2,adult,0,0,0,0.25\n4,2,adult,0,0,0,0.25\n" +
                   "4,1,adult,1,2,5,0.25\n8,1,adult,4,3,1,0.25\n8,2,adult,0,0,0,0.25\n"));
  const auto walkers = read_walkers(path_);
  ASSERT_TRUE(walkers) << walkers.error().message;
  ASSERT_EQ(walkers->size(), 2u);
  EXPECT_EQ((*walkers)[0].id, 1u);
  EXPECT_EQ((*walkers)[0].heading, (Vec3d{3, 0, -4}));
  EXPECT_DOUBLE_EQ((*walkers)[0].last_move, 5);
  EXPECT_DOUBLE_EQ((*walkers)[0].walked, 7);
  EXPECT_EQ((*walkers)[1].heading, (Vec3d{}));
  EXPECT_EQ((*walkers)[1].walked, 0);
}

TEST_F(AvatarsCsv, TheLastStepCounts) {
  const auto avatars = read(kHead + "0,1,adult,1,2,3,0.25\n9,1,adult,1.5,2.5,-3.5,0.25\n" +
                            "9,2,giant,4,5,6,0.4\r\n\n10,7,adult,-1.25,0,8,0.3\n");
  ASSERT_TRUE(avatars) << avatars.error().message;
  ASSERT_EQ(avatars->size(), 1u);
  EXPECT_EQ((*avatars)[0].position, (Vec3d{-1.25, 0, 8}));
  EXPECT_EQ((*avatars)[0].radius, 0.3);
}

TEST_F(AvatarsCsv, SomeMayLean) {
  const std::string head = "step,id,class,x,y,z,radius,up_x,up_y,up_z\n";
  ASSERT_TRUE(read(head + "0,1,adult,1,2,3,0.25,2,0,0\n0,2,adult,0,0,0,0.25,0,1,0\n" +
                   "4,1,adult,1,5,3,0.25,2,0,0\n4,2,adult,1,9,0,0.25,0,1,0\n"));
  const auto walkers = read_walkers(path_);
  ASSERT_TRUE(walkers) << walkers.error().message;
  // Up a wall that faces +X: along -X before it leans, and all of it is walked.
  EXPECT_EQ((*walkers)[0].up, (Vec3d{1, 0, 0}));
  EXPECT_NEAR(length((*walkers)[0].heading - Vec3d{-3, 0, 0}), 0, 1e-12);
  EXPECT_DOUBLE_EQ((*walkers)[0].walked, 3);
  EXPECT_EQ((*walkers)[1].heading, (Vec3d{1, 0, 0}));
  EXPECT_DOUBLE_EQ((*walkers)[1].walked, 1);
  EXPECT_EQ(refusal(head + "0,1,adult,1,2,3,0.2\n"),
            ":2: 7 fields; write 10: step,id,class,x,y,z,radius,up_x,up_y,up_z");
  EXPECT_EQ(refusal(head + "0,1,adult,1,2,3,0.2,0,0,0\n"), ":2: up is 0,0,0; write a direction");
  EXPECT_EQ(refusal(head + "0,1,adult,1,2,3,0.2,0,up,0\n"),
            ":2: up_y is 'up'; write a number in metres");
}

TEST_F(AvatarsCsv, AHeadAloneIsAnEmptyWorld) {
  const auto avatars = read(kHead);
  ASSERT_TRUE(avatars);
  EXPECT_TRUE(avatars->empty());
}

TEST_F(AvatarsCsv, WhatIsWrongIsNamedWithItsLine) {
  EXPECT_EQ(refusal(""), ":1: the file is empty; write step,id,class,x,y,z,radius");
  EXPECT_EQ(refusal("id,x\n"), ":1: the columns are 'id,x'; write step,id,class,x,y,z,radius");
  EXPECT_EQ(refusal(kHead + "0,1,adult,1,2,3\n"),
            ":2: 6 fields; write 7: step,id,class,x,y,z,radius");
  EXPECT_EQ(refusal(kHead + "0,1,adult,1,2,3,0.2\n-1,1,adult,1,2,3,0.2\n"),
            ":3: step is '-1'; write a whole number");
  EXPECT_EQ(refusal(kHead + "0,1,adult,1,2,3m,0.2\n"), ":2: z is '3m'; write a number in metres");
  EXPECT_EQ(refusal(kHead + "0,1,adult,1,nan,3,0.2\n"), ":2: y is 'nan'; write a number in metres");
  EXPECT_EQ(refusal(kHead + "0,1,adult,1,2,3,0\n"), ":2: radius is 0; write more than 0");
  EXPECT_EQ(read_avatars("/nowhere/a.csv").error().message,
            "/nowhere/a.csv: cannot be read: No such file or directory; write one with `throng run "
            "--trajectories`");
  EXPECT_EQ(read_avatars("/").error().message,
            "/: is a folder, not a file; write one with `throng run --trajectories`");
}

}  // namespace
}  // namespace throng::app
