// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <tuple>

#include "baked.h"
#include "core/access.h"
#include "core/random.h"
#include "folder_bytes.h"
#include "graph/node_data.h"
#include "path/air/flight_finder.h"
#include "scratch_folder.h"
#include "throng/bake.h"
#include "throng/path.h"
#include "throng/surface.h"
#include "throng/verify.h"
#include "world/air_data.h"
#include "world/zone_data.h"
#include "worlds.h"

// Links between the air and the nodes under it, against an election by brute force.
namespace throng {
namespace {

namespace fs = std::filesystem;

// Two that fly, one that walks.
std::vector<AvatarClass> flyers() {
  return {{.name = "adult"},
          {.name = "bird", .height = 0.5, .radius = 0.2, .step_height = 0.2, .flies = true},
          {.name = "whale",
           .height = 1.9,
           .radius = 0.9,
           .step_height = 0.3,
           .max_slope = 30,
           .flies = true}};
}

struct Case {
  std::string name;
  Scene scene;
  BakeConfig config;
  double size = 1;  // NodeConfig::size
};

// Its patches reach over the borders of zones.
Case landscape() {
  return {"landscape",
          test::builtin({.name = "landscape", .size = 96, .seed = 3}),
          {.cell = 0.4, .air = 0.4, .zone = 25.6, .classes = flyers()},
          2};
}

// A hall with a table, under a roof, in several zones.
Case table() {
  Scene scene = worlds::flat(40);
  scene.add_box({1, 1.2, 1}, {9, 1.4, 9});
  scene.add_box({20, 3, 20}, {39, 3.3, 39});
  return {"table", scene, {.cell = 0.2, .air = 0.4, .zone = 12.8, .classes = flyers()}, 1};
}

Case garage() {
  return {"garage",
          test::builtin({.name = "garage", .levels = 2}),
          {.cell = 0.25, .air = 0.5, .zone = 16, .classes = flyers()},
          1};
}

class AirLinksTest : public testing::Test {
 protected:
  [[nodiscard]] std::string at(const std::string& name) const {
    return folder_.path() + "/" + name;
  }
  // Bakes a world with nodes into a folder.
  Nodes bake(const Case& it, const std::string& name, bool fresh = true, int32_t workers = 0) {
    Context context;
    BakeConfig config = it.config;
    config.workers = workers;
    config.old_zones = fresh ? OldZones::kBakeAgain : OldZones::kKeep;
    config.carry_nodes = !fresh;
    const auto report = bake_world_to(at(name), it.scene, config, context);
    EXPECT_TRUE(report) << report.error().message;
    const auto world = World::open(at(name));
    const auto made = Nodes::create_in_folder(
        *world, it.scene, {.size = it.size, .workers = workers, .rebuild = fresh}, context);
    EXPECT_TRUE(made) << made.error().message;
    const auto nodes = Nodes::open(*world);
    EXPECT_TRUE(nodes) << nodes.error().message;
    return *nodes;
  }
  static AirLinks links_of(const Nodes& nodes) {
    const auto links = AirLinks::open(nodes);
    EXPECT_TRUE(links) << links.error().message;
    return *links;
  }

  test::ScratchFolder folder_;
};

// A leaf by brute force: the lowest voxel, in the order z, y, x, of a free cube, or of a piece of a
// block; of the sky the zone alone.
using LeafKey = std::tuple<int32_t, int32_t, int32_t, bool>;

struct Rise {  // a place from which classes rise into a leaf
  uint32_t node = 0;
  uint16_t classes = 0;
  uint8_t height = 0, width = 0;
  double off_axis = 0;
  Vec3d feet;
};
struct MetLeaf {
  std::vector<Rise> rises;
  Vec3d inside;  // a point of it
};

class Oracle {
 public:
  explicit Oracle(const Nodes& nodes)
      : nodes_(nodes), world_(*data_of(nodes.world())), air_(*world_.air) {
    find_owners();
    for (uint32_t node = 0; node < nodes.node_count(); ++node) visit(node);
  }
  [[nodiscard]] const std::map<LeafKey, MetLeaf>& leaves() const { return leaves_; }

 private:
  // Patch, cell and class: the smallest node that holds it.
  using CellKey = std::tuple<PatchKind, uint32_t, int32_t, int32_t, int32_t>;

  template <class Visit>
  void for_cells(uint32_t n, const NodeInfo& info, int32_t c, Visit visit) const {
    const int32_t across = (1 << info.depth) >> info.block_level;
    const uint64_t cells = nodes_.partial_cells(c, n);
    for (int32_t t = 0; t < across; ++t) {
      for (int32_t s = 0; s < across; ++s) {
        if (info.cells != 0 && (cells >> (8 * t + s) & 1) == 0) continue;
        visit(info.s * across + s, info.t * across + t);
      }
    }
  }
  void find_owners() {
    for (uint32_t n = 0; n < nodes_.node_count(); ++n) {
      const NodeInfo info = nodes_.node(n);
      for (int32_t c = 0; c < 3; ++c) {
        if ((info.classes >> c & 1) == 0) continue;
        for_cells(n, info, c, [&](int32_t s, int32_t t) {
          auto& owner = owners_[{info.kind, info.source, s, t, c}];
          if (info.block_level + 1 > owner.first) owner = {info.block_level + 1, n};
        });
      }
    }
  }
  void visit(uint32_t n) {
    const NodeInfo info = nodes_.node(n);
    for (int32_t c = 1; c < 3; ++c) {
      if ((info.classes >> c & 1) == 0) continue;
      for_cells(n, info, c, [&](int32_t s, int32_t t) {
        if (owners_.at({info.kind, info.source, s, t, c}).second == n) rise(n, info, c, s, t);
      });
    }
  }
  void rise(uint32_t n, const NodeInfo& info, int32_t c, int32_t s, int32_t t) {
    const double side = 1 << info.depth;
    const NodePlace place = nodes_.place(c, n, (s + 0.5) / side, (t + 0.5) / side);
    ASSERT_TRUE(place);
    const AvatarClass& avatar = world_.summary.classes[static_cast<size_t>(c)];
    const world::AirBody body = world::air_body(avatar, air_.shape);
    const double cell = air_.shape.cell * 1e-3;
    const double px = (place.feet.x - world_.summary.origin.x) / cell;
    const double py = (place.feet.y * 1000 - air_.shape.origin_y) / air_.shape.cell;
    const double pz = (place.feet.z - world_.summary.origin.z) / cell;
    const auto x = static_cast<int32_t>(std::floor(px)), z = static_cast<int32_t>(std::floor(pz));
    for (auto y = static_cast<int32_t>(std::floor(py));; ++y) {
      if (std::max(y + 1.0 / 1024, py) > py + avatar.height / cell) return;  // above the head
      if (!air_.is_legal(body, x, y, z)) continue;
      double axis_x = 0, axis_z = 0;
      MetLeaf& leaf = leaves_[leaf_at(x, y, z, axis_x, axis_z)];
      leaf.inside = {world_.summary.origin.x + (x + 0.5) * cell,
                     ((y + 0.5) * air_.shape.cell + air_.shape.origin_y) * 1e-3,
                     world_.summary.origin.z + (z + 0.5) * cell};
      const auto same = std::find_if(leaf.rises.begin(), leaf.rises.end(), [&](const Rise& r) {
        return r.node == n && length(r.feet - place.feet) == 0;
      });
      if (same != leaf.rises.end()) {
        same->classes = static_cast<uint16_t>(same->classes | 1u << c);
        return;
      }
      const double dx = px - axis_x, dz = pz - axis_z;
      leaf.rises.push_back({n, static_cast<uint16_t>(1u << c), info.height, info.width,
                            dx * dx + dz * dz, place.feet});
      return;
    }
  }
  LeafKey leaf_at(int32_t x, int32_t y, int32_t z, double& axis_x, double& axis_z) const {
    const int32_t zone_x = x / air_.zone_side, zone_z = z / air_.zone_side;
    const world::AirTree* tree = air_.zone(zone_x, zone_z).tree;
    const auto place = tree->find(x - zone_x * air_.zone_side, y, z - zone_z * air_.zone_side);
    if (place.cube.side == 0) return {zone_x, INT32_MAX, zone_z, true};
    const int32_t x0 = place.cube.x + zone_x * air_.zone_side;
    const int32_t z0 = place.cube.z + zone_z * air_.zone_side, side = place.cube.side;
    axis_x = x0 + side / 2.0;
    axis_z = z0 + side / 2.0;
    if (world::air_kind(place.word) == world::AirKind::kFree) return {z0, place.cube.y, x0, false};
    std::set<std::tuple<int32_t, int32_t, int32_t>> piece{{z, y, x}};
    std::vector<std::array<int32_t, 3>> queue{{x, y, z}};
    while (!queue.empty()) {
      const auto at = queue.back();
      queue.pop_back();
      for (size_t axis = 0; axis < 3; ++axis) {
        for (const int32_t step : {-1, 1}) {
          auto next = at;
          next[axis] += step;
          const bool inside = next[0] >= x0 && next[0] < x0 + side && next[1] >= place.cube.y &&
                              next[1] < place.cube.y + side && next[2] >= z0 && next[2] < z0 + side;
          if (!inside || !air_.is_free(next[0], next[1], next[2])) continue;
          if (piece.insert({next[2], next[1], next[0]}).second) queue.push_back(next);
        }
      }
    }
    const auto [lz, ly, lx] = *piece.begin();
    return {lz, ly, lx, false};
  }

  const Nodes& nodes_;
  const world::WorldData& world_;
  const world::AirData& air_;
  std::map<CellKey, std::pair<int32_t, uint32_t>> owners_;
  std::map<LeafKey, MetLeaf> leaves_;
};

TEST_F(AirLinksTest, EachLeafIsLinkedToTheMostAccessibleNodeNearestToItsAxis) {
  for (const Case& it : {table(), garage(), landscape()}) {
    SCOPED_TRACE(it.name);
    const Nodes nodes = bake(it, it.name);
    const AirLinks links = links_of(nodes);
    ASSERT_TRUE(links.check_all());
    const Oracle oracle(nodes);
    uint64_t count = 0, several = 0, over_borders = 0;
    std::map<uint32_t, uint64_t> of_node;
    for (const auto& [key, leaf] : oracle.leaves()) {
      uint16_t met = 0, covered = 0;
      for (const Rise& rise : leaf.rises) met |= rise.classes;
      const std::vector<AirLink> found = links.of_leaf(leaf.inside);
      several += found.size() > 1 ? 1 : 0;
      for (const AirLink& link : found) {
        ++count;
        ++of_node[link.node];
        const graph::NodeData& data = *data_of(nodes);
        const format::NodeZoneEntry& home = data.slots[data.slot_of(link.node)]->entry;
        over_borders += home.x() != link.leaf_id.zone_x || home.z() != link.leaf_id.zone_z;
        EXPECT_EQ(link.classes & covered, 0);
        // Nothing that is left covers more classes, or is as good for them and better.
        const auto rank = [&](const Rise& rise) {
          return std::tuple(-std::popcount(static_cast<uint16_t>(rise.classes & ~covered)),
                            -rise.height, -rise.width, rise.off_axis);
        };
        const Rise* own = nullptr;
        for (const Rise& rise : leaf.rises) {
          if (rise.node == link.node && length(rise.feet - link.feet) < 1e-9) own = &rise;
        }
        ASSERT_NE(own, nullptr);
        EXPECT_EQ(link.classes, own->classes & ~covered);
        for (const Rise& rise : leaf.rises) EXPECT_LE(rank(*own), rank(rise));
        covered |= link.classes;
        const auto back = links.of_node(link.node);
        EXPECT_EQ(std::count_if(back.begin(), back.end(),
                                [&](const AirLink& b) {
                                  return b.leaf_id == link.leaf_id && b.classes == link.classes &&
                                         b.s == link.s && b.t == link.t;
                                }),
                  1);
      }
      EXPECT_EQ(covered, met);  // No class is without a link.
    }
    const AirLinkSummary summary = links.summary();
    EXPECT_EQ(summary.leaves, oracle.leaves().size());
    EXPECT_EQ(summary.leaf_sinks, 0u);
    EXPECT_EQ(summary.links, count);
    EXPECT_EQ(summary.nodes, of_node.size());
    EXPECT_GT(summary.leaves, 100u);
    EXPECT_GT(several, 0u);
    EXPECT_EQ(over_borders > 0, !it.scene.patches.empty());
    uint64_t back = 0;
    for (uint32_t n = 0; n < nodes.node_count(); ++n) back += links.of_node(n).size();
    EXPECT_EQ(back, count);
  }
}

TEST_F(AirLinksTest, TheExactBodyRisesAndLandsOnEachAndNoLeafIsASink) {
  for (const Case& it : {table(), landscape()}) {
    const Nodes nodes = bake(it, it.name);
    const AirLinks links = links_of(nodes);
    Context context;
    for (const int32_t c : {1, 2}) {
      const auto report =
          verify_air_links(links, nodes, it.scene, {.samples = 4000, .avatar_class = c}, context);
      ASSERT_TRUE(report) << report.error().message;
      EXPECT_GT(report->links, 300u);
      EXPECT_GT(report->places, 300u);
      EXPECT_EQ(report->blocked + report->entered + report->one_way + report->sinks, 0u)
          << it.name << " class " << c;
    }
    // Against a scene with more solids it fails.
    Scene more = it.scene;
    const Box3d box = more.bounds();
    for (double y = box.min.y; y < box.max.y; y += 0.3) {
      const double x0 = box.min.x + 2, z0 = box.min.z + 2, x1 = x0 + 15, z1 = z0 + 15;
      more.add_quad({x0, y, z0}, {x0, y, z1}, {x1, y, z1}, {x1, y, z0});
    }
    const auto report =
        verify_air_links(links, nodes, more, {.samples = 4000, .avatar_class = 1}, context);
    ASSERT_TRUE(report) << report.error().message;
    EXPECT_GT(report->entered, 10u);
  }
}

TEST_F(AirLinksTest, TheBytesAreThoseOfAnyThreadsAndOfABakeThatKeepsNothing) {
  for (Case it : {table(), landscape()}) {
    bake(it, "w", true, 1);
    bake(it, "three", true, 3);
    const auto one = test::folder_bytes(at("w") + "/nodes");
    EXPECT_TRUE(one == test::folder_bytes(at("three") + "/nodes")) << it.name;
    EXPECT_TRUE(one.contains("index.thg"));
    const Box3d box = it.scene.bounds();
    for (uint64_t i = 0; i < 4; ++i) {
      const Vec3d low{box.min.x + random_unit(7, i, 0) * (box.max.x - box.min.x - 3),
                      box.min.y + random_unit(7, i, 1) * 5,
                      box.min.z + random_unit(7, i, 2) * (box.max.z - box.min.z - 3)};
      it.scene.add_box(low, low + Vec3d{2, 1.5, 2});
      if (!it.scene.patches.empty()) {
        it.scene.patch_of_triangle.resize(it.scene.triangles.size(), kNoPatch);
        it.scene.patch_part.resize(it.scene.triangles.size());
      }
      bake(it, "w", false);
      bake(it, "fresh", true);
      EXPECT_TRUE(test::folder_bytes(at("w") + "/nodes") ==
                  test::folder_bytes(at("fresh") + "/nodes"))
          << it.name << " " << i;
    }
    // Nothing has changed: files are the same, not only their bytes.
    const auto last = test::folder_bytes(at("w") + "/nodes");
    for (const auto& [name, bytes] : last) {
      fs::create_hard_link(at("w") + "/nodes/" + name, at("w_" + it.name + name));
    }
    bake(it, "w", false);
    uint64_t kept = 0;
    for (const auto& [name, bytes] : last) {
      if (!name.starts_with("zone") || !name.ends_with(".thg")) continue;
      ++kept;
      EXPECT_TRUE(fs::equivalent(at("w") + "/nodes/" + name, at("w_" + it.name + name))) << name;
    }
    EXPECT_GT(kept, 3u);
    EXPECT_TRUE(test::folder_bytes(at("w") + "/nodes") ==
                test::folder_bytes(at("fresh") + "/nodes"));
  }
}

// A byte of a file, changed.
void damage(const std::string& name, std::streamoff from_end) {
  std::fstream file(name, std::ios::binary | std::ios::in | std::ios::out);
  file.seekg(-from_end, std::ios::end);
  const auto byte = static_cast<char>(file.get() ^ 1);
  file.seekp(-from_end, std::ios::end);
  file.put(byte);
}

TEST_F(AirLinksTest, DamagedFilesAndThoseOfOtherBakesAreRefusedByName) {
  const Case it = table();
  const Nodes nodes = bake(it, "w");
  const std::string index = at("w") + "/nodes/index.thg";
  const auto bytes = test::folder_bytes(at("w") + "/nodes");
  const auto zone = std::find_if(bytes.begin(), bytes.end(), [](const auto& file) {
    return file.first.starts_with("zone") && file.first.ends_with(".thg");
  });
  ASSERT_NE(zone, bytes.end());
  const std::string zone_name = at("w") + "/nodes/" + zone->first;
  Context context;
  const auto flight_fault = [&] {
    const auto world = World::open(at("w"));
    const auto finder = PathFinder::create(*world, {.avatar_class = 1}, context);
    return finder ? std::string() : finder.error().message;
  };
  EXPECT_EQ(flight_fault(), "");
  damage(zone_name, 5);
  {
    const auto links = AirLinks::open(nodes);
    ASSERT_TRUE(links);
    const auto whole = links->check_all();
    ASSERT_FALSE(whole);
    EXPECT_NE(whole.error().message.find(zone->first), std::string::npos) << whole.error().message;
    EXPECT_NE(flight_fault().find(zone->first), std::string::npos);
  }
  damage(zone_name, 5);
  damage(index, 20);
  {
    const auto links = AirLinks::open(nodes);
    ASSERT_FALSE(links);
    EXPECT_NE(links.error().message.find("index.thg"), std::string::npos);
    EXPECT_NE(flight_fault().find("index.thg"), std::string::npos);
  }
  damage(index, 20);
  EXPECT_EQ(flight_fault(), "");
  // Of the same ground with other air, and with other nodes.
  Case other = it;
  other.config.air = 0.8;
  bake(other, "air");
  fs::copy_file(at("air") + "/nodes/index.thg", index, fs::copy_options::overwrite_existing);
  EXPECT_NE(flight_fault().find("other air"), std::string::npos) << flight_fault();
  other = it;
  other.size = 3;
  bake(other, "nodes");
  fs::copy_file(at("nodes") + "/nodes/index.thg", index, fs::copy_options::overwrite_existing);
  EXPECT_NE(flight_fault().find("other nodes"), std::string::npos) << flight_fault();
  // Without the index there are none, and landings are elected.
  fs::remove(index);
  EXPECT_EQ(flight_fault(), "");
  const auto none = AirLinks::open(nodes);
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().code, Errc::kNotFound);
}

TEST_F(AirLinksTest, ABakeOfOtherAirKeepsTheNodesAndNoLinks) {
  const Case it = table();
  bake(it, "w");
  const auto before = test::folder_bytes(at("w") + "/nodes");
  Context context;
  BakeConfig config = it.config;
  config.carry_nodes = true;
  ASSERT_TRUE(bake_world_to(at("w"), it.scene, config, context));
  EXPECT_TRUE(before == test::folder_bytes(at("w") + "/nodes"));
  config.air = 0.8;
  ASSERT_TRUE(bake_world_to(at("w"), it.scene, config, context));
  const auto world = World::open(at("w"));
  EXPECT_TRUE(Nodes::open(*world));
  EXPECT_FALSE(AirLinks::exist(*world));
  for (const auto& [name, bytes] : test::folder_bytes(at("w") + "/nodes")) {
    EXPECT_FALSE(name.ends_with(".thg")) << name;
  }
}

TEST_F(AirLinksTest, WithoutAirOrWithoutFlyersThereAreNoneOrThoseOfAllClasses) {
  Case it = table();
  it.config.air = 0;
  it.config.classes = default_classes();
  EXPECT_FALSE(AirLinks::exist(bake(it, "w").world()));
  it.config.air = 0.4;
  const Nodes nodes = bake(it, "w");
  uint16_t classes = 0;
  const AirLinks links = links_of(nodes);
  for (uint64_t n = 0; n < links.summary().links; ++n) classes |= links.link(n)->classes;
  EXPECT_EQ(classes, 0b1111);
}

TEST_F(AirLinksTest, FlyersLandWhereTheLeafBelowIsLinkedUnlessAnObstacleIsThere) {
  for (const Case& it : {table(), landscape()}) {
    SCOPED_TRACE(it.name);
    const Nodes nodes = bake(it, it.name);
    const AirLinks links = links_of(nodes);
    Context context;
    auto finder = PathFinder::create(nodes.world(), {.avatar_class = 1}, context);
    ASSERT_TRUE(finder) << finder.error().message;
    auto made = path::FlightFinder::create(nodes.world(), {.avatar_class = 1}, context);
    ASSERT_TRUE(made) << made.error().message;
    path::FlightFinder flight = *std::move(made);
    // The election at each query, for a world whose links are gone.
    const std::string index = at(it.name) + "/nodes/index.thg";
    fs::rename(index, index + ".off");
    const auto elects = PathFinder::create(*World::open(at(it.name)), {.avatar_class = 1}, context);
    fs::rename(index + ".off", index);
    ASSERT_TRUE(elects);
    PathFinder oracle = *elects;
    uint64_t linked = 0, landed = 0, elected = 0, crates = 0;
    for (uint64_t n = 0; n < 400; ++n) {
      const auto point = finder->random_point(1, n);
      ASSERT_TRUE(point);
      const Place place = finder->landing(*point);
      const Place other = oracle.landing(*point);
      elected += other ? 1 : 0;
      if (!place) {
        EXPECT_FALSE(other);
        continue;
      }
      ++landed;
      const auto up = finder->take_off(place);
      ASSERT_TRUE(up);
      Path path;
      finder->find({.from = *point, .to = *up}, path);
      EXPECT_EQ(path.end, PathEnd::kReached);
      for (const AirLink& link : links.of_leaf(*up)) {
        if ((link.classes >> 1 & 1) != 0 && length(link.feet - place.position) < 0.1) ++linked;
      }
      // With a crate on it, it lands beside it, or nowhere.
      if (n % 4 != 0) continue;
      path::FlightFinder changed = flight;
      const Vec3d at = place.position;
      changed.add_obstacle({Prism::box(at - Vec3d{0.3, 0.2, 0.3}, at + Vec3d{0.3, 0.4, 0.3})});
      const Place beside = changed.landing(*point);
      ++crates;
      if (!beside) continue;
      const double dx = std::fabs(beside.position.x - at.x),
                   dz = std::fabs(beside.position.z - at.z);
      EXPECT_TRUE(std::max(dx, dz) > 0.3 || std::fabs(beside.position.y - at.y) > 0.4);
      EXPECT_TRUE(changed.take_off(beside));
    }
    EXPECT_GT(crates, 5u);
    EXPECT_GT(landed, 100u);
    EXPECT_GT(linked, landed * 4 / 5);
    EXPECT_GE(landed, elected);
  }
}

}  // namespace
}  // namespace throng
