// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "graph/node_clearance.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "baked.h"
#include "core/random.h"
#include "patch_nets.h"
#include "throng/path.h"
#include "throng/surface.h"
#include "verify/cylinder.h"
#include "verify/turned_body.h"

// What nodes promise of bodies of any size, against exact bodies and all triangles; and along
// paths, against a search of all nodes at many points.
namespace throng {
namespace {

using test::bake;
using test::builtin;

std::vector<AvatarClass> classes() {
  std::vector<AvatarClass> all = default_classes();
  all.push_back({.name = "climber"});
  all.back().climb_slope = 180;
  return all;
}

struct Made {
  std::string name;
  Scene scene;
  Nodes nodes;
};

Made make(const std::string& name, const Scene& scene, double cell, double size) {
  Context context;
  auto nodes = Nodes::create(bake(scene, cell, classes()), scene, {.size = size}, context);
  EXPECT_TRUE(nodes) << nodes.error().message;
  return {name, scene, nodes ? *nodes : Nodes{}};
}

const std::vector<Made>& worlds() {
  static const std::vector<Made> all = [] {
    std::vector<Made> made;
    made.push_back(make("net", test::net_scene({.side = 3, .cell = 8, .relief = 2}), 0.25, 0.5));
    made.push_back(make("garage", builtin({.name = "garage"}), 0.25, 1));
    made.push_back(make("bridge", builtin({.name = "bridge"}), 0.25, 1));
    made.push_back(
        make("landscape", builtin({.name = "landscape", .size = 64, .seed = 3}), 0.5, 1));
    return made;
  }();
  return all;
}

AvatarClass random_body(uint64_t n) {
  const auto between = [n](uint64_t stream, double low, double high) {
    return low + random_unit(71, stream, n) * (high - low);
  };
  AvatarClass body{.name = "any"};
  body.radius = between(1, 0.05, 0.9);
  body.height = between(2, 0.3, 3.2);
  body.step_height = between(3, 0.02, 0.9);
  body.max_slope = between(4, 5, 60);
  if (n % 5 == 0) body.climb_slope = between(5, 30, 180);
  return body;
}

// The place of the same feet with the axis of another body.
verify::Pose pose_of(const Nodes& nodes, const NodePlace& place, const AvatarClass& body) {
  const bool leans = body.climb_slope > 0 && nodes.node(place.node1 - 1).kind == PatchKind::kBezier;
  return {place.feet, leans ? place.normal : Vec3d{0, 1, 0}};
}

bool is_inside(const AvatarClass& body, const AvatarClass& avatar) {
  return body.radius <= avatar.radius && body.height <= avatar.height;
}

TEST(NodeClearance, NoTriangleMeetsABodyThatFits) {
  uint64_t wider = 0, taller = 0, leaning = 0, free = 0, promised = 0;
  for (const Made& made : worlds()) {
    const verify::TriangleTree tree(made.scene, 0);
    uint64_t fit = 0;
    for (uint64_t n = 0; n < 4000; ++n) {
      const auto c = static_cast<int32_t>(n % 5);
      const NodePlace place = made.nodes.random_place(c, 7, n);
      ASSERT_TRUE(place) << made.name;
      const AvatarClass body = random_body(n);
      const verify::Pose pose = pose_of(made.nodes, place, body);
      const bool is_free = !verify::turned_intruder(tree, body, pose);
      free += is_free;
      if (!made.nodes.fits(place, body)) continue;
      ++fit;
      EXPECT_TRUE(is_free) << made.name << ", body " << n << ", radius " << body.radius
                           << ", height " << body.height;
      EXPECT_TRUE(verify::turned_support(tree, body, place.feet)) << made.name << ", body " << n;
      const auto all = classes();
      const auto holds = [&](auto is_less) { return std::any_of(all.begin(), all.end(), is_less); };
      wider += body.radius > 0.5;
      taller += !holds([&](const AvatarClass& a) { return is_inside(body, a); });
      leaning += pose.axis.y < 0.99;
    }
    EXPECT_GT(fit, 200u) << made.name;
    promised += fit;
  }
  EXPECT_GT(wider, 300u);
  EXPECT_GT(taller, 100u);
  EXPECT_GT(leaning, 30u);
  RecordProperty("promised of those that are free",
                 std::to_string(promised) + " of " + std::to_string(free));
}

TEST(NodeClearance, AClassFitsWhereItStandsAndItsLimitsArePromised) {
  const auto all = classes();
  for (const Made& made : worlds()) {
    for (int32_t c = 0; c < 5; ++c) {
      const AvatarClass& avatar = all[static_cast<size_t>(c)];
      for (uint64_t n = 0; n < 100; ++n) {
        const NodePlace place = made.nodes.random_place(c, 8, n);
        const NodeClearance here = made.nodes.clearance(c, place);
        EXPECT_NE(here.classes >> c & 1, 0) << made.name << ", class " << c;
        EXPECT_LE(here.inclination, std::max(avatar.max_slope, avatar.climb_slope));
        EXPECT_GE(here.width, 0);
        const bool leans = c == 4 && made.nodes.node(place.node1 - 1).kind == PatchKind::kBezier;
        EXPECT_GE(leans ? here.height : here.headroom, avatar.height) << made.name;
        EXPECT_TRUE(made.nodes.fits(place, avatar)) << made.name << ", class " << c;
        AvatarClass other = avatar;  // A little larger than what is ever promised.
        other.height = 1e3;
        EXPECT_FALSE(made.nodes.fits(place, other));
        other = avatar;
        other.radius = 1e3;
        EXPECT_FALSE(made.nodes.fits(place, other));
      }
    }
  }
}

// All nodes around parameters of a patch, whole and partial, that hold a class, by a search of all.
class NaiveNodes {
 public:
  explicit NaiveNodes(const Nodes& nodes) : nodes_(nodes), bins_(nodes.summary().bins) {
    for (uint32_t n = 0; n < nodes.node_count(); ++n) {
      const NodeInfo info = nodes.node(n);
      of_patch_[{info.kind, info.source}].push_back({n, info});
    }
  }

  // `own_limit`: of the limits of classes only that of `c`.
  [[nodiscard]] NodeClearance at(int32_t c, uint32_t node, double s, double t,
                                 bool own_limit = false) const {
    const NodeInfo of = nodes_.node(node);
    NodeClearance best;
    for (const auto& [n, info] : of_patch_.at({of.kind, of.source})) {
      if (!holds(n, info, c, s, t)) continue;
      best.inclination = std::min(best.inclination, bins_.inclination_of(info.inclination));
      best.height = std::max(best.height, bins_.height_of(info.height));
      best.headroom = std::max(best.headroom, bins_.height_of(info.headroom));
      for (int32_t k = 0; k < 5; ++k) {
        if (!holds(n, info, k, s, t)) continue;
        best.classes |= static_cast<uint16_t>(1u << k);
        if (own_limit && k != c) continue;
        const bool climbs = k == 4 && info.kind == PatchKind::kBezier;
        const double tall = classes()[static_cast<size_t>(k)].height;
        if (climbs || info.kind == PatchKind::kLevelTile) best.height = std::max(best.height, tall);
        if (!climbs) best.headroom = std::max(best.headroom, tall);
        best.inclination =
            std::min(best.inclination, climbs ? 180 : classes()[static_cast<size_t>(k)].max_slope);
      }
    }
    return best;
  }

  // The middles of all cells of patches with nodes on which the class cannot stand.
  [[nodiscard]] std::vector<Vec3d> closed_cells(int32_t c) const {
    std::vector<Vec3d> closed;
    for (const auto& [patch, list] : of_patch_) {
      const int32_t side = 1 << list[0].second.depth;
      for (int32_t t = 0; t < side; ++t) {
        for (int32_t s = 0; s < side; ++s) {
          const double u = (s + 0.5) / side, v = (t + 0.5) / side;
          const bool stands = std::any_of(list.begin(), list.end(), [&](const auto& one) {
            return holds(one.first, one.second, c, u, v);
          });
          if (!stands) closed.push_back(nodes_.point(list[0].first, u, v));
        }
      }
    }
    return closed;
  }

 private:
  // On a border, what both sides promise holds.
  [[nodiscard]] bool holds(uint32_t n, const NodeInfo& info, int32_t c, double s, double t) const {
    constexpr double kTouch = 1e-9;
    if ((info.classes >> c & 1) == 0) return false;
    const auto is_in = [&](double low_s, double low_t, double side) {
      return s >= low_s - kTouch && s <= low_s + side + kTouch && t >= low_t - kTouch &&
             t <= low_t + side + kTouch;
    };
    const double side = 1.0 / (1 << info.block_level);
    if (!is_in(info.s * side, info.t * side, side)) return false;
    if (info.cells == 0) return true;
    const uint64_t cells = nodes_.partial_cells(c, n);
    for (int32_t bit = 0; bit < 64; ++bit) {
      if ((cells >> bit & 1) == 0) continue;
      const double i = info.s * 8 + bit % 8, j = info.t * 8 + bit / 8;
      if (is_in(i / 64, j / 64, 1.0 / 64)) return true;
    }
    return false;
  }

  const Nodes& nodes_;
  NodeBins bins_;
  std::map<std::pair<PatchKind, uint32_t>, std::vector<std::pair<uint32_t, NodeInfo>>> of_patch_;
};

TEST(NodeClearance, IsThatOfAllNodesAroundAPlace) {
  for (const Made& made : worlds()) {
    const NaiveNodes naive(made.nodes);
    for (uint64_t n = 0; n < 1500; ++n) {
      const auto c = static_cast<int32_t>(n % 5);
      const NodePlace place = made.nodes.random_place(c, 9, n);
      const NodeClearance found = made.nodes.clearance(c, place);
      const NodeClearance expected = naive.at(c, place.node1 - 1, place.s, place.t);
      EXPECT_EQ(found.classes, expected.classes) << made.name << ", " << n;
      EXPECT_EQ(found.inclination, expected.inclination) << made.name << ", " << n;
      EXPECT_EQ(found.height, expected.height) << made.name << ", " << n;
      EXPECT_EQ(found.headroom, expected.headroom) << made.name << ", " << n;
    }
    EXPECT_EQ(made.nodes.clearance(0, {}).classes, 0);
    EXPECT_EQ(made.nodes.clearance(99, made.nodes.random_place(0, 9, 0)).classes, 0);
    EXPECT_FALSE(made.nodes.fits({}, AvatarClass{}));
  }
}

// Shares of random places, by what the nodes around each promise; and sums, by the components.
TEST(NodeDistribution, IsThatOfRandomPlacesAndAddsUpToTheArea) {
  constexpr uint64_t kPlaces = 4000;
  for (const Made& made : worlds()) {
    const NodeBins bins = made.nodes.summary().bins;
    const NaiveNodes naive(made.nodes);
    for (int32_t c = 0; c < 5; ++c) {
      const NodeDistribution found = made.nodes.distribution(c);
      double area = 0;
      for (const NodeComponent& one : made.nodes.components(c)) area += one.area;
      std::array<double, 16> inclination{}, height{}, headroom{};
      for (uint64_t n = 0; n < kPlaces; ++n) {
        const NodePlace place = made.nodes.random_place(c, 12, n);
        const NodeClearance here = naive.at(c, place.node1 - 1, place.s, place.t, true);
        // Codes of equal edges are one code.
        inclination[bins.inclination_code(here.inclination)] += area / kPlaces;
        height[bins.height_code(here.height)] += area / kPlaces;
        headroom[bins.height_code(here.headroom)] += area / kPlaces;
      }
      const auto compare = [&](const std::array<double, 16>& areas,
                               const std::array<double, 16>& expected, const char* what) {
        double sum = 0;
        for (size_t code = 0; code < 16; ++code) {
          sum += areas[code];
          EXPECT_GT(areas[code], -1e-6);
          // Places are uniform in parameters, not over the ground.
          EXPECT_NEAR(areas[code] / area, expected[code] / area, 0.04)
              << made.name << ", class " << c << ", " << what << ", code " << code;
        }
        EXPECT_NEAR(sum, area, 1e-6 * area) << made.name << ", class " << c << ", " << what;
      };
      compare(found.inclination, inclination, "inclination");
      compare(found.height, height, "height");
      compare(found.headroom, headroom, "headroom");
      double sum = 0;
      for (const double one : found.width) sum += one;
      EXPECT_NEAR(sum, area, 1e-6 * area) << made.name << ", class " << c;
    }
    EXPECT_EQ(made.nodes.distribution(-1).width[0], 0);
  }
}

// Of worlds of one sheet of ground, all ground near is ground that is connected.
TEST(NodeClearance, NoClosedCellIsNearerThanTheWidth) {
  Scene yard;
  yard.add_quad({0, 0, 0}, {0, 0, 30}, {30, 0, 30}, {30, 0, 0});
  yard.add_box({6, 0, 2}, {6.1, 2.5, 6});  // Walls on which nothing stands.
  yard.add_box({14, 0, 12}, {19, 0.7, 12.1});
  const Made flat = make("yard", yard, 0.2, 1);
  for (const Made* made : {&flat, &worlds()[0]}) {
    const NaiveNodes naive(made->nodes);
    double sum = 0;
    for (int32_t c = 0; c < 5; ++c) {
      const std::vector<Vec3d> closed = naive.closed_cells(c);
      for (uint64_t n = 0; n < 400; ++n) {
        const NodePlace place = made->nodes.random_place(c, 10, n);
        const double width = made->nodes.clearance(c, place).width;
        sum += width;
        for (const Vec3d& p : closed) {
          const double far = made == &flat ? std::hypot(p.x - place.feet.x, p.z - place.feet.z)
                                           : length(p - place.feet);
          ASSERT_GE(far, width) << made->name << ", class " << c << ", " << n;
        }
      }
    }
    EXPECT_GT(sum / 2000, 0.3) << made->name;
  }
}

TEST(NodeClearance, AlongAPathItIsTheWorstOfAllItsPlaces) {
  Context context;
  uint64_t paths = 0, same = 0;
  for (const Made& made : worlds()) {
    const NaiveNodes naive(made.nodes);
    for (const int32_t c : {0, 2, 4}) {
      auto finder = PathFinder::create(
          made.nodes.world(), {.avatar_class = c, .space = PathSpace::kNodes, .nodes = made.nodes},
          context);
      ASSERT_TRUE(finder) << finder.error().message;
      Path path;
      for (uint64_t n = 0; n < 30; ++n) {
        finder->find({.from = made.nodes.random_place(c, 11, 2 * n),
                      .to = made.nodes.random_place(c, 11, 2 * n + 1)},
                     path);
        if (path.end != PathEnd::kReached) continue;
        const NodeClearance found = clearance_along(made.nodes, c, path);
        NodeClearance worst{
            .classes = UINT16_MAX, .inclination = 0, .height = 1e9, .headroom = 1e9, .width = 1e9};
        for (size_t i = 0; i < path.segments.size(); ++i) {
          if (path.segments[i] != SegmentKind::kWalk) continue;
          const NodePlace &a = path.node_places[i], &b = path.node_places[i + 1];
          for (int32_t k = 0; k < 9; ++k) {
            const double f = (k + 0.5) / 9;
            const double s = a.s + f * (b.s - a.s), t = a.t + f * (b.t - a.t);
            const NodeClearance here = naive.at(c, b.node1 - 1, s, t);
            if (here.classes == 0) continue;  // On a border, which is the next cell's here.
            worst.classes &= here.classes;
            worst.inclination = std::max(worst.inclination, here.inclination);
            worst.height = std::min(worst.height, here.height);
            worst.headroom = std::min(worst.headroom, here.headroom);
          }
        }
        ++paths;
        EXPECT_EQ(found.classes & ~worst.classes, 0) << made.name << ", " << n;
        EXPECT_NE(found.classes >> c & 1, 0) << made.name << ", " << n;
        EXPECT_GE(found.inclination, worst.inclination);
        EXPECT_LE(found.height, worst.height);
        EXPECT_LE(found.headroom, worst.headroom);
        same += found.inclination == worst.inclination && found.height == worst.height &&
                found.headroom == worst.headroom;
        for (const NodePlace& place : path.node_places) {
          if (!place) continue;
          EXPECT_LE(found.width, made.nodes.clearance(c, place).width + 1e-9);
        }
      }
    }
  }
  EXPECT_GT(paths, 150u);
  EXPECT_GT(same, paths * 7 / 10);
  const Nodes& nodes = worlds()[0].nodes;
  EXPECT_EQ(clearance_along(nodes, 0, {}).classes, 0);
}

// A drop is made for one class: what others could do there is not known.
TEST(NodeClearance, OverADropOnlyTheClassesOwnBodyCounts) {
  Scene scene;
  scene.add_quad({0, 2, 0}, {0, 2, 8}, {6, 2, 8}, {6, 2, 0});
  scene.add_quad({6, 0, 0}, {6, 0, 8}, {14, 0, 8}, {14, 0, 0});
  std::vector<AvatarClass> all = default_classes();
  all[0].max_drop = 3;
  Context context;
  const auto nodes = Nodes::create(bake(scene, 0.2, all), scene, {}, context);
  ASSERT_TRUE(nodes) << nodes.error().message;
  auto finder =
      PathFinder::create(nodes->world(), {.space = PathSpace::kNodes, .nodes = *nodes}, context);
  ASSERT_TRUE(finder) << finder.error().message;
  Path path;
  finder->find({.from = Vec3d{2, 2, 4}, .to = Vec3d{4, 2, 4}}, path);
  ASSERT_EQ(path.end, PathEnd::kReached);
  EXPECT_EQ(clearance_along(*nodes, 0, path).classes, 15);
  EXPECT_GT(clearance_along(*nodes, 0, path).width, 0.5);
  EXPECT_GT(clearance_along(*nodes, 0, path).height, 1.75);
  finder->find({.from = Vec3d{2, 2, 4}, .to = Vec3d{12, 0, 4}}, path);
  ASSERT_EQ(path.end, PathEnd::kReached);
  EXPECT_EQ(clearance_along(*nodes, 0, path).classes, 1);
  EXPECT_EQ(clearance_along(*nodes, 0, path).width, 0);
  EXPECT_EQ(clearance_along(*nodes, 0, path).height, 1.75);
}

}  // namespace
}  // namespace throng
