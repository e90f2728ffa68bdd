// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "import/formats/patch_json.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "core/files/read_file.h"
#include "patch_bytes.h"
#include "patch_nets.h"
#include "scratch_folder.h"

namespace throng {
namespace {

constexpr test::PatchReader kReader{importer::read_patch_json, "hills.patches.json"};

PatchSet sample() {
  PatchSet set = test::make_net({.side = 3, .jitter = 0.01, .seed = 3});
  const auto half = static_cast<uint32_t>(set.size() / 2);
  PatchRun& north = set.runs[0];
  north.node = "north";
  north.material = "grass";
  PatchRun south = north;
  south.node = "south \"x\"";
  south.material = "rock";
  south.kind = 7;
  south.first_patch = north.patch_count = half;
  south.patch_count = static_cast<uint32_t>(set.size()) - half;
  set.runs.push_back(south);
  return set;
}

void expect_equal(const PatchSet& a, const PatchSet& b) {
  ASSERT_EQ(a.size(), b.size());
  ASSERT_EQ(a.runs.size(), b.runs.size());
  for (size_t p = 0; p < a.size(); ++p) {
    EXPECT_EQ(a.patches[p].points, b.patches[p].points);  // Every bit of every number.
    for (size_t e = 0; e < 4; ++e) {
      EXPECT_EQ(a.edges[p][e].bind, b.edges[p][e].bind);
      EXPECT_EQ(a.edges[p][e].next, b.edges[p][e].next);
    }
  }
  for (size_t r = 0; r < a.runs.size(); ++r) {
    EXPECT_EQ(a.runs[r].node, b.runs[r].node);
    EXPECT_EQ(a.runs[r].material, b.runs[r].material);
    EXPECT_EQ(a.runs[r].kind, b.runs[r].kind);
    EXPECT_EQ(a.runs[r].first_patch, b.runs[r].first_patch);
    EXPECT_EQ(a.runs[r].patch_count, b.runs[r].patch_count);
  }
}

TEST(PatchJson, WhatIsWrittenIsReadBackBitForBit) {
  const test::ScratchFolder folder;
  const PatchSet set = sample();
  const std::string path = folder.path() + "/hills.patches.json";
  const auto written = write_patches(set, path);
  ASSERT_TRUE(written) << written.error().message;
  const auto bytes = read_file(path);
  ASSERT_TRUE(bytes);
  const auto raw = kReader.read(*bytes);
  ASSERT_TRUE(raw) << raw.error().message;
  expect_equal(set, raw->scene.patches);

  Context context;
  SceneConfig config;
  config.sources.push_back({.path = path, .up = {}, .scale = {}, .transform = {}});
  config.rules.push_back({.material = "grass", .node = "", .kind = kAreaIgnored});
  const auto scene = load_scene(config, context);
  ASSERT_TRUE(scene) << scene.error().message;
  ASSERT_EQ(scene->parts.size(), 1u);
  EXPECT_GT(scene->report.ignored, 0u);
  ASSERT_EQ(scene->patch_of_triangle.size(), scene->triangles.size());
  for (size_t t = 0; t < scene->triangles.size(); ++t) {
    EXPECT_EQ(scene->area[t], 7);
    EXPECT_GE(scene->patch_of_triangle[t], set.size() / 2);
  }
}

TEST(PatchJson, WritingRefusesWhatReadingWould) {
  const test::ScratchFolder folder;
  const auto empty = write_patches({}, folder.path() + "/a.patches.json");
  ASSERT_FALSE(empty);
  EXPECT_EQ(empty.error().code, Errc::kBadInput);
  const auto nowhere = write_patches(sample(), folder.path() + "/no/such/a.patches.json");
  ASSERT_FALSE(nowhere);
  EXPECT_EQ(nowhere.error().code, Errc::kIo);
}

std::string point_list() {
  std::string list;
  for (int i = 0; i < 16; ++i) list += fmt::format("{}[{},0,{}]", i > 0 ? "," : "", i % 4, i / 4);
  return fmt::format("[{}]", list);
}

std::string file_with(const std::string& patch) {
  return R"({"format":"throng-patches","version":1,"groups":[{"patches":[{"points":)" +
         point_list() + "},{" + patch + "}]}]}";
}

TEST(PatchJson, DamageIsNamedByItsPlace) {
  EXPECT_TRUE(kReader.read(file_with("\"points\":" + point_list())));
  const std::string at = "hills.patches.json: ";
  EXPECT_EQ(kReader.fault_of("[1]"), at + "must be an object");
  EXPECT_EQ(kReader.fault_of("{").substr(0, 30), at + "not JSON: ");
  EXPECT_EQ(kReader.fault_of(R"({"format":"other"})"),
            at + "not a patch file: \"format\" must be \"throng-patches\"");
  EXPECT_EQ(kReader.fault_of(R"({"format":"throng-patches","version":2,"groups":[]})"),
            at + "patch file of version 2; only 1 is read");
  EXPECT_EQ(kReader.fault_of(R"({"format":"throng-patches","version":1,"groups":[]})"),
            at + "has no patches");
  EXPECT_EQ(kReader.fault_of(R"({"format":"throng-patches","version":1,"groups":[],"unit":"m"})"),
            at + "does not know the key \"unit\"; remove it");
  EXPECT_EQ(kReader.fault_of(R"({"format":"throng-patches","version":1,"groups":[{"kind":64}]})"),
            at + "group 0: \"kind\" must be a whole number, 0 to 63");
  const std::string second = at + "group 0, patch 1: ";
  EXPECT_EQ(kReader.fault_of(file_with("\"points\":[]")),
            second + "\"points\" must be a list of 16 points");
  std::string points = point_list();
  EXPECT_EQ(kReader.fault_of(file_with("\"points\":" + points.replace(1, 7, "[0,0,1e9]"))),
            second + "point 0 must be three numbers below 1e9");
  const auto edges = [&](const std::string& list) {
    return kReader.fault_of(file_with("\"points\":" + point_list() + ",\"edges\":" + list));
  };
  EXPECT_EQ(edges("[null]"), second + "\"edges\" must be a list of 4");
  EXPECT_EQ(edges("[null,null,null,7]"),
            second + "edge 3 must be null, {\"next\": ...} or {\"part_of\": ...}");
  EXPECT_EQ(edges(R"([null,{"next":[[0,1],[0,2],[0,3]]},null,null])"),
            second + "edge 1: \"next\" must list 1, 2 or 4 neighbours");
  EXPECT_EQ(edges(R"([null,{"next":[[0,4]]},null,null])"),
            second +
                "edge 1: a neighbour must be [patch, edge], the patch counted through the whole "
                "file, the edge 0 to 3");
  EXPECT_EQ(edges(R"([null,{"next":[[-1,1]]},null,null])").substr(0, second.size()), second);
  EXPECT_EQ(
      edges(R"([null,{"next":[[0,1]]},null,null])"),
      at + "patch 1, edge 1: " + at + "patch 0, edge 1, does not name it in return; bind both");
  EXPECT_EQ(edges(R"([null,{"next":[[99,1]]},null,null])"),
            at +
                "patch 1, edge 1: its neighbour is patch 99 edge 1, which does not exist; name one "
                "of 2 patches and edge 0 to 3");
}

TEST(PatchJson, SurvivesDamage) {
  const test::ScratchFolder folder;
  const std::string path = folder.path() + "/a.patches.json";
  ASSERT_TRUE(write_patches(test::make_net({.side = 2, .seed = 3}), path));
  const auto whole = read_file(path);
  ASSERT_TRUE(whole);
  EXPECT_GT(kReader.survive(*whole, "hills.patches.json: ", 11, 6, 3000), 300u);
}

}  // namespace
}  // namespace throng
