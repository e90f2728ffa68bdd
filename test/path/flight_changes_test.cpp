// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <vector>

#include "core/access.h"
#include "core/random.h"
#include "exact_prism.h"
#include "path/air/flight_endpoints.h"
#include "path/air/flight_finder.h"
#include "path/air/flight_space.h"
#include "path/edits/solid.h"
#include "throng/bake.h"
#include "throng/path.h"
#include "throng/scene.h"

// Obstacles in the air. The oracle works on cells: in which of them a body could touch a prism,
// which of the others are connected, and the whole cylinder along every path.
namespace throng {
namespace {

World bake(const Scene& scene, double cell = 0.2) {
  Context context;
  auto world = bake_world(scene, {.cell = cell, .classes = {flyer_class()}}, context);
  EXPECT_TRUE(world) << world.error().message;
  return *world;
}

path::FlightFinder finder(const World& world) {
  Context context;
  auto made = path::FlightFinder::create(world, {}, context);
  EXPECT_TRUE(made) << made.error().message;
  return *std::move(made);
}

// A floor of 24 m x 8 m.
Scene open_floor() {
  Scene scene;
  scene.add_quad({0, 0, 0}, {0, 0, 8}, {24, 0, 8}, {24, 0, 0});
  scene.add_box({11, 4, 3}, {13, 5, 5});
  return scene;
}

// Two halls of 10 m; through the wall between them one can walk but not fly, with `window` fly,
// too.
Scene two_halls(bool window = false) {
  Scene scene;
  scene.add_quad({0, 0, 0}, {0, 0, 8}, {20, 0, 8}, {20, 0, 0});
  for (const double x : {0.0, 19.8}) scene.add_box({x, -0.1, 0}, {x + 0.2, 6, 8});
  scene.add_box({9.8, -0.1, 0}, {10, 6, 3.45});
  scene.add_box({9.8, -0.1, 4.55}, {10, 6, window ? 5.0 : 8.0});
  scene.add_box({9.8, 2, 3}, {10, 6, 5});
  scene.add_box({0, -0.1, 0}, {20, 6, 0.2});
  scene.add_box({0, -0.1, 7.8}, {20, 6, 8});
  scene.add_box({0, 5.8, 0}, {20, 6, 8});
  return scene;
}

Prism box(Vec3d low, Vec3d high) { return Prism::box(low, high); }

// A room of slabs around a point, whose inside reaches so far from it.
std::vector<Prism> cage(Vec3d p, double half, double up, double thick = 0.3) {
  const Vec3d a{p.x - half, p.y - 0.5, p.z - half}, b{p.x + half, p.y + up, p.z + half};
  const double t = thick;
  return {box({a.x - t, a.y - t, a.z - t}, {a.x, b.y + t, b.z + t}),
          box({b.x, a.y - t, a.z - t}, {b.x + t, b.y + t, b.z + t}),
          box({a.x, a.y - t, a.z - t}, {b.x, b.y + t, a.z}),
          box({a.x, a.y - t, b.z}, {b.x, b.y + t, b.z + t}),
          box({a.x, a.y - t, a.z}, {b.x, a.y, b.z}),
          box({a.x, b.y, a.z}, {b.x, b.y + t, b.z})};
}

// Crates, poles, triangles, slabs from the ground to the ceiling, walls with a hole, cages.
std::vector<Prism> random_prisms(uint64_t seed, double width) {
  std::vector<Prism> all;
  const auto real = [&](uint64_t n, uint64_t i, double low, double high) {
    return low + (high - low) * random_unit(seed, n, i);
  };
  const uint64_t count = 1 + random_below(seed, 99, 0, 6);
  for (uint64_t n = 0; n < count; ++n) {
    const Vec3d p{real(n, 1, 0.5, width - 0.5), real(n, 2, -0.5, 6), real(n, 3, 0.5, 7.5)};
    switch (random_below(seed, n, 0, 6)) {
      case 0:
        all.push_back(box(p, {p.x + real(n, 4, 0.05, 1.5), p.y + real(n, 5, 0.05, 2),
                              p.z + real(n, 6, 0.05, 1.5)}));
        break;
      case 1:
        all.push_back(Prism::circle(p, real(n, 4, 0.1, 3), real(n, 5, 0.1, 4),
                                    3 + static_cast<int>(random_below(seed, n, 6, 6))));
        break;
      case 2:
        all.push_back(box({p.x, -1, -1}, {p.x + real(n, 4, 0.1, 1), 20, real(n, 5, 2, 9)}));
        break;
      case 3: {  // all across, but for a hole
        const double x = p.x + 0.2, y = real(n, 4, 0.5, 2.5), z = real(n, 5, 1, 4.5);
        all.push_back(box({p.x, -1, -1}, {x, y, 9}));
        all.push_back(box({p.x, y + 2.8, -1}, {x, 20, 9}));
        all.push_back(box({p.x, y, -1}, {x, y + 2.8, z}));
        all.push_back(box({p.x, y, z + real(n, 6, 1, 2)}, {x, y + 2.8, 9}));
        break;
      }
      case 4:
        for (const Prism& side : cage(p, real(n, 4, 0.7, 1.6), real(n, 5, 2.3, 4))) {
          all.push_back(side);
        }
        break;
      default:  // blocks nothing
        all.push_back(box({p.x + 200, p.y, p.z}, {p.x + 201, p.y + 1, p.z + 1}));
    }
  }
  return all;
}

// The cells of the air of a finder as it is now, and their connected components.
class Cells {
 public:
  explicit Cells(const World& world, const path::FlightFinder& flight)
      : space_(flight.space()), ends_(*data_of(world), flight.space(), 0) {
    const int32_t layers = space_.shape.ceiling - space_.shape.floor;
    label_.assign(static_cast<size_t>(space_.width * space_.depth * layers), -1);
    for_all([&](int32_t x, int32_t y, int32_t z) {
      if (flight.is_legal(middle(x, y, z))) label_[at(x, y, z)] = 0;
    });
    int32_t next = 0;
    std::vector<std::array<int32_t, 3>> queue;
    for_all([&](int32_t x, int32_t y, int32_t z) {
      if (label_[at(x, y, z)] != 0) return;
      label_[at(x, y, z)] = ++next;
      queue.assign(1, {x, y, z});
      while (!queue.empty()) {
        const auto [a, b, c] = queue.back();
        queue.pop_back();
        constexpr int32_t kSides[6][3] = {{1, 0, 0},  {-1, 0, 0}, {0, 1, 0},
                                          {0, -1, 0}, {0, 0, 1},  {0, 0, -1}};
        for (const auto& side : kSides) {
          const int32_t i = a + side[0], j = b + side[1], k = c + side[2];
          if (!is_in(i, j, k) || label_[at(i, j, k)] != 0) continue;
          label_[at(i, j, k)] = next;
          queue.push_back({i, j, k});
        }
      }
    });
  }

  template <class Visit>
  void for_all(Visit visit) const {
    for (int32_t y = space_.shape.floor; y < space_.shape.ceiling; ++y) {
      for (int32_t z = 0; z < space_.depth; ++z) {
        for (int32_t x = 0; x < space_.width; ++x) visit(x, y, z);
      }
    }
  }
  [[nodiscard]] Vec3d corner(int32_t x, int32_t y, int32_t z) const {
    return ends_.to_metres(
        {static_cast<double>(x), static_cast<double>(y), static_cast<double>(z)});
  }
  [[nodiscard]] Vec3d middle(int32_t x, int32_t y, int32_t z) const {
    return ends_.to_metres({x + 0.5, y + 0.5, z + 0.5});
  }
  [[nodiscard]] double side() const { return space_.shape.cell * 1e-3; }
  /// -1: no body may be there.
  [[nodiscard]] int32_t label(Vec3d feet) const {
    const path::AirPoint p = ends_.to_air(feet);
    const auto x = static_cast<int32_t>(std::floor(p.x)), y = static_cast<int32_t>(std::floor(p.y)),
               z = static_cast<int32_t>(std::floor(p.z));
    return is_in(x, y, z) ? label_[at(x, y, z)] : -1;
  }
  [[nodiscard]] int32_t label(int32_t x, int32_t y, int32_t z) const { return label_[at(x, y, z)]; }
  /// How near cells of a label come to a point; of all, if it is 0.
  [[nodiscard]] double nearest(int32_t label, Vec3d goal) const {
    double least = HUGE_VAL;
    for_all([&](int32_t x, int32_t y, int32_t z) {
      const int32_t own = label_[at(x, y, z)];
      if (own < 1 || (label != 0 && own != label)) return;
      const Vec3d low = corner(x, y, z);
      const auto off = [&](double v, double from) {
        return std::max({from - v, v - from - side(), 0.0});
      };
      least = std::min(least,
                       length(Vec3d{off(goal.x, low.x), off(goal.y, low.y), off(goal.z, low.z)}));
    });
    return least;
  }

 private:
  [[nodiscard]] bool is_in(int32_t x, int32_t y, int32_t z) const {
    return x >= 0 && z >= 0 && x < space_.width && z < space_.depth && y >= space_.shape.floor &&
           y < space_.shape.ceiling;
  }
  [[nodiscard]] size_t at(int32_t x, int32_t y, int32_t z) const {
    return static_cast<size_t>(((y - space_.shape.floor) * space_.depth + z) * space_.width + x);
  }

  const path::FlightSpace& space_;
  path::FlightEndpoints ends_;
  std::vector<int32_t> label_;
};

// Places on a path where the body touches a prism.
int faults(const std::vector<Prism>& prisms, const Path& path) {
  const AvatarClass avatar = flyer_class();
  int found = 0;
  const auto look = [&](Vec3d feet, double low, double high) {
    for (const Prism& prism : prisms) {
      found += test::is_touched(prism, feet.x, feet.z, low, high, avatar.radius) ? 1 : 0;
    }
  };
  for (size_t i = 1; i < path.points.size(); ++i) {
    const Vec3d a = path.points[i - 1].position, b = path.points[i].position;
    const SegmentKind kind = path.segments[i - 1];
    if (kind == SegmentKind::kTakeOff || kind == SegmentKind::kLand) {
      const Vec3d &low = kind == SegmentKind::kTakeOff ? a : b,
                  &high = kind == SegmentKind::kTakeOff ? b : a;
      look(high, std::min(low.y + body_bottom(avatar), high.y), high.y + avatar.height);
      continue;
    }
    const double under = kind == SegmentKind::kWalk ? body_bottom(avatar) : 0;
    const auto steps = static_cast<int>(length(b - a) / 0.05) + 1;
    for (int s = 0; s <= steps; ++s) {
      const Vec3d feet = a + (b - a) * (static_cast<double>(s) / steps);
      look(feet, feet.y + under, feet.y + avatar.height);
    }
  }
  return found;
}

std::vector<path::ChangeId> put_up(path::FlightFinder& flight, const std::vector<Prism>& prisms) {
  std::vector<path::ChangeId> ids;
  for (const Prism& prism : prisms) {
    ids.push_back(flight.add_obstacle({prism}));
  }
  return ids;
}

void expect_same(const Path& a, const Path& b) {
  EXPECT_EQ(a.end, b.end);
  EXPECT_EQ(a.length, b.length);
  EXPECT_EQ(a.blocked_by, b.blocked_by);
  EXPECT_EQ(a.segments, b.segments);
  ASSERT_EQ(a.points.size(), b.points.size());
  for (size_t i = 0; i < a.points.size(); ++i)
    EXPECT_EQ(length(a.points[i].position - b.points[i].position), 0);
}

// Ends for queries, in the air and on the ground, whatever stands there.
Vec3d end_of(const World& world, const path::FlightFinder& baked, uint64_t seed, uint64_t n) {
  if (n % 3 == 0) return world.random_place(0, seed, n).position;
  return *baked.random_point(seed, n);
}

TEST(FlightChanges, CellsAreClosedWhereABodyCouldTouchThePrismAndNowhereElse) {
  const World world = bake(open_floor());
  const path::FlightFinder baked = finder(world);
  const Cells before(world, baked);
  const AvatarClass avatar = flyer_class();
  uint64_t closed = 0, open = 0;
  for (uint64_t seed = 0; seed < 6; ++seed) {
    const std::vector<Prism> prisms = random_prisms(seed, 24);
    path::FlightFinder flight = baked;
    put_up(flight, prisms);
    const Cells now(world, flight);
    now.for_all([&](int32_t x, int32_t y, int32_t z) {
      const bool is_open = now.label(x, y, z) > 0;
      if (before.label(x, y, z) < 0) {
        ASSERT_FALSE(is_open);
        return;
      }
      const Vec3d low = now.corner(x, y, z);
      constexpr int kSteps = 8;
      const double step = now.side() / kSteps;
      bool must_close = false, may_close = false;
      for (const Prism& prism : prisms) {
        if (prism.high < low.y - 0.01 || prism.low > low.y + now.side() + avatar.height + 0.01) {
          continue;
        }
        double least = HUGE_VAL;
        for (int i = 0; i <= kSteps * (kSteps + 2); ++i) {
          least = std::min(least, test::plan_distance(prism, low.x + i % (kSteps + 1) * step,
                                                      low.z + i / (kSteps + 1) * step));
        }
        const bool meets = prism.high > low.y && prism.low < low.y + now.side() + avatar.height;
        must_close |= meets && least < avatar.radius;
        may_close |= least - step < avatar.radius + 0.004;
      }
      if (must_close) {
        ASSERT_FALSE(is_open) << seed << ": " << x << ", " << y << ", " << z;
        ++closed;
      }
      if (!may_close) {
        ASSERT_TRUE(is_open) << seed << ": " << x << ", " << y << ", " << z;
        ++open;
      }
    });
  }
  EXPECT_GT(closed, 1000u);
  EXPECT_GT(open, 1000u);
}

TEST(FlightChanges, PathsExistWhereCellsAreConnectedAndNoBodyTouchesAPrism) {
  uint64_t reached = 0, parted = 0, nearest = 0, on_ground = 0;
  for (const Scene& scene : {open_floor(), two_halls(), two_halls(true)}) {
    const World world = bake(scene);
    const path::FlightFinder baked = finder(world);
    for (uint64_t seed = 0; seed < 20; ++seed) {
      const std::vector<Prism> prisms = random_prisms(seed, 20);
      path::FlightFinder flight = baked;
      put_up(flight, prisms);
      const Cells cells(world, flight);
      Path path;
      for (uint64_t n = 0; n < 30; ++n) {
        const Vec3d from = end_of(world, baked, seed, 2 * n),
                    to = end_of(world, baked, seed, 5 * n + 1);
        const int32_t a = cells.label(from), b = cells.label(to);
        flight.find({.from = from, .to = to, .vertical_tolerance = 0.05, .by_turns = n % 2 == 0},
                    path);
        ASSERT_EQ(faults(prisms, path), 0) << seed << ", " << n;
        if (a > 0 && b > 0) {
          if (a == b) {
            ASSERT_EQ(path.end, PathEnd::kReached) << seed << ", " << n;
            ++reached;
          } else if (n % 2 == 1) {
            ASSERT_EQ(path.end, PathEnd::kUnreachable) << seed << ", " << n;
            ++parted;
          }
        }
        if (path.end == PathEnd::kReached) {
          ASSERT_LT(length(path.points.front().position - from), 0.1);
          ASSERT_LT(length(path.points.back().position - to), 0.1);
          if (path.segments.empty() || path.segments.front() != SegmentKind::kFly) ++on_ground;
        }
        if (path.end == PathEnd::kUnreachable && a > 0) {
          ASSERT_FALSE(path.points.empty()) << seed << ", " << n;
          ASSERT_NE(path.blocked_by, Blocker::kNone);
          const double far = length(path.points.back().position - to);
          ASSERT_LT(far, cells.nearest(a, to) + 0.002) << seed << ", " << n;
          ASSERT_GT(far, cells.nearest(0, to) - 0.002);
          ++nearest;
        }
      }
    }
  }
  EXPECT_GT(reached, 200u);
  EXPECT_GT(parted, 30u);
  EXPECT_GT(nearest, 60u);
  EXPECT_GT(on_ground, 60u);
}

TEST(FlightChanges, RemovedObstaclesLeaveNoTraceAndTheOrderDoesNotMatter) {
  const World world = bake(two_halls(true));
  path::FlightFinder baked = finder(world);
  path::FlightFinder used = baked;
  Path a, b;
  for (uint64_t seed = 20; seed < 28; ++seed) {
    const std::vector<Prism> prisms = random_prisms(seed, 20);
    std::vector<Prism> shuffled = prisms;
    for (size_t i = shuffled.size(); i > 1; --i) {
      std::swap(shuffled[i - 1], shuffled[random_below(seed, i, 7, i)]);
    }
    path::FlightFinder rebuilt = baked;
    std::vector<path::ChangeId> ids = put_up(used, prisms);
    // Some are removed, and come back.
    for (const path::ChangeId id : ids) {
      EXPECT_TRUE(used.set_active(id, id % 2 != 0));
    }
    for (const path::ChangeId id : ids) EXPECT_TRUE(used.set_active(id, true));
    put_up(rebuilt, shuffled);
    for (uint64_t n = 0; n < 20; ++n) {
      const path::FlightQuery query{.from = end_of(world, baked, seed, 2 * n),
                                    .to = end_of(world, baked, seed, 5 * n + 1)};
      used.find(query, a);
      rebuilt.find(query, b);
      expect_same(a, b);
    }
    // In another order than they came.
    for (size_t i = 0; i < ids.size(); ++i) {
      const size_t last = ids.size() - 1 - i;
      std::swap(ids[last], ids[random_below(seed, i, 8, last + 1)]);
      EXPECT_TRUE(used.remove(ids[last]));
      EXPECT_FALSE(used.remove(ids[last]));
      EXPECT_FALSE(used.set_active(ids[last], true));
    }
    for (uint64_t n = 0; n < 20; ++n) {
      const path::FlightQuery query{.from = end_of(world, baked, seed, 2 * n),
                                    .to = end_of(world, baked, seed, 5 * n + 1)};
      used.find(query, a);
      baked.find(query, b);
      expect_same(a, b);
      EXPECT_EQ(a.nodes, b.nodes);
    }
  }
}

// What is left of the obstacles must cut off just what they do, whatever was there in between.
TEST(FlightChanges, ClosedAndReopenedRoomsAreKnown) {
  const World world = bake(open_floor());
  const path::FlightFinder baked = finder(world);
  path::FlightFinder flight = baked;
  Path path;
  std::vector<Prism> prisms;
  for (uint64_t n = 0; n < 5; ++n) {
    for (const Prism& side : cage({3.0 + 4 * static_cast<double>(n), 2, 4}, 1.5, 4)) {
      prisms.push_back(side);
    }
  }
  const std::vector<path::ChangeId> ids = put_up(flight, prisms);
  std::vector<bool> up(ids.size(), true);
  uint64_t shut = 0;
  for (uint64_t n = 0; n < 60; ++n) {
    // Two are removed, then two come back, so that most rooms are closed.
    const auto down = static_cast<size_t>(std::find(up.begin(), up.end(), false) - up.begin());
    const size_t any = random_below(3, n, 0, ids.size());
    const size_t i = n % 4 >= 2 && down < up.size() ? down : any;
    up[i] = !up[i];
    ASSERT_TRUE(flight.set_active(ids[i], up[i]));
    const Cells cells(world, flight);
    for (uint64_t k = 0; k < 5; ++k) {
      const Vec3d from{3.0 + 4 * static_cast<double>(k), 2.5, 4};
      const Vec3d to{3.0 + 4 * static_cast<double>((k + n) % 5), 7.5, 4};
      const int32_t a = cells.label(from), b = cells.label(to);
      if (a < 1 || b < 1) continue;
      flight.find({.from = from, .to = to, .by_turns = false}, path);
      ASSERT_EQ(path.end == PathEnd::kReached, a == b) << n << ", " << k;
      shut += a != b ? 1 : 0;
      // Reported at once: nothing is expanded but the path to what comes nearest.
      ASSERT_TRUE(a == b || path.nodes < 300);
    }
  }
  EXPECT_GT(shut, 20u);
}

TEST(FlightChanges, AtAnyTimeAnswersAreThoseOfANewFinder) {
  uint64_t open = 0, shut = 0;
  for (uint64_t seed = 1; seed < 4; ++seed) {
    const World world = bake(seed % 2 != 0 ? open_floor() : two_halls(true));
    const path::FlightFinder baked = finder(world);
    path::FlightFinder flight = baked;
    Path path, other;
    std::vector<Prism> prisms;
    for (uint64_t k = 0; k < 6; ++k) {
      const std::vector<Prism> more = random_prisms(seed * 100 + k, 20);
      prisms.insert(prisms.end(), more.begin(), more.end());
    }
    const std::vector<path::ChangeId> ids = put_up(flight, prisms);
    std::vector<bool> up(ids.size(), true);
    for (uint64_t n = 0; n < 12; ++n) {
      for (uint64_t m = 0; m < 3; ++m) {
        const auto i = static_cast<size_t>(random_below(seed, n, m, ids.size()));
        up[i] = !up[i];
        ASSERT_TRUE(flight.set_active(ids[i], up[i]));
      }
      std::vector<Prism> standing;
      for (size_t i = 0; i < ids.size(); ++i) {
        if (up[i]) standing.push_back(prisms[i]);
      }
      path::FlightFinder rebuilt = baked;
      put_up(rebuilt, standing);
      const Cells cells(world, flight);
      for (uint64_t k = 0; k < 12; ++k) {
        const auto from = flight.random_point(seed, 100 * n + 2 * k);
        const auto to = flight.random_point(seed, 100 * n + 2 * k + 1);
        ASSERT_TRUE(from && to);
        const bool together = cells.label(*from) == cells.label(*to);
        flight.find({.from = *from, .to = *to, .by_turns = false, .nearest = false}, path);
        ASSERT_EQ(path.end, together ? PathEnd::kReached : PathEnd::kUnreachable);
        ASSERT_TRUE(together || path.nodes == 0) << "it was not reported at once";
        (together ? open : shut) += 1;
        flight.find({.from = *from, .to = *to}, path);
        rebuilt.find({.from = *from, .to = *to}, other);
        expect_same(path, other);
        ASSERT_EQ(faults(standing, path), 0);
      }
    }
  }
  EXPECT_GT(open, 50u);
  EXPECT_GT(shut, 50u);
}

TEST(FlightChanges, EndsInAnObstacleAreNoPlacesAndPathsLeadAroundAWall) {
  const World world = bake(open_floor());
  path::FlightFinder flight = finder(world);
  const Vec3d here{3, 3, 4}, there{21, 3, 4};
  Path path;
  flight.find({.from = here, .to = there}, path);
  ASSERT_EQ(path.end, PathEnd::kReached);
  const double straight = path.length;
  const Prism wall = box({7, -1, -1}, {7.2, 7, 6});
  const path::ChangeId id = flight.add_obstacle({wall});
  flight.find({.from = here, .to = there}, path);
  ASSERT_EQ(path.end, PathEnd::kReached);
  EXPECT_EQ(faults({wall}, path), 0);
  EXPECT_GT(path.length, straight + 0.2);
  EXPECT_LT(path.length, straight + 4);
  EXPECT_FALSE(flight.is_legal({7.1, 3, 4}));
  EXPECT_FALSE(flight.take_off(world.find_place(0, {7.1, 0, 4}, 0.2)));
  EXPECT_FALSE(flight.landing({7.1, 3, 4}));
  for (const Vec3d bad : {Vec3d{7.1, 3, 4}, Vec3d{7.1, 0, 4}}) {
    flight.find({.from = here, .to = bad}, path);
    EXPECT_EQ(path.end, PathEnd::kNoPlace);
    flight.find({.from = bad, .to = here}, path);
    EXPECT_EQ(path.end, PathEnd::kNoPlace);
  }
  path::FlightFinder copy = flight;
  ASSERT_TRUE(flight.remove(id));
  EXPECT_TRUE(flight.is_legal({7.1, 3, 4}));
  EXPECT_FALSE(copy.is_legal({7.1, 3, 4}));
  flight.find({.from = here, .to = there}, path);
  EXPECT_EQ(path.length, straight);
}

// Over the ground, as well: a wall of which one cannot fly over the end.
TEST(FlightChanges, WalksAndTakeOffsAvoidThemToo) {
  const World world = bake(open_floor());
  path::FlightFinder flight = finder(world);
  const std::vector<Prism> prisms{box({7, 0, -1}, {7.2, 3, 6}), box({2, 1.9, 1}, {6, 2.2, 7})};
  put_up(flight, prisms);
  Path path;
  for (const Vec3d to : {Vec3d{10, 0, 4}, Vec3d{10, 4, 4}, Vec3d{4, 0, 1.5}}) {
    flight.find({.from = {4, 0, 4}, .to = to}, path);
    ASSERT_EQ(path.end, PathEnd::kReached);
    EXPECT_EQ(path.segments.front(), SegmentKind::kWalk);  // it stands under a table
    EXPECT_EQ(faults(prisms, path), 0);
  }
}

TEST(FlightChanges, GroundBetweenTwoComponentsOfAirIsLeftOutUnderAnObstacle) {
  const World world = bake(two_halls());
  path::FlightFinder flight = finder(world);
  const path::FlightQuery query{.from = {3, 2, 4}, .to = {16, 3, 3}};
  Path path;
  flight.find(query, path);
  ASSERT_EQ(path.end, PathEnd::kReached);
  // The path lands elsewhere than where a crate is, and leads around it.
  const std::vector<Prism> crates{box({8, 0, 3.4}, {8.6, 1, 5}),
                                  box({11.5, 0, 3.4}, {12.5, 3, 4.4})};
  std::vector<path::ChangeId> ids = put_up(flight, crates);
  flight.find(query, path);
  ASSERT_EQ(path.end, PathEnd::kReached);
  EXPECT_EQ(faults(crates, path), 0);
  const path::ChangeId door = flight.add_obstacle({box({9.7, 0, 3}, {10.1, 3, 5})});
  flight.find(query, path);
  ASSERT_EQ(path.end, PathEnd::kUnreachable);
  ASSERT_FALSE(path.points.empty());
  EXPECT_NEAR(path.points.back().position.x, 9.1, 0.5);
  flight.set_active(door, false);
  flight.find(query, path);
  EXPECT_EQ(path.end, PathEnd::kReached);
}

// Air that an obstacle has cut in two, over a floor that leads under it.
TEST(FlightChanges, UnderACurtainPathsWalk) {
  const World world = bake(two_halls(true));
  path::FlightFinder flight = finder(world);
  const Prism curtain = box({9.7, 2.0, 4.5}, {10.1, 6, 8});
  const Prism low = box({9.7, -0.5, 5.6}, {10.1, 3, 8});
  put_up(flight, {curtain, low});
  Path path;
  flight.find({.from = {3, 2, 4}, .to = {16, 3, 3}}, path);
  ASSERT_EQ(path.end, PathEnd::kReached);
  EXPECT_NE(std::count(path.segments.begin(), path.segments.end(), SegmentKind::kLand), 0);
  EXPECT_NE(std::count(path.segments.begin(), path.segments.end(), SegmentKind::kTakeOff), 0);
  EXPECT_EQ(faults({curtain, low}, path), 0);
}

TEST(FlightChanges, ABoxedInGoalIsReportedWithTheNearestPoint) {
  const World world = bake(open_floor());
  path::FlightFinder flight = finder(world);
  const Vec3d goal{18, 3, 4};
  put_up(flight, cage(goal, 1.2, 3));
  ASSERT_TRUE(flight.is_legal(goal));
  Path path;
  for (const Vec3d from : {Vec3d{3, 3, 4}, Vec3d{3, 0, 4}}) {
    flight.find({.from = from, .to = goal}, path);
    ASSERT_EQ(path.end, PathEnd::kUnreachable);
    EXPECT_EQ(path.blocked_by, Blocker::kObstacle);
    EXPECT_NE(path.blocked_by_edit, 0u);
    ASSERT_GE(path.points.size(), 2u);
    EXPECT_LT(length(path.points.back().position - goal), 3.5);
  }
  flight.find({.from = goal, .to = {3, 3, 4}}, path);
  ASSERT_EQ(path.end, PathEnd::kUnreachable);
  ASSERT_FALSE(path.points.empty());
  EXPECT_LT(length(path.points.back().position - goal), 1.2);
  // It keeps to its budget.
  flight.find({.from = {15, 3, 4}, .to = {21, 3, 4}, .budget = 2}, path);
  EXPECT_EQ(path.end, PathEnd::kBudgetExhausted);
}

// Two halves too large to flood when the wall comes: a search decides, and how near it comes.
TEST(FlightChanges, AWallThroughALargeWorldIsFoundBySearching) {
  VoxelCells cells{.width = 96, .height = 32, .depth = 64, .filled = {}};
  for (int32_t x = 0; x < cells.width; ++x) {
    for (int32_t y = 0; y < cells.height; ++y) {
      for (int32_t z = 0; z < cells.depth; ++z) {
        const auto n = static_cast<uint64_t>((x * cells.height + y) * cells.depth + z);
        if (random_below(1, n, 0, 3) == 0) cells.filled.push_back({x, y, z});
      }
    }
  }
  const auto world = bake_voxel_cells(cells, 1);
  ASSERT_TRUE(world) << world.error().message;
  path::FlightFinder flight = finder(*world);
  ASSERT_GT(flight.summary().boxes, 90'000u);
  const path::FlightEndpoints ends(*data_of(*world), flight.space(), 0);
  const auto component_of = [&](Vec3d p) {
    const uint32_t at = flight.space().box_at(ends.to_air(p));
    return at == path::kNoBox ? path::kNoBox : flight.space().component[at];
  };
  std::vector<Vec3d> left, right;
  const uint32_t most = component_of([&] {
    for (uint64_t n = 0;; ++n) {
      const Vec3d p = *flight.random_point(4, n);
      if (std::count(flight.space().component.begin(), flight.space().component.end(),
                     component_of(p)) > 50'000) {
        return p;
      }
    }
  }());
  for (uint64_t n = 0; left.size() < 4 || right.size() < 4; ++n) {
    const Vec3d p = *flight.random_point(5, n);
    if (component_of(p) != most) continue;
    if (p.x < 40 && left.size() < 4) left.push_back(p);
    if (p.x > 56 && right.size() < 4) right.push_back(p);
  }
  Path path;
  flight.find({.from = left[0], .to = right[0]}, path);
  ASSERT_EQ(path.end, PathEnd::kReached);
  const path::ChangeId wall = flight.add_obstacle({box({48.2, -10, -10}, {48.4, 60, 90})});
  int stopped_by_wall = 0;
  for (size_t i = 0; i < 4; ++i) {
    for (const auto& [from, to] : {std::pair{left[i], right[i]}, std::pair{right[i], left[i]}}) {
      flight.find({.from = from, .to = to}, path);
      ASSERT_EQ(path.end, PathEnd::kUnreachable);
      ASSERT_FALSE(path.points.empty());
      // A pillar may stand between the nearest point and the wall.
      EXPECT_TRUE(path.blocked_by == Blocker::kObstacle || path.blocked_by == Blocker::kNarrow);
      EXPECT_EQ(path.blocked_by_edit, path.blocked_by == Blocker::kObstacle ? wall : 0);
      stopped_by_wall += path.blocked_by == Blocker::kObstacle;
      for (const Place& p : path.points) EXPECT_EQ(p.position.x < 48.3, from.x < 48.3);
      // Beyond the wall it would be nearer; on this side it comes close to it.
      EXPECT_NEAR(path.points.back().position.x, 48.3, 5);
    }
  }
  EXPECT_GT(stopped_by_wall, 0);
  flight.find({.from = left[0], .to = right[0], .budget = 500}, path);
  EXPECT_EQ(path.end, PathEnd::kBudgetExhausted);
  const std::atomic<bool> cancel = true;
  flight.find({.from = left[0], .to = right[0], .budget = {UINT64_MAX, &cancel}}, path);
  EXPECT_EQ(path.end, PathEnd::kBudgetExhausted);
  flight.remove(wall);
  flight.find({.from = left[0], .to = right[0]}, path);
  EXPECT_EQ(path.end, PathEnd::kReached);
}

TEST(FlightChanges, TrianglesAreObstaclesAndBlockOnlyWhatTheyCover) {
  const World world = bake(open_floor());
  path::FlightFinder flight = finder(world);
  // A sail from the floor on one side up to 6 m on the other.
  const std::array<Vec3d, 3> corners{Vec3d{8, 0, 0}, Vec3d{8, 0, 8}, Vec3d{14, 6, 8}};
  const std::array<std::array<uint32_t, 3>, 1> triangles{{{0, 1, 2}}};
  const path::ChangeId id = flight.add_obstacle(*path::make_solid(corners, triangles));
  EXPECT_FALSE(flight.is_legal({8.5, 0.5, 6}));
  EXPECT_FALSE(flight.is_legal({12, 3, 6.5}));
  EXPECT_TRUE(flight.is_legal({13, 1, 2}));      // beside it
  EXPECT_TRUE(flight.is_legal({8.5, 3, 6}));     // over it
  EXPECT_TRUE(flight.is_legal({12.6, 1, 6.6}));  // under it
  Path path;
  flight.find({.from = {4, 1, 7}, .to = {12.6, 1, 6.6}}, path);
  EXPECT_EQ(path.end, PathEnd::kReached);
  flight.remove(id);
  EXPECT_TRUE(flight.is_legal({12, 3, 6.5}));
}

TEST(FlightChanges, UnknownOnesAreNoChanges) {
  const World world = bake(open_floor());
  path::FlightFinder flight = finder(world);
  EXPECT_FALSE(flight.remove(1));
  EXPECT_FALSE(flight.set_active(0, true));
  EXPECT_TRUE(flight.is_legal({1.5, 1.5, 1.5}));
  EXPECT_FALSE(flight.remove(1));
}

TEST(FlightChanges, RandomPointsAreLegal) {
  const World world = bake(open_floor());
  const path::FlightFinder baked = finder(world);
  path::FlightFinder flight = baked;
  put_up(flight, {box({4, -1, -1}, {30, 40, 10})});
  uint64_t same = 0;
  for (uint64_t n = 0; n < 500; ++n) {
    const auto point = flight.random_point(1, n);
    ASSERT_TRUE(point && flight.is_legal(*point));
    same += length(*point - *baked.random_point(1, n)) == 0 ? 1 : 0;
  }
  EXPECT_GT(same, 20u);
  EXPECT_LT(same, 200u);
  // All but a corner; and that.
  put_up(flight, {box({-5, -1, -1}, {3.9, 40, 7.2})});
  for (uint64_t n = 0; n < 20; ++n) {
    const auto point = flight.random_point(1, n);
    ASSERT_TRUE(!point || flight.is_legal(*point));
  }
  put_up(flight, {box({-50, -50, -50}, {50, 50, 50})});
  EXPECT_FALSE(flight.random_point(1, 0));
}

}  // namespace
}  // namespace throng
