// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "density_picture.h"
#include "scratch_folder.h"
#include "throng/picture.h"
#include "throng/scenario.h"

// Avatars of a scenario that follow a density map, from picture files. What has weight 0, the test
// reads from its own pixels.
namespace throng {
namespace {

using test::DensityPicture;

void write_picture(const std::string& path, const DensityPicture& picture) {
  Image image{.width = picture.width, .height = picture.height, .rgb = {}};
  for (const uint8_t grey : picture.weights) image.rgb.insert(image.rgb.end(), 3, grey);
  ASSERT_TRUE(write_png(image, path));
}

// Streets of 4 m around blocks of 6 m, all of the world being ground.
DensityPicture streets() {
  return {120, 80, 0.5, [](double x, double z) {
            const bool in_block = std::fmod(x, 10) > 4 && std::fmod(z, 10) > 4;
            return in_block ? 0 : std::fmod(z, 10) < 4 ? 200 : 60;
          }};
}

std::string city(const std::string& density, const std::string& more) {
  return R"(seconds = 1000
seed = 5
[plane]
floor = [[0, 0], [60, 0], [60, 40], [0, 40]]
[[area]]
name = "corner"
box = [0, 0, 8, 8]
[[profile]]
name = "adult"
[[profile]]
name = "child"
class = "child"
[[density]]
name = "map"
box = [0, 0, 60, 40]
)" + density +
         more;
}

const std::string kWalkers = R"(
[[journey]]
name = "stroll"
repeat = true
stages = [{ density = "map" }, { wait = 1 }]
[[source]]
name = "all"
density = "map"
profile = { adult = 2, child = 1 }
journey = "stroll"
count = 700
[[source]]
name = "from a corner"
area = "corner"
journey = "stroll"
rate = 2
group = 2
)";

struct City {
  Scenario scenario;
  World world;
  Simulation simulation;
};

City opened(const std::string& text, const std::string& folder, int32_t workers = 2) {
  const auto scenario = parse_scenario(text, folder + "/city.toml");
  EXPECT_TRUE(scenario) << scenario.error().message;
  Context context;
  const auto world = open_world(*scenario, context);
  EXPECT_TRUE(world) << world.error().message;
  auto simulation = Simulation::create(*world, *scenario, workers, context);
  EXPECT_TRUE(simulation) << simulation.error().message;
  return {*scenario, *world, *std::move(simulation)};
}

struct Frames {
  uint64_t all = 0, on_zero = 0, entered_zero = 0, unsound = 0;
  double weights = 0;  // sum
};

// Counts avatar-frames, and those of avatars that came from other ground onto weight 0.
void watch(City& city, const DensityPicture& picture, int steps, Frames& frames,
           std::map<uint32_t, bool>& was_on_zero) {
  std::vector<AvatarState> states;
  for (int step = 0; step < steps; ++step) {
    ASSERT_TRUE(city.simulation.step());
    city.simulation.read(states);
    for (const AvatarState& s : states) {
      const int weight = picture.weight(s.position.x, s.position.z);
      const auto known = was_on_zero.find(s.id);
      frames.all += 1;
      frames.weights += weight;
      frames.on_zero += weight == 0 ? 1 : 0;
      const bool was = known != was_on_zero.end() && known->second;
      frames.entered_zero += weight == 0 && !was ? 1 : 0;
      was_on_zero[s.id] = weight == 0 || (was && picture.is_beside_zero(s.position));
    }
    if (step % 50 != 0) continue;
    const CrowdCheck found = city.simulation.crowd().check();
    frames.unsound += found.overlaps + found.wall_entries;
  }
}

TEST(DensityFollowing, NoAvatarFrameLiesInWeight0) {
  const test::ScratchFolder folder;
  write_picture(folder.path() + "/streets.png", streets());
  for (const bool pushing : {false, true}) {
    City city = opened(
        (pushing ? "pushing = true\n" : "") + ::throng::city("image = \"streets.png\"\n", kWalkers),
        folder.path());
    Frames frames;
    std::map<uint32_t, bool> was_on_zero;
    watch(city, streets(), 600, frames, was_on_zero);
    EXPECT_GT(frames.all, 350'000U);
    EXPECT_EQ(frames.on_zero, 0U);
    EXPECT_EQ(frames.unsound, 0U);
    EXPECT_EQ(city.simulation.step()->goal_unreachable, 0U);
  }
}

TEST(DensityFollowing, GroundThatBecomes0ByTheHourIsLeftAndNotEntered) {
  const test::ScratchFolder folder;
  const DensityPicture day = streets();
  // At night the west is 0, but for a street along the middle.
  const DensityPicture night(120, 80, 0.5, [&](double x, double z) {
    return x < 25 && std::fabs(z - 22) > 2 ? 0 : day.weight(x, z);
  });
  write_picture(folder.path() + "/day.png", day);
  write_picture(folder.path() + "/night.png", night);
  City city =
      opened(::throng::city("images = [{ at = 20, image = \"day.png\" }, { at = 40, image = "
                            "\"night.png\" }]\n",
                            kWalkers),
             folder.path());
  Frames frames;
  std::map<uint32_t, bool> was_on_zero;
  watch(city, day, 390, frames, was_on_zero);
  EXPECT_EQ(frames.on_zero, 0U);
  // The weights of the west become 0 in the last half second before 40.
  was_on_zero.clear();
  std::vector<AvatarState> states;
  city.simulation.read(states);
  for (const AvatarState& s : states) {
    was_on_zero[s.id] = night.weight(s.position.x, s.position.z) == 0;
  }
  for (int step = 0; step < 20; ++step) {
    ASSERT_TRUE(city.simulation.step());
    city.simulation.read(states);
  }
  for (const AvatarState& s : states) {
    was_on_zero[s.id] = night.weight(s.position.x, s.position.z) == 0;
  }
  frames = {};
  watch(city, night, 900, frames, was_on_zero);
  EXPECT_GT(frames.on_zero, 1000U) << "those that leave";
  EXPECT_EQ(frames.entered_zero, 0U);
  EXPECT_EQ(frames.unsound, 0U);
  Frames last;
  watch(city, night, 1, last, was_on_zero);
  EXPECT_EQ(last.on_zero, 0U) << "all are out";
}

TEST(DensityFollowing, TripsPreferAndSampleWhereManyWalk) {
  // A busy street and a quiet one, with all goals at the two ends of the quiet one.
  const DensityPicture two(120, 80, 0.5, [](double x, double z) {
    const bool at_end = (x < 4 || x > 56) && z < 14;
    return at_end ? 255 : z > 10 && z < 14 ? 255 : z > 0 && z < 4 ? 12 : 0;
  });
  const test::ScratchFolder folder;
  write_picture(folder.path() + "/two.png", two);
  City city = opened(::throng::city("image = \"two.png\"\n", R"(
[[area]]
name = "west"
box = [0.5, 0.5, 3.5, 3.5]
[[area]]
name = "east"
box = [56.5, 0.5, 59.5, 3.5]
[[journey]]
name = "there and back"
repeat = true
stages = [{ random_point = "west" }, { random_point = "east" }, { density = "map" }]
[[source]]
name = "all"
density = "map"
journey = "there and back"
count = 40
)"),
                     folder.path());
  std::vector<AvatarState> states;
  size_t busy = 0, quiet = 0;
  for (int step = 0; step < 2000; ++step) {
    ASSERT_TRUE(city.simulation.step());
    city.simulation.read(states);
    for (const AvatarState& s : states) {
      if (s.position.x < 10 || s.position.x > 50) continue;
      (s.position.z > 8 ? busy : quiet) += 1;
      ASSERT_NE(two.weight(s.position.x, s.position.z), 0);
    }
  }
  EXPECT_GT(busy, 4 * quiet);
  EXPECT_GT(busy, 20'000U);
}

TEST(DensityFollowing, SameStepsForAnyNumberOfWorkers) {
  const test::ScratchFolder folder;
  write_picture(folder.path() + "/day.png", streets());
  write_picture(folder.path() + "/night.png", DensityPicture(120, 80, 0.5, [](double x, double z) {
                  return x < 20 ? 0 : streets().weight(x, z);
                }));
  uint64_t hash = 0;
  for (const int32_t workers : {1, 2, 4}) {
    City city =
        opened(::throng::city("images = [{ at = 3, image = \"day.png\" }, { at = 6, image = "
                              "\"night.png\" }]\n",
                              kWalkers),
               folder.path(), workers);
    for (int step = 0; step < 120; ++step) ASSERT_TRUE(city.simulation.step());
    if (hash == 0) hash = city.simulation.state_hash();
    EXPECT_EQ(city.simulation.state_hash(), hash) << workers;
  }
}

TEST(DensityFollowing, AnAreaOfWeight0IsRefusedByName) {
  const test::ScratchFolder folder;
  DensityPicture picture = streets();
  write_picture(folder.path() + "/streets.png", picture);
  const auto scenario = parse_scenario(::throng::city("image = \"streets.png\"\n", R"(
[[area]]
name = "block"
box = [5, 5, 9, 9]
[[journey]]
name = "in"
stages = [{ density = "map" }, { go = "block" }]
[[source]]
name = "all"
density = "map"
journey = "in"
count = 3
)"),
                                       folder.path() + "/city.toml");
  ASSERT_TRUE(scenario) << scenario.error().message;
  Context context;
  const auto world = open_world(*scenario, context);
  const auto simulation = Simulation::create(*world, *scenario, 1, context);
  ASSERT_FALSE(simulation);
  EXPECT_NE(simulation.error().message.find("'block'"), std::string::npos);
  EXPECT_NE(simulation.error().message.find("not 0"), std::string::npos)
      << simulation.error().message;
}

}  // namespace
}  // namespace throng
