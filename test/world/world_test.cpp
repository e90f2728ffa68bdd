// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "throng/world.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "core/random.h"
#include "throng/bake.h"
#include "throng/scene.h"
#include "worlds.h"

// Look-ups and moves against the levels' plain content.
namespace throng {
namespace {

World bake(const Scene& scene, double cell, double zone = 160) {
  Context context;
  const auto world = bake_world(scene, {.cell = cell, .zone = zone}, context);
  EXPECT_TRUE(world) << world.error().message;
  return world ? *world : World{};
}

World garage() {
  const auto scene = create_builtin_world({.name = "garage"});
  EXPECT_TRUE(scene);
  return scene ? bake(*scene, 0.2, 25.6) : World{};
}

// All levels, by tile.
class Content {
 public:
  explicit Content(const World& world) : summary_(world.summary()) {
    for (uint32_t l = 0; l < world.level_tile_count(); ++l) {
      levels_.push_back(world.level_tile(l));
      of_tile_[{levels_.back().tile_x, levels_.back().tile_z}].push_back(l);
    }
  }

  struct Cell {
    int64_t x, z;  // of the world's grid
    double u, v;   // within it, 0 to 1
  };
  [[nodiscard]] Cell cell_of(double x, double z) const {
    const double gx = (x - summary_.origin.x) / summary_.cell;
    const double gz = (z - summary_.origin.z) / summary_.cell;
    const double fx = std::floor(gx), fz = std::floor(gz);
    return {static_cast<int64_t>(fx), static_cast<int64_t>(fz), gx - fx, gz - fz};
  }

  [[nodiscard]] std::vector<uint32_t> levels_at(int64_t x, int64_t z) const {
    const auto found = of_tile_.find({static_cast<int32_t>(x >> 6), static_cast<int32_t>(z >> 6)});
    return found == of_tile_.end() ? std::vector<uint32_t>{} : found->second;
  }
  [[nodiscard]] bool is_legal(uint32_t level, int32_t avatar_class, int64_t x, int64_t z) const {
    const LevelTileContent& l = levels_[level];
    if (l.tile_x != x >> 6 || l.tile_z != z >> 6) return false;
    return l.clearance[static_cast<size_t>(avatar_class)][index(x, z)] != 0;
  }
  [[nodiscard]] int32_t floor(uint32_t level, int64_t x, int64_t z) const {
    return levels_[level].floor[index(x, z)];
  }
  [[nodiscard]] size_t size() const { return levels_.size(); }
  [[nodiscard]] const LevelTileContent& level(size_t i) const { return levels_[i]; }

  // On the plane that the gentler rises around the cell suggest. [m]
  [[nodiscard]] double feet(uint32_t level, const Cell& c) const {
    const auto x = static_cast<int32_t>(c.x & 63), z = static_cast<int32_t>(c.z & 63);
    const auto at = [&](int32_t i, int32_t k) {
      const int32_t f = levels_[level].floor[static_cast<size_t>(k * 64 + i)];
      return f == kNoFloor ? std::nan("") : f;
    };
    const auto gentler = [](double a, double b, double d) {
      const double first = b - a, second = d - b;
      if (!(first * second > 0)) return 0.0;
      return std::fabs(first) < std::fabs(second) ? first : second;
    };
    const int32_t ix = std::clamp(x, 1, 62), iz = std::clamp(z, 1, 62);
    const double gx = gentler(at(ix - 1, z), at(ix, z), at(ix + 1, z));
    const double gz = gentler(at(x, iz - 1), at(x, iz), at(x, iz + 1));
    return (at(x, z) + gx * (c.u - 0.5) + gz * (c.v - 0.5)) / 1000;
  }

 private:
  static size_t index(int64_t x, int64_t z) {
    return static_cast<size_t>((z & 63) * 64 + (x & 63));
  }

  WorldSummary summary_;
  std::vector<LevelTileContent> levels_;
  std::map<std::pair<int32_t, int32_t>, std::vector<uint32_t>> of_tile_;
};

// A place stands on a legal cell of its level, on the level's surface.
void expect_sound(const World& world, const Content& content, int32_t avatar_class,
                  const Place& place) {
  ASSERT_TRUE(place);
  const auto cell = content.cell_of(place.position.x, place.position.z);
  ASSERT_TRUE(content.is_legal(place.level1 - 1, avatar_class, cell.x, cell.z));
  ASSERT_NEAR(place.position.y, content.feet(place.level1 - 1, cell), 0.00151);
  ASSERT_EQ(world.feet(place), place.position.y);
}

bool same(const Place& a, const Place& b) {
  return a.level1 == b.level1 && a.position == b.position;
}

TEST(World, FindPlaceIsTheNearestLegalFloorOfTheColumn) {
  const World world = garage();
  const Content content(world);
  const WorldSummary summary = world.summary();
  int32_t found = 0, nowhere = 0;
  for (uint64_t n = 0; n < 20000; ++n) {
    const auto c = static_cast<int32_t>(n % summary.classes.size());
    const auto between = [&](uint64_t i, double low, double high) {
      return low + (high - low) * random_unit(4, n, i);
    };
    const Vec3d at{between(0, summary.bounds.min.x - 1, summary.bounds.max.x + 1),
                   between(1, -2, 12),
                   between(2, summary.bounds.min.z - 1, summary.bounds.max.z + 1)};
    const double reach = between(3, 0, 4);
    const auto cell = content.cell_of(at.x, at.z);
    double nearest = std::numeric_limits<double>::infinity();
    for (const uint32_t level : content.levels_at(cell.x, cell.z)) {
      if (!content.is_legal(level, c, cell.x, cell.z)) continue;
      nearest = std::min(nearest, std::fabs(content.feet(level, cell) - at.y));
    }
    const Place place = world.find_place(c, at, reach);
    if (std::fabs(nearest - reach) < 0.002) continue;  // on the edge
    ASSERT_EQ(static_cast<bool>(place), nearest < reach) << n;
    if (!place) {
      ++nowhere;
      continue;
    }
    ++found;
    ASSERT_NO_FATAL_FAILURE(expect_sound(world, content, c, place)) << n;
    ASSERT_NEAR(std::fabs(place.position.y - at.y), nearest, 0.00151) << n;
    ASSERT_EQ(place.position.x, at.x);
    ASSERT_EQ(place.position.z, at.z);
  }
  EXPECT_GT(found, 3000);
  EXPECT_GT(nowhere, 3000);
}

TEST(World, FindPlaceOutsideOfEverythingIsNowhere) {
  const World world = bake(worlds::flat(5), 0.1);
  const double inf = std::numeric_limits<double>::infinity();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  ASSERT_TRUE(world.find_place(0, {2.5, 0, 2.5}, 0));
  for (const Vec3d& at : {Vec3d{nan, 0, 2},
                          {2, nan, 2},
                          {2, 0, nan},
                          {inf, 0, 2},
                          {2, 0, -inf},
                          {1e300, 0, 2},
                          {2, 0, -1e300},
                          {-0.1, 0, 2},
                          {2, 0, 5.1}}) {
    EXPECT_FALSE(world.find_place(0, at, 1e9)) << at.x << " " << at.z;
  }
  for (const int32_t c : {-1, 4, 1000}) {
    EXPECT_FALSE(world.find_place(c, {2.5, 0, 2.5}, 1)) << c;
    EXPECT_FALSE(world.random_place(c, 1, 1)) << c;
  }
  EXPECT_FALSE(world.find_place(0, {2.5, 0.01, 2.5}, 0.009));
}

// How far counts are from even, in standard deviations of the chi-square statistic.
double unevenness(const std::vector<int32_t>& counts, const std::vector<double>& expected) {
  double chi = 0;
  for (size_t i = 0; i < counts.size(); ++i) {
    const double off = counts[i] - expected[i];
    chi += off * off / expected[i];
  }
  const auto freedom = static_cast<double>(counts.size()) - 1;
  return (chi - freedom) / std::sqrt(2 * freedom);
}

TEST(World, AClassIsFoundByItsWholeName) {
  const World world = bake(worlds::flat(5), 0.2);
  const std::vector<AvatarClass> classes = world.summary().classes;
  ASSERT_GT(classes.size(), 1u);
  for (size_t c = 0; c < classes.size(); ++c) {
    EXPECT_EQ(world.find_class(classes[c].name), static_cast<int32_t>(c)) << classes[c].name;
  }
  const std::string name = classes[0].name;
  for (const std::string& unknown : {std::string(), name + " ", name.substr(1), name + name,
                                     std::string("ADULT"), name + std::string(1, '\0')}) {
    EXPECT_FALSE(world.find_class(unknown)) << unknown;
  }
}

TEST(World, RandomPlacesAreUniformOverTheLegalCellsOfAllLevels) {
  const World world = bake(worlds::two_floors(), 0.1, 6.4);
  ASSERT_GT(world.summary().zones, 1u);
  const Content content(world);
  constexpr int32_t kDraws = 200000;
  for (const int32_t c : {0, 1, 2}) {
    std::vector<std::vector<int32_t>> number(content.size());
    std::vector<double> expected;
    double cells = 0;
    for (size_t l = 0; l < content.size(); ++l) {
      number[l].assign(4096, -1);
      for (size_t i = 0; i < 4096; ++i) {
        if (content.level(l).clearance[static_cast<size_t>(c)][i] == 0) continue;
        expected.push_back(1);
        cells += 1;
        number[l][i] = static_cast<int32_t>(expected.size()) - 1;
      }
    }
    ASSERT_GT(expected.size(), 1000u);
    for (double& e : expected) e *= kDraws / cells;
    std::vector<int32_t> counts(expected.size()), within(64);
    for (int32_t n = 0; n < kDraws; ++n) {
      const Place place = world.random_place(c, 17, static_cast<uint64_t>(n));
      if (n % 50 == 0) {
        ASSERT_NO_FATAL_FAILURE(expect_sound(world, content, c, place));
        ASSERT_TRUE(same(place, world.random_place(c, 17, static_cast<uint64_t>(n))));
      }
      const auto cell = content.cell_of(place.position.x, place.position.z);
      const auto at = static_cast<size_t>((cell.z & 63) * 64 + (cell.x & 63));
      const int32_t legal = number[place.level1 - 1][at];
      ASSERT_GE(legal, 0);
      ++counts[static_cast<size_t>(legal)];
      ++within[static_cast<size_t>(cell.u * 8) * 8 + static_cast<size_t>(cell.v * 8)];
    }
    EXPECT_LT(std::fabs(unevenness(counts, expected)), 5) << "class " << c;
    EXPECT_LT(std::fabs(unevenness(within, std::vector<double>(64, kDraws / 64.0))), 5);
  }
}

// Cells that a straight line visits, by exact arithmetic in 1/2048 of a cell.
struct Segment {
  int64_t x0, z0, x1, z1;
};

// Every cell that the line is in, and both cells beside each corner that it passes.
template <class Visit>
void visit_cells(const Segment& s, Visit visit) {
  constexpr int64_t kUnit = 2048;
  struct Cut {
    int64_t num, den;  // how far along the line
    bool x;
  };
  std::vector<Cut> cuts;
  const auto add = [&](int64_t from, int64_t to, bool x) {
    for (int64_t line = std::min(from, to) / kUnit; line <= std::max(from, to) / kUnit; ++line) {
      const int64_t at = line * kUnit;
      // Going up a line is crossed when it is reached, going down when it is left.
      if (to > from ? at > from && at <= to : at <= from && at > to) {
        cuts.push_back({std::abs(at - from), std::abs(to - from), x});
      }
    }
  };
  add(s.x0, s.x1, true);
  add(s.z0, s.z1, false);
  const auto order = [](const Cut& a, const Cut& b) { return a.num * b.den < b.num * a.den; };
  std::stable_sort(cuts.begin(), cuts.end(), order);
  int64_t x = s.x0 / kUnit, z = s.z0 / kUnit;
  const int64_t step_x = s.x1 > s.x0 ? 1 : -1, step_z = s.z1 > s.z0 ? 1 : -1;
  visit(x, z);
  for (size_t i = 0; i < cuts.size(); ++i) {
    const bool corner = i + 1 < cuts.size() && !order(cuts[i], cuts[i + 1]);
    if (corner) {
      visit(x + step_x, z);
      visit(x, z + step_z);
      x += step_x;
      z += step_z;
      ++i;
    } else {
      (cuts[i].x ? x : z) += cuts[i].x ? step_x : step_z;
    }
    visit(x, z);
  }
}

TEST(World, OnOneFloorAMoveArrivesIffEveryCellOnItsLineIsLegal) {
  Scene scene = worlds::flat(14);
  for (uint64_t i = 0; i < 40; ++i) {
    const double x = 13 * random_unit(2, i, 0), z = 13 * random_unit(2, i, 1);
    scene.add_box({x, 0, z}, {x + 0.02 + 0.3 * random_unit(2, i, 2), 1.9, z + 0.3}, kAreaBlocked);
  }
  const World world = bake(scene, 0.1, 6.4);
  const Content content(world);
  const WorldSummary summary = world.summary();
  std::map<std::pair<int64_t, int64_t>, bool> legal;
  for (size_t l = 0; l < content.size(); ++l) {
    for (int32_t i = 0; i < 4096; ++i) {
      if (content.level(l).clearance[0][static_cast<size_t>(i)] == 0) continue;
      ASSERT_EQ(content.level(l).floor[static_cast<size_t>(i)], 0);
      legal[{content.level(l).tile_x * 64 + i % 64, content.level(l).tile_z * 64 + i / 64}] = true;
    }
  }
  const auto unit = [&](double x, double origin) {
    return static_cast<int64_t>(std::floor((x - origin) * (2048 / summary.cell)));
  };
  int32_t arrived = 0, blocked = 0, corners = 0;
  for (uint64_t n = 0; n < 30000; ++n) {
    Place from = world.random_place(0, 8, n);
    double dx = 3 * random_unit(8, n, 5) - 1.5, dz = 3 * random_unit(8, n, 6) - 1.5;
    if (n % 4 == 0) {  // through corners: from a cell's middle along diagonals
      const auto cell = content.cell_of(from.position.x, from.position.z);
      const Vec3d middle{summary.origin.x + (static_cast<double>(cell.x) + 0.5) * summary.cell, 0,
                         summary.origin.z + (static_cast<double>(cell.z) + 0.5) * summary.cell};
      from = world.find_place(0, middle, 1);
      ASSERT_TRUE(from);
      const double far = 0.1 * static_cast<double>(random_below(8, n, 7, 12));
      dx = dx < 0 ? -far : far;
      dz = dz < 0 ? -far : far;
    }
    const Vec3d p = from.position;
    const Segment line{unit(p.x, summary.origin.x), unit(p.z, summary.origin.z),
                       unit(p.x + dx, summary.origin.x), unit(p.z + dz, summary.origin.z)};
    bool free = true;
    int32_t cells = 0;
    visit_cells(line, [&](int64_t x, int64_t z) {
      free = free && legal.contains({x, z});
      ++cells;
    });
    corners += n % 4 == 0 && cells > 3 ? 1 : 0;
    const MoveResult move = world.move(0, from, dx, dz);
    ASSERT_EQ(move.end == MoveEnd::kArrived, free) << n;
    if (!free) {
      ++blocked;
      ASSERT_TRUE(same(move.place, from));
      continue;
    }
    ++arrived;
    ASSERT_EQ(move.place.position.x, p.x + dx);
    ASSERT_EQ(move.place.position.z, p.z + dz);
    ASSERT_NO_FATAL_FAILURE(expect_sound(world, content, 0, move.place));
  }
  EXPECT_GT(arrived, 8000);
  EXPECT_GT(blocked, 8000);
  EXPECT_GT(corners, 3000);
}

TEST(World, WalkersOfAStackOfFloorsNeverLeaveTheLegalCells) {
  const World world = garage();
  const Content content(world);
  for (const int32_t c : {0, 1, 2, 3}) {
    const double step = world.summary().classes[static_cast<size_t>(c)].step_height;
    int32_t arrived = 0, blocked = 0, changed = 0;
    for (uint64_t walker = 0; walker < 40; ++walker) {
      Place place = world.random_place(c, 5, walker);
      ASSERT_TRUE(place);
      for (uint64_t n = 0; n < 60; ++n) {
        const double angle = 6.283185 * random_unit(6, walker, n);
        const double far = n % 3 == 0 ? 2.0 : 0.2;
        const double dx = far * std::cos(angle), dz = far * std::sin(angle);
        const MoveResult move = world.move(c, place, dx, dz);
        ASSERT_NO_FATAL_FAILURE(expect_sound(world, content, c, move.place));
        if (move.end == MoveEnd::kBlocked) {
          ++blocked;
          ASSERT_TRUE(same(move.place, place));
          continue;
        }
        ++arrived;
        // Dense points of the line: each in a legal cell of a level that a step joins to the last.
        std::vector<uint32_t> last{place.level1 - 1};
        auto before = content.cell_of(place.position.x, place.position.z);
        for (int32_t i = 1; i <= 400; ++i) {
          const auto cell =
              content.cell_of(place.position.x + dx * i / 400, place.position.z + dz * i / 400);
          if (cell.x == before.x && cell.z == before.z) continue;
          const bool skipped = cell.x != before.x && cell.z != before.z;  // near a corner
          std::vector<uint32_t> now;
          for (const uint32_t level : content.levels_at(cell.x, cell.z)) {
            if (!content.is_legal(level, c, cell.x, cell.z)) continue;
            const int32_t floor = content.floor(level, cell.x, cell.z);
            for (const uint32_t from : last) {
              const double rise =
                  std::abs(floor - content.floor(from, before.x, before.z)) / 1000.0;
              if (rise > step * (skipped ? 2 : 1) + 1e-9) continue;
              now.push_back(level);
              break;
            }
          }
          ASSERT_FALSE(now.empty()) << "class " << c << " walker " << walker << " move " << n;
          last = now;
          before = cell;
        }
        ASSERT_NE(std::find(last.begin(), last.end(), move.place.level1 - 1), last.end());
        changed += move.place.level1 != place.level1 ? 1 : 0;
        place = move.place;
      }
    }
    EXPECT_GT(arrived, 800) << c;
    EXPECT_GT(blocked, 50) << c;
    EXPECT_GT(changed, 20) << c;
  }
}

TEST(World, MovesFromNowhereOrToNowhereAreBlocked) {
  const World world = bake(worlds::flat(5), 0.1);
  const Place place = world.find_place(0, {2.5, 0, 2.5}, 1);
  ASSERT_TRUE(place);
  const double inf = std::numeric_limits<double>::infinity();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const auto& [dx, dz] :
       {std::pair{inf, 0.0}, {0.0, nan}, {1e300, 0.0}, {-3.0, 0.0}, {0.0, 1e6}, {2.4, 0.0}}) {
    const MoveResult move = world.move(0, place, dx, dz);
    EXPECT_EQ(move.end, MoveEnd::kBlocked) << dx << " " << dz;
    EXPECT_TRUE(same(move.place, place));
  }
  EXPECT_EQ(world.move(0, Place{}, 0.1, 0).end, MoveEnd::kBlocked);
  EXPECT_EQ(world.move(0, {{2.5, 0, 2.5}, 99}, 0.1, 0).end, MoveEnd::kBlocked);
  EXPECT_EQ(world.move(9, place, 0.1, 0).end, MoveEnd::kBlocked);
  EXPECT_EQ(world.move(0, {{0.05, 0, 2.5}, place.level1}, 0.1, 0).end, MoveEnd::kBlocked);
  EXPECT_EQ(world.move(0, {{0.05, 0, 2.5}, place.level1}, 0.001, 0).end, MoveEnd::kBlocked);
  EXPECT_EQ(world.move(0, place, 0, 0).end, MoveEnd::kArrived);
}

TEST(World, FeetFollowPlanesOfAnySlopeToAMillimetre) {
  for (const auto& [gx, gz] : {std::pair{0.1, 0.0}, {0.0, -0.3}, {0.25, 0.4}, {-0.6, 0.35}}) {
    Scene scene;
    const auto height = [gx = gx, gz = gz](double x, double z) { return gx * x + gz * z; };
    const auto corner = [&](double x, double z) { return Vec3d{x, height(x, z), z}; };
    scene.add_quad(corner(0, 0), corner(0, 15), corner(15, 15), corner(15, 0));
    const World world = bake(scene, 0.1, 6.4);
    double worst = 0;
    int32_t moved = 0;
    for (uint64_t n = 0; n < 3000; ++n) {
      const Place place = world.random_place(0, 1, n);
      ASSERT_TRUE(place);
      worst =
          std::max(worst, std::fabs(place.position.y - height(place.position.x, place.position.z)));
      const MoveResult move = world.move(0, place, 1 - 2 * random_unit(1, n, 7), 0.7);
      if (move.end != MoveEnd::kArrived) continue;
      ++moved;
      const Vec3d p = move.place.position;
      worst = std::max(worst, std::fabs(p.y - height(p.x, p.z)));
    }
    EXPECT_LT(worst, 0.0025) << gx << " " << gz;  // 1 mm of samples and slopes each, and rounding
    EXPECT_GT(moved, 2000);
  }
}

}  // namespace
}  // namespace throng
