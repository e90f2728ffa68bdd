// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <string>

#include "scratch_folder.h"
#include "throng/avatar.h"

namespace throng {
namespace {

// Writes `text` to a file of that name in a fresh folder, removed with the object.
struct ClassFile {
  ClassFile(const std::string& name, const std::string& text) : path(folder.write(name, text)) {}
  test::ScratchFolder folder;
  std::string path;
};

std::string refusal(const std::string& name, const std::string& text) {
  const ClassFile file(name, text);
  const auto classes = load_classes(file.path);
  if (classes) return "accepted";
  EXPECT_EQ(classes.error().code, Errc::kBadFile);
  const std::string& message = classes.error().message;
  return message.rfind(file.path, 0) == 0 ? message.substr(file.path.size()) : message;
}

TEST(AvatarClass, DefaultsPassTheirOwnCheck) {
  const auto classes = default_classes();
  ASSERT_EQ(classes.size(), 4u);
  EXPECT_TRUE(check_classes(classes));
  EXPECT_NEAR(std::tan(classes[2].max_slope * 3.14159265358979 / 180), 0.11, 1e-12);
}

TEST(AvatarClass, BodyBottomIsTheStepOrTheRiseUnderTheRadius) {
  EXPECT_DOUBLE_EQ(body_bottom(AvatarClass{}), 0.4);
  EXPECT_DOUBLE_EQ(body_bottom(AvatarClass{.radius = 0.5, .step_height = 0.4, .max_slope = 45}),
                   0.5);
  EXPECT_DOUBLE_EQ(body_bottom(default_classes()[2]), 0.033);  // 0.3 m * 11 %
}

TEST(AvatarClass, WhatClimbsOrDropsGoesOverNodes) {
  for (const AvatarClass& avatar : default_classes()) EXPECT_FALSE(goes_over_nodes(avatar));
  EXPECT_FALSE(goes_over_nodes(flyer_class()));
  EXPECT_TRUE(goes_over_nodes({.climb_slope = 0.5}));
  EXPECT_TRUE(goes_over_nodes({.max_drop = 0.5}));
  EXPECT_TRUE(goes_over_nodes({.climb_slope = 180, .max_drop = 3, .flies = true}));
  // Steep ground and high steps that it walks over are no climbs.
  EXPECT_FALSE(goes_over_nodes({.step_height = 0.8, .max_slope = 89}));
}

TEST(AvatarClass, TomlAndJsonGiveTheSameClasses) {
  const ClassFile toml("c.toml",
                       "[[class]]\nname = \"nurse\"\nheight = 1.7\n\n"
                       "[[class]]\nname = 'bed'\nradius = 0.6\nstep = 0\nmax_slope = 5\n");
  const ClassFile json("c.json",
                       R"({"class": [{"name": "nurse", "height": 1.7},
                           {"name": "bed", "radius": 0.6, "step": 0, "max_slope": 5}]})");
  const auto a = load_classes(toml.path);
  const auto b = load_classes(json.path);
  ASSERT_TRUE(a) << a.error().message;
  ASSERT_TRUE(b) << b.error().message;
  ASSERT_EQ(a->size(), 2u);
  ASSERT_EQ(b->size(), 2u);
  for (size_t i = 0; i < 2; ++i) {
    EXPECT_EQ((*a)[i].name, (*b)[i].name);
    EXPECT_EQ((*a)[i].height, (*b)[i].height);
    EXPECT_EQ((*a)[i].radius, (*b)[i].radius);
    EXPECT_EQ((*a)[i].step_height, (*b)[i].step_height);
  }
  EXPECT_EQ((*a)[0].radius, 0.19);  // the default
  EXPECT_EQ((*a)[1].radius, 0.6);
}

TEST(AvatarClass, ATurningRadiusIsReadFromAFile) {
  const ClassFile file(
      "c.toml", "[[class]]\nname = \"cart\"\nturning_radius = 1.5\n[[class]]\nname = \"a\"\n");
  const auto classes = load_classes(file.path);
  ASSERT_TRUE(classes) << classes.error().message;
  EXPECT_EQ((*classes)[0].turning_radius, 1.5);
  EXPECT_EQ((*classes)[1].turning_radius, 0);
  EXPECT_EQ(refusal("c.toml", "[[class]]\nname = \"a\"\nturning_radius = -1\n"),
            ":3: avatar class 1: turning_radius = -1 is outside 0 to 100");
}

TEST(AvatarClass, AWrongSettingIsNamedByLineKeyAndLimit) {
  EXPECT_EQ(refusal("c.toml", "[[class]]\nname = \"a\"\n\nheight = 40\n"),
            ":4: avatar class 1: height = 40 is outside 0.1 to 30");
  EXPECT_EQ(refusal("c.json",
                    "{\"class\": [\n {\"name\": \"a\"},\n {\"name\": \"b\",\n  \"radius\": 9\n}]}"),
            ":4: avatar class 2: radius = 9 is outside 0.01 to 5");
  EXPECT_EQ(refusal("c.toml", "[[class]]\nname = \"a\"\nheigth = 1\n"),
            ":3: avatar class 1: unknown key 'heigth'; known are name, height, radius, step, "
            "max_slope, speed, climb_slope, max_drop, turning_radius, flies");
  EXPECT_EQ(refusal("c.toml", "[[class]]\nname = \"a\"\nradius = \"wide\"\n"),
            ":3: avatar class 1: radius must be a number");
  EXPECT_EQ(refusal("c.toml", "[[class]]\nname = \"a\"\nheight = 1\nstep = 0.6\n"),
            ":4: avatar class 1: step = 0.6 is more than half the height 1");
  EXPECT_EQ(refusal("c.toml", "[[class]]\nname = \"a\"\nmax_drop = 0.4\n"),
            ":3: avatar class 1: max_drop = 0.4 is no more than the step 0.4; 0 asks for no drops");
  EXPECT_EQ(refusal("c.toml", "[[class]]\nheight = 1\n"), ":1: avatar class 1: name is missing");
  EXPECT_EQ(refusal("c.toml", "speed = 1\n"),
            ":1: avatar classes: unknown key 'speed'; known are class");
  EXPECT_EQ(refusal("c.toml", "[[class]]\nname = \"a\"\n[[class]]\nname = \"a\"\n"),
            ": avatar classes 1 and 2 are both named 'a'");
  EXPECT_EQ(refusal("c.toml", "[[class]]\nname = \"a\"\nheight = nan\n"),
            ":3: avatar class 1: height = nan is outside 0.1 to 30");
}

TEST(AvatarClass, BrokenTextIsRefusedWithItsLine) {
  EXPECT_EQ(refusal("c.toml", "[[class]]\nname = \n").substr(0, 3), ":2:");
  EXPECT_EQ(refusal("c.json", "{\"class\":\n [\n {]}").substr(0, 3), ":3:");
  EXPECT_EQ(refusal("c.json", "{\"class\": 1, \"class\": 2}"), ":1: key 'class' stands here twice");
  EXPECT_NE(refusal("c.json", std::string(100000, '[')), "accepted");
  EXPECT_NE(refusal("c.toml", "class = " + std::string(100000, '[')), "accepted");
  EXPECT_NE(refusal("c.toml", ""), "accepted");
  for (const char* text :
       {"[.a]", "[[=]]", "[]", "a.", "a.=1", "[a.]", "= 1", ". = 1", "\xef\xbb\xb8{"}) {
    EXPECT_NE(refusal("c.toml", text), "accepted") << text;
  }
}

TEST(AvatarClass, AMissingFileIsNamed) {
  const auto classes = load_classes("/nowhere/classes.toml");
  ASSERT_FALSE(classes);
  EXPECT_EQ(classes.error().message, "/nowhere/classes.toml: no such file; check the path");
}

TEST(AvatarClass, SeventeenClassesAreTooMany) {
  std::vector<AvatarClass> classes(17);
  for (size_t i = 0; i < classes.size(); ++i)
    classes[i].name = std::string(1, static_cast<char>('a' + i));
  const auto checked = check_classes(classes);
  ASSERT_FALSE(checked);
  EXPECT_EQ(checked.error().message, "avatar classes: need 1 to 16, not 17");
  classes.pop_back();
  EXPECT_TRUE(check_classes(classes));
}

}  // namespace
}  // namespace throng
