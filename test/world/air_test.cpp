// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>

#include "core/access.h"
#include "core/hash.h"
#include "core/random.h"
#include "path/air/air_view.h"
#include "path/air/flight_finder.h"
#include "path/air/flight_space.h"
#include "path/overlay/mesh_finder.h"
#include "scratch_folder.h"
#include "throng/bake.h"
#include "throng/path.h"
#include "throng/scene.h"
#include "verify/cylinder.h"
#include "world/air_data.h"
#include "worlds.h"

namespace throng {
namespace {

using test::ScratchFolder;

std::vector<AvatarClass> flyers() {
  return {flyer_class(),
          {.name = "bee", .height = 0.1, .radius = 0.02, .step_height = 0.02, .flies = true},
          {.name = "whale", .height = 1.3, .radius = 0.9, .step_height = 0.2, .flies = true}};
}

// Boxes and slanted triangles at random, on no ground.
Scene litter(uint64_t seed) {
  Scene scene;
  const auto real = [&](uint64_t n, uint64_t i, double low, double high) {
    return low + (high - low) * random_unit(seed, n, i);
  };
  for (uint64_t b = 0; b < 10; ++b) {
    const Vec3d low{real(b, 0, 0, 8), real(b, 1, -2, 3), real(b, 2, 0, 8)};
    scene.add_box(low, low + Vec3d{real(b, 3, 0.05, 2), real(b, 4, 0.05, 2), real(b, 5, 0.05, 2)});
    const auto corner = [&](uint64_t i) {
      return Vec3d{real(b, i, 0, 9), real(b, i + 1, -2, 4), real(b, i + 2, 0, 9)};
    };
    scene.add_triangle(corner(6), corner(9), corner(12));
  }
  return scene;
}

World bake(const Scene& scene, double air, double zone = 160, int32_t workers = 0) {
  Context context;
  auto world = bake_world(
      scene, {.cell = 0.1, .air = air, .zone = zone, .classes = flyers(), .workers = workers},
      context);
  EXPECT_TRUE(world) << world.error().message;
  return *world;
}

// Does the triangle meet the box? By cutting it with the box's six planes.
bool cuts_box(const verify::Corners& triangle, const Box3d& box) {
  std::vector<Vec3d> polygon(triangle.begin(), triangle.end());
  for (int plane = 0; plane < 6 && !polygon.empty(); ++plane) {
    const auto inside = [&](const Vec3d& p) {
      const double v = plane / 2 == 0 ? p.x : plane / 2 == 1 ? p.y : p.z;
      const Vec3d& edge = plane % 2 == 0 ? box.min : box.max;
      const double e = plane / 2 == 0 ? edge.x : plane / 2 == 1 ? edge.y : edge.z;
      return plane % 2 == 0 ? v - e : e - v;
    };
    std::vector<Vec3d> cut;
    for (size_t i = 0; i < polygon.size(); ++i) {
      const Vec3d a = polygon[i], b = polygon[(i + 1) % polygon.size()];
      const double ia = inside(a), ib = inside(b);
      if (ia >= 0) cut.push_back(a);
      if ((ia > 0 && ib < 0) || (ia < 0 && ib > 0)) {
        const double t = ia / (ia - ib);
        cut.push_back({a.x + t * (b.x - a.x), a.y + t * (b.y - a.y), a.z + t * (b.z - a.z)});
      }
    }
    polygon = cut;
  }
  return !polygon.empty();
}

Box3d box_of(const World& world, const world::AirData& air, int32_t x, int32_t y, int32_t z,
             double grown) {
  const Vec3d origin = world.summary().origin;
  const double cell = air.shape.cell * 1e-3;
  const auto low = [&](double o, int32_t i) { return o + i * cell - grown; };
  const auto high = [&](double o, int32_t i) { return o + (i + 1) * cell + grown; };
  const double up = air.shape.origin_y * 1e-3;
  return {{low(origin.x, x), low(up, y), low(origin.z, z)},
          {high(origin.x, x), high(up, y), high(origin.z, z)}};
}

bool any_cuts(const Scene& scene, const Box3d& box) {
  for (const auto& t : scene.triangles) {
    if (cuts_box({scene.positions[t[0]], scene.positions[t[1]], scene.positions[t[2]]}, box))
      return true;
  }
  return false;
}

TEST(Air, CellsAreFreeWhereNoTriangleTouchesThemAndOnlyThere) {
  for (uint64_t seed = 0; seed < 3; ++seed) {
    const Scene scene = litter(seed);
    const World world = bake(scene, 0.4, 6.4);
    const world::AirData& air = *data_of(world)->air;
    ASSERT_GT(air.zones_x, 1);
    uint64_t free = 0, full = 0;
    for (int32_t y = air.shape.floor; y < air.shape.ceiling; ++y) {
      for (int32_t z = 0; z < air.depth; ++z) {
        for (int32_t x = 0; x < air.width; ++x) {
          if (air.is_free(x, y, z)) {
            ASSERT_FALSE(any_cuts(scene, box_of(world, air, x, y, z, -1e-9))) << x << y << z;
            ++free;
          } else {  // Spans are widened by up to 1 mm and a 10 000th of a cell.
            ASSERT_TRUE(any_cuts(scene, box_of(world, air, x, y, z, 2.1e-3))) << x << y << z;
            ++full;
          }
        }
      }
    }
    EXPECT_GT(free, 5000u);
    EXPECT_GT(full, 500u);
  }
}

// The body by its own measures, cell by cell, against both queries of the octree.
TEST(Air, ACellIsLegalIfTheBodyIsFreeWhereverInItItsFeetAre) {
  for (const double cell : {0.1, 0.2, 0.8}) {
    const World world = bake(litter(7), cell, 6.4);
    const world::AirData& air = *data_of(world)->air;
    for (const AvatarClass& avatar : flyers()) {
      const world::AirBody body = world::air_body(avatar, air.shape);
      Context context;
      const auto space = path::build_flight_space(air, body, 32, 2, context);
      ASSERT_TRUE(space) << space.error().message;
      const double size = air.shape.cell * 1e-3;
      const auto reach = static_cast<int32_t>(avatar.radius / size) + 2;
      const auto up = static_cast<int32_t>(avatar.height / size) + 2;
      const auto naive = [&](int32_t x, int32_t y, int32_t z) {
        for (int32_t dy = 0; dy <= up; ++dy) {
          for (int32_t dz = -reach; dz <= reach; ++dz) {
            for (int32_t dx = -reach; dx <= reach; ++dx) {
              // How near the body's axis can come to that cell, how far below it the feet can be.
              const double gx = std::max(std::abs(dx) - 1, 0) * size;
              const double gz = std::max(std::abs(dz) - 1, 0) * size;
              const double gy = std::max(dy - 1, 0) * size;
              const double r = avatar.radius - 1e-9, h = avatar.height - 1e-9;
              if (gx * gx + gz * gz >= r * r || gy >= h) continue;
              if (!air.is_free(x + dx, y + dy, z + dz)) return false;
            }
          }
        }
        return true;
      };
      uint64_t legal = 0, seen = 0;
      for (int32_t y = air.shape.floor - 1; y <= air.shape.ceiling; ++y) {
        for (int32_t z = -1; z <= air.depth; ++z) {
          for (int32_t x = -1; x <= air.width; ++x) {
            if (random_below(1, static_cast<uint64_t>(y + 1000),
                             static_cast<uint64_t>(z * 1000 + x), 50) != 0)
              continue;
            const bool expected = y >= air.shape.floor && y < air.shape.ceiling && naive(x, y, z);
            ASSERT_EQ(air.is_legal(body, x, y, z), expected) << x << "," << y << "," << z;
            ASSERT_EQ(space->box_at(x, y, z) != path::kNoBox, expected)
                << x << "," << y << "," << z;
            legal += expected ? 1 : 0;
            ++seen;
          }
        }
      }
      EXPECT_GT(legal, 0u) << avatar.name << " at " << cell;
      EXPECT_LT(legal, seen);
    }
  }
}

TEST(Air, NoAirBoxPromisesMoreClearanceThanThereIs) {
  const World world = bake(litter(3), 0.2, 6.4);
  const world::AirData& air = *data_of(world)->air;
  uint64_t wide = 0;
  for (const auto& slot : air.slots) {
    const int32_t x0 = slot->entry.x() * air.zone_side, z0 = slot->entry.z() * air.zone_side;
    slot->zone->tree().for_each([&](const world::AirCube& cube, uint32_t word) {
      if (world::air_kind(word) != world::AirKind::kFree || cube.side > 8) return;
      const world::AirClearance clearance = world::air_clearance(world::air_number(word));
      wide += clearance.width > 0 && clearance.height > 0 ? 1 : 0;
      for (int32_t y = cube.y; y < cube.y + cube.side + clearance.height; ++y) {
        if (y < air.shape.floor || y >= air.shape.ceiling) continue;
        for (int32_t z = cube.z - clearance.width; z < cube.z + cube.side + clearance.width; ++z) {
          for (int32_t x = cube.x - clearance.width; x < cube.x + cube.side + clearance.width;
               ++x) {
            ASSERT_TRUE(air.is_free(x0 + x, y, z0 + z))
                << "cube " << x0 + cube.x << "," << cube.y << "," << z0 + cube.z << " of "
                << cube.side << " with " << clearance.width << ", " << clearance.height << ": "
                << x0 + x << "," << y << "," << z0 + z;
          }
        }
      }
    });
  }
  EXPECT_GT(wide, 20u);
}

// All boxes are asked; goals lie in the world and far beside it.
TEST(Air, TheNearestPointOfSomeComponentsIsFoundZoneByZone) {
  uint64_t asked = 0;
  for (uint64_t seed = 0; seed < 4; ++seed) {
    const World world = bake(litter(seed), 0.2, 6.4);
    const world::AirData& air = *data_of(world)->air;
    ASSERT_GT(air.zones_x, 1);
    Context context;
    const auto space =
        path::build_flight_space(air, world::air_body(flyers().front(), air.shape), 32, 2, context);
    ASSERT_TRUE(space) << space.error().message;
    std::vector<uint32_t> all(space->component);
    std::sort(all.begin(), all.end());
    all.erase(std::unique(all.begin(), all.end()), all.end());
    path::AirView::ZoneOrder order;
    for (uint64_t n = 0; n < 300; ++n) {
      const auto real = [&](uint64_t i, double low, double high) {
        return low + (high - low) * random_unit(seed, n, i);
      };
      const path::AirPoint goal{real(0, -100, 150), real(1, -30, 40), real(2, -100, 150)};
      std::vector<uint32_t> some{all[random_below(seed, n, 3, all.size())]};
      for (const uint32_t component : all) {
        if (random_below(seed, n, 4 + component, 3) == 0) some.push_back(component);
      }
      std::sort(some.begin(), some.end());
      double least = std::numeric_limits<double>::infinity();
      path::AirPoint nearest;
      for (size_t b = 0; b < space->boxes.size(); ++b) {
        if (!std::binary_search(some.begin(), some.end(), space->component[b])) continue;
        const world::AirCube& box = space->boxes[b];
        const auto into = [&](double at, int32_t low) {
          return std::clamp(at, low + path::kAirSkin, low + box.side - path::kAirSkin);
        };
        const path::AirPoint p{into(goal.x, box.x), into(goal.y, box.y), into(goal.z, box.z)};
        if (path::air_distance(p, goal) >= least) continue;
        least = path::air_distance(p, goal);
        nearest = p;
      }
      const path::AirPoint found = path::AirView(*space).nearest_in(some, goal, order).value();
      EXPECT_EQ(found.x, nearest.x);
      EXPECT_EQ(found.y, nearest.y);
      EXPECT_EQ(found.z, nearest.z);
      ++asked;
    }
  }
  EXPECT_EQ(asked, 1200u);
}

TEST(Air, SameBytesForAnyNumberOfWorkers) {
  const Scene scene = litter(5);
  const World one = bake(scene, 0.2, 6.4, 1);
  for (const int32_t workers : {2, 3, 8}) {
    const World other = bake(scene, 0.2, 6.4, workers);
    ASSERT_EQ(data_of(other)->air->slots.size(), data_of(one)->air->slots.size());
    for (size_t i = 0; i < data_of(one)->air->slots.size(); ++i) {
      EXPECT_EQ(data_of(other)->air->slots[i]->entry.hash(),
                data_of(one)->air->slots[i]->entry.hash());
    }
  }
  // Also on another machine and with another compiler.
  uint64_t all = 0;
  for (const auto& slot : data_of(one)->air->slots) all = mix64(all ^ slot->entry.hash());
  EXPECT_EQ(all, 9259508204915397938u);
}

TEST(Air, SettingsThatDoNotFitAreRefused) {
  Context context;
  const Scene scene = litter(1);
  const auto message = [&](double air, double cell) {
    const auto world = bake_world(scene, {.cell = cell, .air = air}, context);
    EXPECT_FALSE(world);
    return world.error().message;
  };
  EXPECT_EQ(message(0.3, 0.1), "bake: the air cell must be 1, 2, 4, 8 or 16 times the cell");
  EXPECT_EQ(message(NAN, 0.1), "bake: the air cell must be 0 (none) to 80 m");
  EXPECT_EQ(message(0.0333, 0.0333).substr(0, 30), "bake: the air cell must be a w");
  // As many layers as a file may name.
  Scene tower = worlds::flat(1);
  tower.add_box({0, 90000, 0}, {1, 90001, 1});
  const auto world = bake_world(tower, {.cell = 0.02, .air = 0.02, .classes = flyers()}, context);
  ASSERT_FALSE(world);
  EXPECT_EQ(world.error().code, Errc::kLimit);
  EXPECT_NE(world.error().message.find("2 million air cells"), std::string::npos);
}

class DamagedAir : public testing::Test {
 protected:
  void SetUp() override {
    Context context;
    path_ = folder_.path() + "/world";
    const BakeConfig config{.cell = 0.1, .air = 0.4, .zone = 6.4, .classes = flyers()};
    ASSERT_TRUE(bake_world_to(path_, litter(2), config, context));
    for (const auto& file : std::filesystem::directory_iterator(path_)) {
      if (file.path().extension() == ".tha") air_file_ = file.path().string();
    }
    ASSERT_FALSE(air_file_.empty());
  }
  static std::string read(const std::string& name) {
    std::ifstream file(name, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }
  static void write(const std::string& name, const std::string& bytes) {
    std::filesystem::remove(name);
    std::ofstream(name, std::ios::binary) << bytes;
  }

  ScratchFolder folder_;
  std::string path_, air_file_;
};

TEST_F(DamagedAir, IsOpenedAgainAsItWasBaked) {
  const auto world = World::open(path_);
  ASSERT_TRUE(world) << world.error().message;
  EXPECT_TRUE(world->check_all());
  EXPECT_TRUE(world->summary().classes[0].flies);
  const World memory = bake(litter(2), 0.4, 6.4);
  const world::AirData &a = *data_of(*world)->air, &b = *data_of(memory)->air;
  for (int32_t y = a.shape.floor; y < a.shape.ceiling; ++y) {
    for (int32_t z = 0; z < a.depth; ++z) {
      for (int32_t x = 0; x < a.width; ++x) {
        ASSERT_EQ(a.is_free(x, y, z), b.is_free(x, y, z));
      }
    }
  }
}

TEST_F(DamagedAir, IsReusedByTheNextBakeAndLeftOutOfOneWithoutAir) {
  const std::string before = read(air_file_);
  Context context;
  BakeConfig config{.cell = 0.1, .air = 0.4, .zone = 6.4, .classes = flyers()};
  const auto written = std::filesystem::last_write_time(air_file_);
  ASSERT_TRUE(bake_world_to(path_, litter(2), config, context));
  EXPECT_EQ(read(air_file_), before);
  EXPECT_EQ(std::filesystem::last_write_time(air_file_), written);
  config.classes = {AvatarClass{}};
  config.air = 0;
  ASSERT_TRUE(bake_world_to(path_, litter(2), config, context));
  EXPECT_FALSE(std::filesystem::exists(air_file_));
  EXPECT_FALSE(std::filesystem::exists(path_ + "/air.thm"));
  EXPECT_EQ(air_summary(*World::open(path_)).error().code, Errc::kNotFound);
}

TEST_F(DamagedAir, OldFilesAreNotReusedWhereAllIsBakedAgain) {
  const std::string before = read(air_file_);
  const auto long_ago = std::filesystem::last_write_time(air_file_) - std::chrono::hours(1);
  std::filesystem::last_write_time(air_file_, long_ago);
  Context context;
  BakeConfig config{.cell = 0.1, .air = 0.4, .zone = 6.4, .classes = flyers()};
  ASSERT_TRUE(bake_world_to(path_, litter(2), config, context));
  EXPECT_EQ(std::filesystem::last_write_time(air_file_), long_ago);
  config.old_zones = OldZones::kBakeAgain;
  ASSERT_TRUE(bake_world_to(path_, litter(2), config, context));
  EXPECT_NE(std::filesystem::last_write_time(air_file_), long_ago);
  EXPECT_EQ(read(air_file_), before);
}

// Two zones, of which the farther one grows to the side, within the last tile of both.
TEST_F(DamagedAir, IsBakedAgainWhereTheWorldEndsElsewhere) {
  const BakeConfig config{.cell = 0.1, .air = 0.4, .zone = 6.4, .classes = flyers()};
  Scene scene;
  scene.add_box({0, 0, 0}, {3, 0.2, 12});
  Context context;
  ASSERT_TRUE(bake_world_to(path_, scene, config, context));
  scene.add_box({3, 0, 11}, {5, 0.2, 12});
  ASSERT_TRUE(bake_world_to(path_, scene, config, context));
  const std::string fresh = folder_.path() + "/fresh";
  ASSERT_TRUE(bake_world_to(fresh, scene, config, context));
  for (const char* file : {"/zone_0_0.tha", "/zone_0_1.tha"}) {
    ASSERT_FALSE(read(fresh + file).empty());
    EXPECT_EQ(read(path_ + file), read(fresh + file)) << file;
  }
}

// Classes that only walk need none of them.
TEST_F(DamagedAir, DoesNotConcernTheGround) {
  write(air_file_, read(air_file_).substr(0, 100));
  const auto world = World::open(path_);
  ASSERT_TRUE(world);
  EXPECT_TRUE(world->check_ground());
  EXPECT_FALSE(world->check_all());
  Context context;
  EXPECT_TRUE(path::MeshFinder::create(*world, {}, context));
  EXPECT_EQ(path::FlightFinder::create(*world, {}, context).error().code, Errc::kBadFile);
}

TEST_F(DamagedAir, FilesAreRefusedByName) {
  const std::string good = read(air_file_);
  for (const size_t size : {size_t{0}, size_t{5}, good.size() / 2, good.size() - 1}) {
    write(air_file_, good.substr(0, size));
    const auto world = World::open(path_);
    ASSERT_TRUE(world);
    const auto checked = world->check_all();
    ASSERT_FALSE(checked);
    EXPECT_NE(checked.error().message.find(air_file_), std::string::npos)
        << checked.error().message;
  }
  for (uint64_t i = 0; i < 20; ++i) {
    std::string bad = good;
    bad[random_below(3, i, 0, bad.size())] ^= static_cast<char>(1 << random_below(3, i, 1, 8));
    write(air_file_, bad);
    EXPECT_FALSE(World::open(path_)->check_all());
  }
  write(air_file_, good);
  const std::string manifest = path_ + "/air.thm", sound = read(manifest);
  write(manifest, sound.substr(0, sound.size() / 2));
  EXPECT_NE(World::open(path_).error().message.find(manifest), std::string::npos);
}

TEST_F(DamagedAir, OfAnotherBakeIsRefused) {
  const std::string air = read(path_ + "/air.thm");
  Context context;
  ASSERT_TRUE(bake_world_to(path_, litter(4),
                            {.cell = 0.1, .air = 0.4, .zone = 6.4, .classes = flyers()}, context));
  write(path_ + "/air.thm", air);
  EXPECT_NE(World::open(path_).error().message.find("belongs to another bake"), std::string::npos);
}

// Forged files, whose sums are right: no tree leads out of its arrays or in circles.
TEST(Air, ForgedTreesAreRefused) {
  world::AirTreeData tree{.side = 16, .base = 0, .roots = 1, .nodes = {}, .leaves = {}};
  const auto refused = [](const world::AirTreeData& t) {
    return !world::AirZone::from_bytes(world::air_zone_bytes(0, 0, 0, t), "forged.tha");
  };
  tree.nodes = {world::air_word(world::AirKind::kFree, 0)};
  EXPECT_FALSE(refused(tree));
  tree.nodes = {world::air_word(world::AirKind::kLeaf, 0)};
  EXPECT_TRUE(refused(tree));  // a leaf of 16 cells
  tree.nodes.assign(9, world::air_word(world::AirKind::kFree, 0));
  EXPECT_TRUE(refused(tree));  // a group that nothing names
  tree.nodes[0] = world::air_word(world::AirKind::kInner, 1);
  EXPECT_FALSE(refused(tree));
  tree.nodes[3] = world::air_word(world::AirKind::kInner, 1);
  EXPECT_TRUE(refused(tree));  // in a circle
  tree.nodes[3] = world::air_word(world::AirKind::kLeaf, 0);
  EXPECT_TRUE(refused(tree));  // a leaf of 8 cells
  tree.nodes[3] = 0;
  tree.nodes[0] = world::air_word(world::AirKind::kInner, 2);
  EXPECT_TRUE(refused(tree));  // beyond the end
  tree.nodes = {0};
  tree.side = 12;
  EXPECT_TRUE(refused(tree));
  tree.side = 16;
  tree.roots = 2;
  EXPECT_TRUE(refused(tree));
  // Heights must fit 32 bits.
  tree = {.side = world::AirTree::kMaxSide, .base = 0, .roots = 256, .nodes = {}, .leaves = {}};
  tree.nodes.assign(tree.roots, world::air_word(world::AirKind::kFree, 0));
  EXPECT_FALSE(refused(tree));
  tree.roots = 1 << 17;
  tree.nodes.assign(tree.roots, world::air_word(world::AirKind::kFree, 0));
  EXPECT_TRUE(refused(tree));
}

}  // namespace
}  // namespace throng
