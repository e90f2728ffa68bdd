// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "core/random.h"
#include "scratch_folder.h"
#include "throng/scenario.h"

namespace throng {
namespace {

const char* const kFull = R"(seconds = 30
dt = 0.05
seed = 7
paths = "labels"
cell = 0.2

[plane]
floor = [[0, 0], [20, 0], [20, 10], [0, 10]]
holes = [[[8, 4], [9, 4], [9, 6], [8, 6]]]
obstacles = [[[5, 0], [5.2, 0], [5.2, 4], [5, 4]]]
height = 2.5

[[class]]
name = "adult"
radius = 0.19

[[area]]
name = "in"
box = [0.5, 1, 3, 9]

[[area]]
name = "out"
polygon = [[18, 1], [19.5, 1], [19.5, 4]]
y = [-1, 1]
speed_factor = 0.5

[[area]]
name = "out"
circle = [18, 7, 1]

[[density]]
name = "crowd"
box = [0, 0, 20, 10]
pixel = 1
paint = [{ area = "in", weight = 200 }, { area = "out", weight = 10 }]

[[profile]]
name = "any"
class = "adult"
speed = { normal = [1.3, 0.2], within = [0.5, 2] }
radius = 0.2

[[queue]]
name = "till"
line = [[10, 0, 5], [10, 0, 1]]
spacing = 0.8
servers = 2
service = { exponential = 3 }

[[link]]
name = "lift"
from = "in"
to = "out"
interval = 5
capacity = 4
seconds = 8

[[journey]]
name = "round"
repeat = true
stages = [
  { go = ["in", "out"], by = "quickest" },
  { random_point = "in" },
  { density = "crowd" },
  { wait = { uniform = [1, 2] } },
  { queue = "till" },
  { link = "lift" },
]

[[journey]]
name = "away"
stages = [{ leave = "out" }]

[[source]]
name = "first"
area = "in"
profile = "any"
journey = { round = 1, away = 2.5 }
count = 10
premovement = 3
group = { uniform = [1, 3] }

[[source]]
name = "later"
density = "crowd"
rates = [[0, 0.5], [10, 0], [20, 2]]
begin = 1
end = 25
even = true

[[obstacle]]
name = "crate"
circle = [12, 8, 0.5]
begin = 5
end = 9
)";

TEST(ScenarioFile, ReadsEveryKey) {
  const auto s = parse_scenario(kFull, "folder/full.toml");
  ASSERT_TRUE(s) << s.error().message;
  EXPECT_EQ(s->seconds, 30);
  EXPECT_EQ(s->dt, 0.05);
  EXPECT_EQ(s->seed, 7U);
  EXPECT_EQ(s->paths, PathSpeedup::kLabels);
  ASSERT_EQ(s->planes.size(), 1U);
  EXPECT_EQ(s->planes[0].ground.holes.size(), 1U);
  EXPECT_EQ(s->planes[0].obstacles.size(), 1U);
  EXPECT_EQ(s->planes[0].obstacle_height, 2.5);
  ASSERT_EQ(s->classes.size(), 1U);
  EXPECT_EQ(s->classes[0].radius, 0.19);
  ASSERT_EQ(s->areas.size(), 2U);
  EXPECT_EQ(s->areas[1].prisms.size(), 2U);
  EXPECT_EQ(s->areas[1].prisms[0].low, -1);
  EXPECT_EQ(s->areas[0].speed_factor, 1);
  EXPECT_EQ(s->areas[1].speed_factor, 0.5);
  EXPECT_EQ(s->sources[0].pattern, SpawnPattern::kRandom);
  ASSERT_EQ(s->densities.size(), 1U);
  EXPECT_EQ(s->densities[0].width, 20);
  EXPECT_EQ(s->densities[0].weights[size_t{5} * 20 + 1], 200);  // in
  EXPECT_EQ(s->densities[0].weights[size_t{5} * 20 + 10], 0);
  EXPECT_EQ(s->densities[0].weights[size_t{7} * 20 + 18], 10);  // out
  EXPECT_EQ(s->profiles[0].speed.kind, Distribution::Kind::kNormal);
  EXPECT_EQ(s->profiles[0].speed.high, 2);
  EXPECT_EQ(s->queues[0].servers, 2);
  EXPECT_EQ(s->links[0].to, 1);
  ASSERT_EQ(s->journeys.size(), 2U);
  ASSERT_EQ(s->journeys[0].stages.size(), 6U);
  EXPECT_TRUE(s->journeys[0].repeat);
  EXPECT_TRUE(s->journeys[0].stages[0].quickest);
  EXPECT_EQ(s->journeys[0].stages[2].density, 0);
  EXPECT_EQ(s->journeys[0].stages[5].kind, Stage::Kind::kLink);
  ASSERT_EQ(s->sources.size(), 2U);
  ASSERT_EQ(s->sources[0].journeys.size(), 2U);
  for (const Choice& choice : s->sources[0].journeys) {
    EXPECT_EQ(choice.weight,
              s->journeys[static_cast<size_t>(choice.index)].name == "away" ? 2.5 : 1);
  }
  EXPECT_EQ(s->sources[1].rates.size(), 3U);
  EXPECT_EQ(s->sources[1].pattern, SpawnPattern::kEven);
  ASSERT_EQ(s->obstacles.size(), 1U);
  EXPECT_EQ(s->obstacles[0].end, 9);
  EXPECT_EQ(s->obstacles[0].policy, ObstaclePolicy::kRefuseEntry);
}

// The file with `from` replaced.
std::string changed(const std::string& from, const std::string& to) {
  std::string text = kFull;
  const size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

TEST(ScenarioFile, StatesWhetherSlopesSlow) {
  const std::string labels = "paths = \"labels\"";
  EXPECT_TRUE(parse_scenario(kFull, "full.toml")->slow_on_slopes);
  const auto off =
      parse_scenario(changed(labels, labels + "\nslow_on_slopes = false"), "full.toml");
  ASSERT_TRUE(off) << off.error().message;
  EXPECT_FALSE(off->slow_on_slopes);
  EXPECT_FALSE(parse_scenario(changed(labels, labels + "\nslow_on_slopes = 0"), "full.toml"));
}

TEST(ScenarioFile, StatesWhetherAvatarsAvoidJams) {
  const std::string labels = "paths = \"labels\"";
  EXPECT_TRUE(parse_scenario(kFull, "full.toml")->avoid_jams);
  EXPECT_FALSE(parse_scenario(kFull, "full.toml")->pushing);
  EXPECT_EQ(parse_scenario(kFull, "full.toml")->acceleration, CrowdTuning{}.acceleration);
  const auto push =
      parse_scenario(changed(labels, labels + "\npushing = true\nacceleration = 2.5"), "full.toml");
  ASSERT_TRUE(push) << push.error().message;
  EXPECT_TRUE(push->pushing);
  EXPECT_EQ(push->acceleration, 2.5);
  EXPECT_FALSE(parse_scenario(changed(labels, labels + "\nacceleration = -1"), "full.toml"));
  const auto off = parse_scenario(changed(labels, labels + "\navoid_jams = false"), "full.toml");
  ASSERT_TRUE(off) << off.error().message;
  EXPECT_FALSE(off->avoid_jams);
  EXPECT_FALSE(parse_scenario(changed(labels, labels + "\navoid_jams = 0"), "full.toml"));
}

TEST(ScenarioFile, NamesTheSteeringModel) {
  const std::string labels = "paths = \"labels\"";
  const auto ours = parse_scenario(kFull, "full.toml");
  const auto other =
      parse_scenario(changed(labels, labels + "\nsteering = \"caacd\""), "full.toml");
  ASSERT_TRUE(ours && other);
  EXPECT_EQ(ours->steering, SteeringModel::kSampled);
  EXPECT_EQ(other->steering, SteeringModel::kCurvilinear);
}

TEST(ScenarioFile, SaysWhereAndWhatIsWrong) {
  const struct {
    const char *from, *to, *says;
  } cases[] = {
      {"seconds = 30", "seconds = \"long\"", "full.toml:1: scenario: seconds must be a number"},
      {"dt = 0.05", "dt = 2", "full.toml:2: scenario: dt = 2 is outside"},
      {"paths = \"labels\"", "paths = \"magic\"", "full.toml:4: scenario: paths must be"},
      {"paths = \"labels\"", "ways = \"magic\"", "full.toml:4: scenario: ways must be"},
      {"paths = \"labels\"", "paths = \"labels\"\nways = \"labels\"",
       "full.toml:5: scenario: ways is the old name of paths; drop it"},
      {"paths = \"labels\"", "paths = \"labels\"\nsteering = \"orca\"",
       "full.toml:5: scenario: steering must be sampled, caacd or social-force"},
      {"seed = 7", "sead = 7", "full.toml:3: scenario: unknown key 'sead'"},
      {"[plane]\n", "world = \"x\"\n[plane]\n", "give one of: world"},
      {"box = [0.5, 1, 3, 9]", "box = [0.5, 1, 3]", "box must be a list of 4 numbers"},
      {"box = [0.5, 1, 3, 9]", "box = [3, 1, 3, 9]", "area 'in'"},
      {"polygon = [[18, 1], [19.5, 1], [19.5, 4]]", "polygon = [[18, 1]]", "area 'out'"},
      {"circle = [18, 7, 1]", "circle = [18, 7, 0]", "radius above 0"},
      {"{ area = \"in\", weight = 200 }", "{ area = \"inn\", weight = 200 }",
       "there is no area named 'inn'; there are: in, out"},
      {"weight = 200 }, { area = \"out\", weight = 10 }", "weight = 0 }", "weights are all 0"},
      {"speed = { normal = [1.3, 0.2], within = [0.5, 2] }", "speed = { normal = 3 }",
       "profile 'any': speed: give two numbers"},
      {"speed = { normal = [1.3, 0.2], within = [0.5, 2] }", "speed = { gamma = 3 }",
       "speed must be a number, { uniform"},
      {"speed = { normal = [1.3, 0.2], within = [0.5, 2] }", "speed = 1000",
       "speed must be within"},
      {"speed = { normal = [1.3, 0.2], within = [0.5, 2] }",
       "speed = { normal = [1.34, 0.26], within = [50, 60] }", "under 5 % of what is drawn"},
      {"speed = { normal = [1.3, 0.2], within = [0.5, 2] }",
       "speed = { exponential = 1, within = [50, 60] }", "under 5 % of what is drawn"},
      {"line = [[10, 0, 5], [10, 0, 1]]", "line = [[10, 0, 5]]", "at least two"},
      {"from = \"in\"\n", "", "link 'lift': from is missing"},
      {"{ random_point = \"in\" }", "{ random_point = \"in\", wait = 3 }",
       "journey 'round': stage 2: a stage is one"},
      {"{ random_point = \"in\" }", "{ leave = \"in\" }", "nothing can follow"},
      {"{ queue = \"till\" }", "{ queue = \"tall\" }", "there is no queue named 'tall'"},
      {"journey = { round = 1, away = 2.5 }", "journey = { round = -1 }",
       "must be a number above 0"},
      {"speed_factor = 0.5", "speed_factor = 0", "area 'out': speed_factor = 0 is outside"},
      {"count = 10", "count = 10\nplaces = \"heap\"", "places must be \"chance\" or \"rows\""},
      {"even = true", "even = true\nplaces = \"rows\"", "rows need one area, a count"},
      {"count = 10", "count = 1.5", "count must be a whole number"},
      {"rates = [[0, 0.5], [10, 0], [20, 2]]", "rates = [[0, 0.5], [0, 1]]", "times ascending"},
      {"density = \"crowd\"\nrates", "density = \"crowd\"\narea = \"in\"\nrates",
       "say where avatars enter"},
      {"rates = [[0, 0.5], [10, 0], [20, 2]]", "", "give a count, a rate"},
      {"begin = 5\nend = 9", "begin = 9\nend = 5", "obstacle 'crate': it must begin before"},
      {"begin = 5\nend = 9", "begin = 5\npolicy = \"open\"", "policy: write \"shut\" or \"wait\""},
      {"name = \"later\"", "name = \"first\"", "the name is used twice"},
  };
  for (const auto& c : cases) {
    const auto s = parse_scenario(changed(c.from, c.to), "full.toml");
    ASSERT_FALSE(s) << c.to;
    EXPECT_EQ(s.error().code, Errc::kBadFile);
    EXPECT_NE(s.error().message.find(c.says), std::string::npos) << s.error().message;
    EXPECT_EQ(s.error().message.rfind("full.toml:", 0), 0U) << s.error().message;
  }
}

TEST(ScenarioFile, KeepsTheOldNamesOfKeys) {
  std::string text = kFull;
  for (const auto& [now, old] :
       {std::pair("\npaths =", "\nways ="), std::pair("\nspeed_factor =", "\npace ="),
        std::pair("{ random_point =", "{ spot =")}) {
    text.replace(text.find(now), std::string(now).size(), old);
  }
  const auto s = parse_scenario(text, "full.toml");
  ASSERT_TRUE(s) << s.error().message;
  EXPECT_EQ(s->paths, PathSpeedup::kLabels);
  EXPECT_EQ(s->areas[1].speed_factor, 0.5);
  EXPECT_EQ(s->journeys[0].stages[1].kind, Stage::Kind::kRandomPoint);
  EXPECT_EQ(s->journeys[0].stages[1].areas, std::vector<int32_t>{0});
}

TEST(ScenarioFile, NamesAnImageFileThatDoesNotExist) {
  const auto s = parse_scenario(
      changed(
          "pixel = 1\npaint = [{ area = \"in\", weight = 200 }, { area = \"out\", weight = 10 }]",
          "image = \"none.png\""),
      "somewhere/full.toml");
  ASSERT_FALSE(s);
  EXPECT_NE(s.error().message.find("somewhere/none.png"), std::string::npos) << s.error().message;
}

// Random edits of a valid file parse or give an error, and never crash.
TEST(ScenarioFile, SurvivesDamagedFiles) {
  const std::string text = kFull;
  int refused = 0;
  constexpr int kFiles = 3000;
  for (uint64_t n = 0; n < kFiles; ++n) {
    std::string bad = text;
    const uint64_t edits = 1 + random_below(1, 0, n, 4);
    for (uint64_t e = 0; e < edits; ++e) {
      const size_t at = random_below(2, e, n, bad.size());
      switch (random_below(3, e, n, 3)) {
        case 0:
          bad[at] = static_cast<char>(random_below(4, e, n, 256));
          break;
        case 1:
          bad.erase(at, 1 + random_below(5, e, n, 30));
          break;
        default:
          bad.insert(at, text.substr(random_below(6, e, n, text.size()), 20));
      }
    }
    const auto s = parse_scenario(bad, "damaged.toml");
    refused += s ? 0 : 1;
    if (!s) {
      EXPECT_FALSE(s.error().message.empty());
    }
  }
  EXPECT_GT(refused, kFiles / 2);
}

TEST(ScenarioFile, IsReadFromDiskAndNamedWhereItCannotBe) {
  const test::ScratchFolder folder;
  const std::string path = folder.write("full.toml", kFull);
  const auto read = load_scenario(path), parsed = parse_scenario(kFull, path);
  ASSERT_TRUE(read) << read.error().message;
  ASSERT_TRUE(parsed);
  EXPECT_EQ(read->areas.size(), parsed->areas.size());
  EXPECT_EQ(read->seed, 7u);

  const std::string bad = folder.write("bad.toml", "seconds = \"soon\"\n");
  const auto refused = load_scenario(bad);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().message.rfind(bad, 0), 0u) << refused.error().message;
  const auto missing = load_scenario(folder.path() + "/nowhere.toml");
  ASSERT_FALSE(missing);
  EXPECT_EQ(missing.error().code, Errc::kBadFile);
}

}  // namespace
}  // namespace throng
