// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <queue>
#include <vector>

#include "baked.h"
#include "core/random.h"
#include "path/overlay/node_finder.h"
#include "path/surface/node_changes.h"
#include "path/surface/node_search.h"
#include "path/surface/node_view.h"
#include "throng/path.h"
#include "worlds.h"

// Areas and off-mesh links over nodes: against Dijkstra's algorithm over all crossings.
namespace throng {
namespace {

using test::bake;
using test::builtin;

constexpr double kNever = std::numeric_limits<double>::infinity();

template <class T>
T need(Result<T> made) {
  EXPECT_TRUE(made) << made.error().message;
  if constexpr (!std::is_void_v<T>) return *std::move(made);
}

std::vector<AvatarClass> classes() {
  std::vector<AvatarClass> all{{.name = "adult"}, {.name = "climber"}};
  all[1].climb_slope = 180;
  all[1].max_drop = 6;
  return all;
}

Nodes make_nodes(const Scene& scene) {
  Context context;
  return need(Nodes::create(bake(scene, 0.25, classes()), scene, {.size = 1}, context));
}

Prism area_at(const Nodes& nodes, uint64_t n) {
  const Vec3d at = nodes.random_place(static_cast<int32_t>(n % 2), 31, n).feet;
  const double x = 0.4 + random_unit(5, n, 0) * 4, z = 0.4 + random_unit(5, n, 1) * 4;
  return Prism::box(at - Vec3d{x, 0.8, z}, at + Vec3d{x, 2, z});
}

// How deep a point lies in a box; negative outside. [m]
double depth_in(const Prism& box, Vec3d p) {
  double x0 = kNever, x1 = -kNever, z0 = kNever, z1 = -kNever;
  for (const auto& [x, z] : box.corners) {
    x0 = std::min(x0, x);
    x1 = std::max(x1, x);
    z0 = std::min(z0, z);
    z1 = std::max(z1, z);
  }
  return std::min({p.x - x0, x1 - p.x, p.z - z0, z1 - p.z, p.y - box.low, box.high - p.y});
}

template <class Check>
void for_each_mesh(Check check) {
  Context context;
  for (const Scene& scene : {builtin({.name = "landscape", .size = 64, .seed = 2}),
                             builtin({.name = "garage", .size = 45, .levels = 2})}) {
    const Nodes nodes = make_nodes(scene);
    for (const int32_t c : {0, 1}) {
      const auto mesh = graph::NodeMesh::create(nodes, c, 1, context);
      ASSERT_TRUE(mesh);
      check(nodes, *mesh);
    }
  }
}

// Blocks as they are now: those that are whole, and parts.
template <class Visit>
void for_each_block(const path::NodeView& view, Visit visit) {
  const auto whole = static_cast<uint32_t>(view.mesh().blocks().size());
  for (uint32_t b = 0; b < view.block_count(); ++b) {
    if (b >= whole || !view.changes()->parts_of(b)) visit(b);
  }
}

TEST(NodeEdits, AreasCountWhereTheyLie) {
  uint64_t inside = 0, outside = 0, closed = 0;
  for_each_mesh([&](const Nodes& nodes, const graph::NodeMesh& mesh) {
    const path::BlockSquares squares(mesh);
    for (uint64_t n = 0; n < 12; ++n) {
      const Prism area = area_at(nodes, n);
      path::NodeChanges changes(mesh, squares, 20);
      const path::NodeView view(mesh, &changes);
      changes.add_area(area, 7);
      changes.update();
      EXPECT_TRUE(view.is_as_baked()) << "all kinds cost the same";
      changes.set_area_cost(7, 3);
      changes.update();
      constexpr double kMargin = 0.5;  // more than half a square
      for_each_block(view, [&](uint32_t b) {
        const graph::NodeBlock& block = view.block(b);
        const double side = block.side();
        const Vec3d middle = view.surface(b).at((block.s + 0.5) * side, (block.t + 0.5) * side);
        const double depth = depth_in(area, middle);
        if (depth > kMargin) {
          ASSERT_EQ(view.factor(b), 3);
          ++inside;
        } else if (depth < -kMargin) {
          ASSERT_EQ(view.factor(b), 1);
          ++outside;
        }
      });
      changes.set_area_cost(7, kNever);
      changes.update();
      for_each_block(view, [&](uint32_t b) {
        const graph::NodeBlock& block = view.block(b);
        const double side = block.side();
        ASSERT_LT(
            depth_in(area, view.surface(b).at((block.s + 0.5) * side, (block.t + 0.5) * side)),
            kMargin);
        ++closed;
      });
      EXPECT_EQ(view.min_factor(), 1);
      changes.set_area_cost(7, 1);
      changes.update();
      EXPECT_TRUE(view.is_as_baked());
    }
  });
  EXPECT_GT(inside, 100u);
  EXPECT_GT(outside, 1000u);
  EXPECT_GT(closed, 1000u);
}

bool same(const graph::NodePortal& a, const graph::NodePortal& b) {
  return a.a == b.a && a.b == b.b && a.on_a == b.on_a && a.on_b == b.on_b && a.kind == b.kind &&
         a.over_hole == b.over_hole && a.one_way == b.one_way && a.inside == b.inside;
}

// To the bit, with all numbers.
void expect_same(const graph::NodeMesh& mesh, const path::NodeChanges& one,
                 const path::NodeChanges& other) {
  ASSERT_EQ(one.parts().size(), other.parts().size());
  const auto whole = static_cast<uint32_t>(mesh.blocks().size());
  for (uint32_t k = 0; k < one.parts().size(); ++k) {
    const graph::NodeBlock &a = one.parts()[k], &b = other.parts()[k];
    ASSERT_TRUE(a.patch == b.patch && a.node == b.node && a.level == b.level && a.s == b.s &&
                a.t == b.t && a.inclination == b.inclination);
    ASSERT_EQ(one.base_of(whole + k), other.base_of(whole + k));
    ASSERT_EQ(one.factor(whole + k), other.factor(whole + k));
  }
  ASSERT_EQ(one.portals().size(), other.portals().size());
  for (size_t k = 0; k < one.portals().size(); ++k) {
    ASSERT_TRUE(same(one.portals()[k], other.portals()[k])) << k;
  }
  ASSERT_EQ(one.replaced().size(), other.replaced().size());
  for (size_t k = 0; k < one.replaced().size(); ++k) {
    const auto &a = one.replaced()[k], &b = other.replaced()[k];
    ASSERT_TRUE(a.portal == b.portal && a.first == b.first && a.last == b.last) << k;
  }
  ASSERT_TRUE(std::ranges::equal(one.touched(), other.touched()));
  ASSERT_TRUE(std::ranges::equal(one.cut_patches(), other.cut_patches()));
  ASSERT_EQ(one.min_factor(), other.min_factor());
  for (uint32_t b = 0; b < whole + one.parts().size(); ++b) {
    const auto p = one.portals_of(b), q = other.portals_of(b);
    ASSERT_EQ(p.has_value(), q.has_value()) << b;
    ASSERT_TRUE(!p || std::ranges::equal(*p, *q)) << b;
    if (b < whole) {
      ASSERT_EQ(one.parts_of(b), other.parts_of(b)) << b;
    }
  }
}

// Against changes that get the same calls and are updated once.
TEST(NodeEdits, ChangesThatAreUpdatedAfterEachCallAreThoseOfAllCalls) {
  uint64_t parts = 0;
  for_each_mesh([&](const Nodes& nodes, const graph::NodeMesh& mesh) {
    const path::BlockSquares squares(mesh);
    path::NodeChanges changes(mesh, squares, 20);
    std::vector<std::function<void(path::NodeChanges&)>> calls;
    uint32_t added = 0;
    for (uint64_t n = 0; n < 60; ++n) {
      const auto draw = [&](uint64_t stream, uint64_t count) {
        return random_below(9, stream, n, count);
      };
      const uint64_t what = draw(0, 10);
      const auto kind = static_cast<uint8_t>(1 + draw(1, 3));
      const auto id = static_cast<path::ChangeId>(1 + draw(2, added + 1));  // maybe of none
      const Prism prism = area_at(nodes, n % 40);
      const bool active = draw(3, 2) == 0;
      const double costs[] = {1, 0.5, 7, kNever};
      const double cost = costs[draw(4, 4)];
      calls.push_back([=](path::NodeChanges& to) {
        if (what < 3) to.add({prism, {}});
        if (what >= 3 && what < 6) to.add_area(prism, kind);
        if (what >= 6 && what < 8) to.set_active(id, active, false);
        if (what == 8) to.set_active(id, false, true);
        if (what == 9) to.set_area_cost(kind, cost);
      });
      added += what < 6 ? 1 : 0;
      calls.back()(changes);
      if (n % 7 != 3) changes.update();
      if (n % 5 != 4) continue;
      changes.update();
      path::NodeChanges fresh(mesh, squares, 20);
      for (const auto& call : calls) call(fresh);
      fresh.update();
      expect_same(mesh, changes, fresh);
      if (testing::Test::HasFatalFailure()) return;
      parts += fresh.parts().size();
    }
  });
  EXPECT_GT(parts, 3000u);
}

// While nothing is cut, because all kinds cost the same, an area may be switched without an end.
TEST(NodeEdits, AreasThatAreSwitchedTakeNoMoreMemory) {
  for_each_mesh([&](const Nodes& nodes, const graph::NodeMesh& mesh) {
    const path::BlockSquares squares(mesh);
    for (uint64_t n = 0; n < 4; ++n) {
      path::NodeChanges changes(mesh, squares, 20), once(mesh, squares, 20);
      const path::ChangeId area = changes.add_area(area_at(nodes, n), 7);
      once.add_area(area_at(nodes, n), 7);
      const auto switch_it = [&](uint64_t times) {
        for (uint64_t k = 0; k < 2 * times; ++k) {
          ASSERT_TRUE(changes.set_active(area, k % 2 != 0, false));
          changes.update();
        }
      };
      switch_it(500);
      const uint64_t bytes = changes.bytes();
      switch_it(2000);
      EXPECT_EQ(changes.bytes(), bytes);
      // Where they lie is known all the same.
      for (path::NodeChanges* each : {&changes, &once}) {
        each->set_area_cost(7, 3);
        each->update();
      }
      expect_same(mesh, changes, once);
    }
  });
}

TEST(NodeEdits, CostsThatNothingHasConcernNothing) {
  const Nodes nodes = make_nodes(worlds::flat(20));
  Context context;
  const auto mesh = graph::NodeMesh::create(nodes, 0, 1, context);
  ASSERT_TRUE(mesh);
  const path::BlockSquares squares(*mesh);
  path::NodeChanges changes(*mesh, squares, 20);
  const uint64_t before = changes.version();
  changes.set_area_cost(7, 3);  // no area
  const path::ChangeId area = changes.add_area(Prism::box({4, -1, 4}, {9, 1, 9}), 6);
  const uint64_t added = changes.version();
  EXPECT_GT(added, before) << "it could lie over another area";
  changes.add_area(Prism::box({4, 900, 4}, {9, 901, 9}), 7);
  changes.set_area_cost(7, 4);  // one that holds nothing
  EXPECT_EQ(changes.version(), added);
  changes.set_area_cost(6, 2);
  const uint64_t held = changes.version();
  EXPECT_GT(held, added);
  EXPECT_TRUE(changes.set_active(area, false, false));
  const uint64_t off = changes.version();
  EXPECT_GT(off, held);
  changes.set_area_cost(6, 5);  // one that is off
  EXPECT_EQ(changes.version(), off);
  changes.update();
  EXPECT_TRUE(changes.parts().empty());
  EXPECT_TRUE(changes.set_active(area, true, false));
  changes.update();
  ASSERT_FALSE(changes.parts().empty());
  bool is_found = false;
  for (uint32_t k = 0; k < changes.parts().size(); ++k) {
    const double factor = changes.factor(static_cast<uint32_t>(mesh->blocks().size()) + k);
    is_found = is_found || factor == 5;
    EXPECT_TRUE(factor == 1 || factor == 5) << factor;
  }
  EXPECT_TRUE(is_found);
}

// A tile is cut as a whole, so a crate in it costs the cuts of the others there, and no more.
TEST(NodeEdits, AnUpdateCutsOnlyWhatTheChangesTouch) {
  const Nodes nodes = make_nodes(worlds::flat(96));
  Context context;
  const auto mesh = graph::NodeMesh::create(nodes, 0, 1, context);
  ASSERT_TRUE(mesh);
  const path::BlockSquares squares(*mesh);
  path::NodeChanges one_by_one(*mesh, squares, 20), at_once(*mesh, squares, 20);
  std::vector<path::ChangeId> ids;
  for (int k = 0; k < 144; ++k) {
    const double x = 4 + 8 * (k % 12), z = 4 + 8 * static_cast<double>(k / 12);
    const Prism crate = Prism::box({x - 0.5, -1, z - 0.5}, {x + 0.5, 2, z + 0.5});
    ids.push_back(one_by_one.add({crate, {}}));
    at_once.add({crate, {}});
    one_by_one.update();
  }
  at_once.update();
  EXPECT_GT(at_once.cut_count(), 144u);
  EXPECT_LT(one_by_one.cut_count(), 6 * at_once.cut_count());
  expect_same(*mesh, one_by_one, at_once);
  // To take one away costs its tile as well.
  const uint64_t before = one_by_one.cut_count();
  one_by_one.set_active(ids[70], false, true);
  one_by_one.update();
  EXPECT_LT(one_by_one.cut_count() - before, at_once.cut_count() / 10);
}

struct Link {
  path::BlockPoint from, to;
  double cost = 0;
  bool two_way = false;
};

// The least cost over all crossings, from middle to middle. Links are those of the list, whatever
// portals state about them.
double least_cost(const path::NodeView& view, const std::vector<Link>& links,
                  const path::BlockPoint& from, const path::BlockPoint& to) {
  const auto piece = [&](const path::BlockPoint& a, Vec3d p, const path::BlockPoint& b, Vec3d q) {
    double along = length(q - p);
    if (view.surface(a.block).points != nullptr && along > 1) {
      const Vec3d middle = view.surface(a.block).at((a.s + b.s) / 2, (a.t + b.t) / 2);
      along = length(middle - p) + length(q - middle);
    }
    return along * view.factor(a.block);
  };
  // A state is where a crossing or a link leads to.
  struct Arc {
    path::BlockPoint out, in;
    Vec3d out_at, in_at;
    double through;
  };
  std::vector<Arc> arcs;
  std::vector<std::vector<uint32_t>> of_block(view.block_count());
  const auto add = [&](const path::BlockPoint& out, const path::BlockPoint& in, double through) {
    of_block[out.block].push_back(static_cast<uint32_t>(arcs.size()));
    arcs.push_back({out, in, path::position(view, out), path::position(view, in), through});
  };
  for_each_block(view, [&](uint32_t b) {
    path::for_each_arc_out(view, b, [&](const path::Crossing& crossing) {
      if (view.is_link(crossing.portal)) return;
      const auto [out, in] = path::ends_of(view, crossing);
      add(out, in,
          graph::portal_length(view.portal(crossing.portal), path::position(view, out),
                               path::position(view, in)));
    });
  });
  for (const Link& link : links) {
    add(link.from, link.to, link.cost);
    if (link.two_way) add(link.to, link.from, link.cost);
  }
  std::vector<double> cost(arcs.size(), kNever);
  using Entry = std::pair<double, uint32_t>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
  const Vec3d start = path::position(view, from), goal = path::position(view, to);
  double best = kNever;
  const auto expand = [&](const path::BlockPoint& at, Vec3d here, double so_far) {
    if (at.block == to.block) best = std::min(best, so_far + piece(at, here, to, goal));
    for (const uint32_t a : of_block[at.block]) {
      const double next = so_far + piece(at, here, arcs[a].out, arcs[a].out_at) + arcs[a].through;
      if (next >= cost[a]) continue;
      cost[a] = next;
      open.emplace(next, a);
    }
  };
  expand(from, start, 0);
  while (!open.empty()) {
    const auto [so_far, arc] = open.top();
    open.pop();
    if (so_far == cost[arc]) expand(arcs[arc].in, arcs[arc].in_at, so_far);
  }
  return best;
}

TEST(NodeEdits, SearchesFindTheLeastCost) {
  uint64_t reached = 0, unreachable = 0, over_links = 0, cheap = 0;
  for_each_mesh([&](const Nodes& nodes, const graph::NodeMesh& mesh) {
    const int32_t c = mesh.avatar_class();
    const path::BlockSquares squares(mesh);
    path::NodeChanges changes(mesh, squares, 20);
    const path::NodeView view(mesh, &changes);
    const path::PieceCost piece(view, 0);
    path::NodeSearch search(view, piece);
    std::vector<path::Crossing> crossings;
    std::vector<path::ChangeId> ids;
    const auto baked_point = [&](uint64_t n) {
      const NodePlace place = nodes.random_place(c, 6, n);
      return path::BlockPoint{mesh.block_at(mesh.patch_of_node(place.node1 - 1), place.s, place.t),
                              place.s, place.t};
    };
    const auto point = [&](uint64_t n) {
      path::BlockPoint at = baked_point(n);
      if (at.block != graph::kNoNode) at.block = changes.part_at(at.block, at.s, at.t);
      return at;
    };
    for (uint64_t round = 0; round < 6; ++round) {
      const auto kind = static_cast<uint8_t>(1 + round % 3);
      for (uint64_t n = 0; n < 6; ++n) {
        ids.push_back(changes.add_area(area_at(nodes, 10 * round + n), kind));
      }
      ids.push_back(changes.add({area_at(nodes, 500 + round), {}}));
      changes.set_area_cost(kind, round % 2 == 0 ? 0.2 : round == 5 ? kNever : 6);
      struct Wanted {
        uint64_t from, to;
        double cost;
        bool two_way;
      };
      std::vector<Wanted> wanted;
      std::vector<path::ChangeId> link_ids;
      for (uint64_t n = 0; n < 4; ++n) {
        const uint64_t a = 1000 + 10 * round + 2 * n;
        const path::BlockPoint from = baked_point(a), to = baked_point(a + 1);
        if (from.block == graph::kNoNode || to.block == graph::kNoNode) continue;
        const double straight = length(path::position(view, to) - path::position(view, from));
        wanted.push_back({a, a + 1, (0.1 + random_unit(8, a, 0)) * straight, n % 2 == 0});
        link_ids.push_back(changes.add_link({{from.block, from.s, from.t},
                                             {to.block, to.s, to.t},
                                             wanted.back().cost,
                                             wanted.back().two_way}));
      }
      changes.update();
      std::vector<Link> links;
      for (const Wanted& one : wanted) {
        const Link link{point(one.from), point(one.to), one.cost, one.two_way};
        if (link.from.block != graph::kNoNode && link.to.block != graph::kNoNode)
          links.push_back(link);
      }
      EXPECT_EQ(view.has_links(), !links.empty());
      for (uint64_t n = 0; n < 6; ++n) {
        const path::BlockPoint from = point(2 * n), to = point(2 * n + 1);
        if (from.block == graph::kNoNode || to.block == graph::kNoNode) continue;
        const double least = least_cost(view, links, from, to);
        const PathEnd end = search.find(from, to, {}, crossings);
        ASSERT_EQ(end == PathEnd::kReached, std::isfinite(least)) << round << ", " << n;
        if (end != PathEnd::kReached) {
          ++unreachable;
          continue;
        }
        ++reached;
        EXPECT_NEAR(search.cost(), least, 1e-9 * (1 + least)) << round << ", " << n;
        const bool takes_link =
            std::any_of(crossings.begin(), crossings.end(),
                        [&](const path::Crossing& one) { return view.is_link(one.portal); });
        over_links += takes_link ? 1 : 0;
        cheap += least < length(path::position(view, to) - path::position(view, from)) ? 1 : 0;
      }
      for (const path::ChangeId id : link_ids) EXPECT_TRUE(changes.set_active(id, false, true));
      if (round % 2 == 1) {
        EXPECT_TRUE(changes.set_active(ids[round], false, false));
      }
    }
    for (const path::ChangeId id : ids) EXPECT_TRUE(changes.set_active(id, false, true));
    changes.update();
    EXPECT_TRUE(view.is_as_baked());
    EXPECT_FALSE(view.has_links());
    EXPECT_EQ(view.min_factor(), 1);
  });
  EXPECT_GT(reached, 40u);
  EXPECT_GT(over_links, 2u);
  EXPECT_GT(cheap, 0u);
}

void expect_same(const Path& a, const Path& b) {
  EXPECT_EQ(a.end, b.end);
  EXPECT_EQ(a.cost, b.cost);
  EXPECT_EQ(a.length, b.length);
  EXPECT_EQ(a.searched_cost, b.searched_cost);
  EXPECT_EQ(a.nodes, b.nodes);
  EXPECT_EQ(a.segments, b.segments);
  EXPECT_EQ(a.corridor, b.corridor);
  ASSERT_EQ(a.points.size(), b.points.size());
  for (size_t i = 0; i < a.points.size(); ++i)
    EXPECT_EQ(length(a.points[i].position - b.points[i].position), 0);
}

// The points that off-mesh links lead to.
std::vector<uint32_t> links_of(const Path& path) {
  std::vector<uint32_t> points;
  for (const PathLink& link : path.links) {
    if (link.kind == LinkKind::kOffMesh) points.push_back(link.point);
  }
  return points;
}

// Finders of both classes over the nodes of a scene.
struct Stage {
  explicit Stage(const Scene& of) : world(bake(of, 0.25, classes())) {
    nodes = need(Nodes::create(world, of, {.size = 1}, context));
  }
  PathFinder finder(int32_t avatar_class) {
    return need(PathFinder::create(
        world,
        {.avatar_class = avatar_class, .space = PathSpace::kNodes, .nodes = nodes, .edits = edits},
        context));
  }
  Place at(double x, double z) { return world.find_place(0, {x, 0, z}, 0.5); }

  Context context;
  World world;
  Nodes nodes;
  Edits edits;
};

TEST(NodeEdits, PathsLeadAroundDearAreasAndComeBack) {
  Stage s(worlds::flat(20));
  for (const int32_t c : {0, 1}) {
    PathFinder finder = s.finder(c);
    const PathQuery query{.from = Vec3d{2, 0, 8}, .to = Vec3d{18, 0, 8}};
    Path before, path;
    finder.find(query, before);
    ASSERT_EQ(before.end, PathEnd::kReached);
    EXPECT_LT(before.cost, 17);
    const EditId area = need(s.edits.add_area(Prism::box({8, -1, -1}, {12, 1, 16}), 4));
    finder.find(query, path);
    expect_same(before, path);
    need(s.edits.set_area_cost(4, 10));
    finder.find(query, path);
    ASSERT_EQ(path.end, PathEnd::kReached);
    EXPECT_GT(path.cost, 23.5);
    EXPECT_LT(path.cost, 28);
    const auto crosses = [&](const Place& point) {
      return point.position.x > 8.5 && point.position.x < 11.5 && point.position.z < 15.5;
    };
    EXPECT_TRUE(std::none_of(path.points.begin(), path.points.end(), crosses));
    // The one that was added last counts.
    const EditId above = need(s.edits.add_area(Prism::box({7, -1, 6}, {13, 1, 10}), 5));
    finder.find(query, path);
    EXPECT_LT(path.cost, 18);
    EXPECT_TRUE(s.edits.remove(above));
    // All across, and closed.
    need(s.edits.set_area_cost(6, kNever));
    const EditId closed = need(s.edits.add_area(Prism::box({8, -1, -1}, {12, 1, 21}), 6));
    finder.find(query, path);
    EXPECT_EQ(path.end, PathEnd::kUnreachable);
    EXPECT_LE(path.points.back().position.x, 8.3);
    EXPECT_EQ(path.blocked_by, Blocker::kClosed);
    EXPECT_EQ(path.blocked_by_edit, closed);
    EXPECT_FALSE(finder.is_free(Vec3d{10, 0, 8}, 0.1));
    const EditId wall = need(s.edits.add_obstacle(Prism::box({8, -1, -1}, {9, 3, 21})));
    finder.find(query, path);
    EXPECT_EQ(path.blocked_by, Blocker::kObstacle);
    EXPECT_EQ(path.blocked_by_edit, wall);
    EXPECT_TRUE(s.edits.remove(wall));
    EXPECT_TRUE(s.edits.remove(closed));
    EXPECT_TRUE(s.edits.set_active(area, false));
    finder.find(query, path);
    expect_same(before, path);
    EXPECT_TRUE(s.edits.remove(area));
    need(s.edits.set_area_cost(4, 1));
    need(s.edits.set_area_cost(6, 1));
    finder.find(query, path);
    expect_same(before, path);
  }
}

TEST(NodeEdits, LinksJoinPlacesInOneDirectionOrBoth) {
  Stage s(worlds::doorway(0.2));  // two rooms
  for (const int32_t c : {0, 1}) {
    PathFinder finder = s.finder(c);
    const PathQuery there{.from = Vec3d{1, 0, 1}, .to = Vec3d{7, 0, 5}};
    const PathQuery back{.from = there.to, .to = there.from};
    Path before, path;
    finder.find(there, before);
    ASSERT_EQ(before.end, PathEnd::kUnreachable);
    EditId link = need(s.edits.add_off_mesh_link({s.at(3, 3), s.at(5, 3), 2.5, false}));
    finder.find(there, path);
    ASSERT_EQ(path.end, PathEnd::kReached);
    const std::vector<uint32_t> links = links_of(path);
    ASSERT_EQ(links.size(), 1u);
    EXPECT_EQ(path.segments[links[0] - 1], SegmentKind::kOffMesh);
    EXPECT_NEAR(path.points[links[0]].position.x, 5, 0.3);
    EXPECT_GT(path.cost, 2.5 + 2 * std::sqrt(8.0) - 0.3);
    EXPECT_LT(path.cost, 2.5 + 2 * std::sqrt(8.0) + 1);
    finder.find(back, path);
    EXPECT_EQ(path.end, PathEnd::kUnreachable);
    EXPECT_FALSE(path.points.empty());
    EXPECT_TRUE(s.edits.remove(link));
    finder.find(there, path);
    expect_same(before, path);
    link = need(s.edits.add_off_mesh_link({s.at(3, 3), s.at(5, 3), 2.5}));
    finder.find(back, path);
    EXPECT_EQ(path.end, PathEnd::kReached);
    // A crate on its end closes it, as long as it stands.
    const EditId crate = need(s.edits.add_obstacle(Prism::box({4.8, 0, 2.8}, {5.2, 1, 3.2})));
    finder.find(there, path);
    EXPECT_EQ(path.end, PathEnd::kUnreachable);
    EXPECT_TRUE(s.edits.remove(crate));
    finder.find(there, path);
    EXPECT_EQ(path.end, PathEnd::kReached);
    EXPECT_TRUE(s.edits.remove(link));
  }
}

TEST(NodeEdits, ALinkMayCostLessThanItsLength) {
  Stage s(worlds::flat(24));
  PathFinder finder = s.finder(1), in_parts = s.finder(1);
  const PathQuery query{.from = Vec3d{1, 0, 2}, .to = Vec3d{23, 0, 2}};
  Path path, parts;
  // Both ends lie off the straight line, so a bound that overestimates would miss it.
  need(s.edits.add_off_mesh_link({s.at(1, 12), s.at(23, 12), 0.5}));
  finder.find(query, path);
  EXPECT_GT(path.cost, 10 + 0.5 + 10 - 0.3);
  EXPECT_LT(path.cost, 21.9);
  EXPECT_EQ(links_of(path).size(), 1u);
  in_parts.begin(query);
  while (!in_parts.advance(7, parts)) continue;
  expect_same(path, parts);
}

TEST(NodeEdits, LinksOfWallsAreForClassesOverNodes) {
  Stage s(worlds::doorway(0.2));
  const NodePlace from = s.finder(1).find_node_place({3, 0, 3}, 1);
  const NodePlace to = s.finder(1).find_node_place({5, 0, 3}, 1);
  ASSERT_TRUE(from && to);
  OffMeshLink link{.cost = 2};
  EXPECT_FALSE(s.edits.add_off_mesh_link(link)) << "it has no ends";
  link.from_on_nodes = from;
  EXPECT_FALSE(s.edits.add_off_mesh_link(link)) << "it leads nowhere";
  link.to_on_nodes = to;
  need(s.edits.add_off_mesh_link(link));
  PathFinder over_nodes = s.finder(1);
  PathFinder on_foot = need(PathFinder::create(s.world, {.edits = s.edits}, s.context));
  const PathQuery query{.from = Vec3d{1, 0, 1}, .to = Vec3d{7, 0, 5}};
  Path path;
  over_nodes.find(query, path);
  EXPECT_EQ(path.end, PathEnd::kReached);
  on_foot.find(query, path);
  EXPECT_EQ(path.end, PathEnd::kUnreachable);
}

TEST(NodeEdits, FindersRefuseNonsense) {
  Context context;
  const Nodes nodes = make_nodes(worlds::flat(6));
  auto finder = need(path::NodeFinder::create(nodes, {}, context));
  const Prism box = Prism::box({1, -1, 1}, {2, 1, 2});
  EXPECT_FALSE(finder.add_area(box, 0));
  EXPECT_FALSE(finder.add_area(box, 64));
  EXPECT_FALSE(finder.add_area(Prism{}, 1));
  EXPECT_FALSE(finder.set_area_cost(0, 2));
  EXPECT_FALSE(finder.set_area_cost(1, 0));
  EXPECT_FALSE(finder.set_area_cost(1, std::nan("")));
  EXPECT_FALSE(finder.add_off_mesh_link({}));
  const NodePlace place = finder.find_place({3, 0, 3}, 1);
  OffMeshLink link{.cost = 1, .from_on_nodes = place, .to_on_nodes = place};
  link.to_on_nodes.node1 = 999999;
  EXPECT_FALSE(finder.add_off_mesh_link(link));
  link.to_on_nodes = place;
  link.cost = -1;
  EXPECT_FALSE(finder.add_off_mesh_link(link));
  // From a place to itself: it changes nothing.
  link.cost = 1;
  EXPECT_TRUE(finder.add_off_mesh_link(link));
  Path path;
  finder.find(place, finder.find_place({1, 0, 1}, 1), path);
  EXPECT_EQ(path.end, PathEnd::kReached);
  EXPECT_TRUE(links_of(path).empty());
}

}  // namespace
}  // namespace throng
