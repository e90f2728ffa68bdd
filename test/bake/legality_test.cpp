// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "bake/layers/legality.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/hash.h"
#include "core/random.h"
#include "gap_worlds.h"
#include "simd_targets.h"

// What a legal cell promises is said in docs/algorithms.md. The oracle looks at columns, never at
// layers: a body at a point P of the cell, feet on the plane that the floor's samples suggest,
// touches the columns nearer than its radius, and each of them needs any free span that holds it.
namespace throng {
namespace {

constexpr int32_t kLast = bake::kTileSide - 1;

bake::SurfaceCodes make_codes(uint32_t all) {
  // All classes', all but the first class's, no class's.
  return {.codes = {{0, kAreaWalkable}, {1, kAreaWalkable}, {2, kAreaBlocked}},
          .allowed = {all, all & ~1u, 0}};
}

// A block assigned to layers, with what legality needs around it.
struct AssignedBlock {
  AssignedBlock(const naive::SolidBlock& solids, std::vector<AvatarClass> of, double cell_size)
      : classes(std::move(of)), cell(cell_size) {
    codes = make_codes((1u << classes.size()) - 1);
    limits = bake::body_limits(classes, codes, cell);
    free_spans = naive::free_spans_of(solids, limits.min_free_span);
    for (size_t c = 0; c < classes.size(); ++c) {
      bodies.push_back(bake::body_window(classes[c], static_cast<int32_t>(c), cell));
      reach = std::max(reach, bodies.back().reach);
    }
    for (size_t i = 0; i < 9; ++i) {
      const auto n = static_cast<int32_t>(i);
      naive::assign_tile(free_spans, n % 3 - 1, n / 3 - 1, limits, pool, tiles[i]);
      list(i);
      around[i] = &lists[i];
    }
  }

  std::vector<AvatarClass> classes;
  void list(size_t tile) {
    lists[tile] = {};
    for (const auto& layer : tiles[tile]) lists[tile].add(layer.get());
  }

  double cell;
  bake::SurfaceCodes codes;
  bake::BodyLimits limits;
  naive::FreeSpanBlock free_spans;
  std::vector<bake::BodyWindow> bodies;
  int32_t reach = 0;
  bake::LayerPool pool;
  std::array<bake::TileLayers, 9> tiles;
  std::array<bake::LayerList, 9> lists;
  bake::Neighbourhood around;
};

struct Verdict {
  bake::BitPlane window;  // by the window alone
  bake::BitPlane legal;
};

Verdict judge(const AssignedBlock& world, size_t layer, size_t avatar_class) {
  bake::LegalityScratch scratch;
  scratch.window.assemble(world.around, layer, world.reach, world.limits);
  bake::make_tilt(*world.tiles[4][layer], scratch.tilt);
  bake::LegalCells cells;
  const bake::BodyWindow& body = world.bodies[avatar_class];
  bake::BitPlane may;
  bake::may_stand(*world.tiles[4][layer], body, world.limits, may);
  bake::legal_cells(*world.tiles[4][layer], body, may, scratch, cells);
  Verdict out;
  out.window = cells.legal;
  bake::recheck_slopes(*world.tiles[4][layer], body, scratch, cells);
  bake::recheck_seams(world.around, layer, body, world.limits, scratch, cells);
  out.legal = cells.legal;
  return out;
}

bool has(const bake::BitPlane& plane, int32_t x, int32_t z) {
  return ((plane[static_cast<size_t>(z)] >> x) & 1) != 0;
}

int32_t count(const bake::BitPlane& plane) {
  int32_t cells = 0;
  for (const uint64_t row : plane) cells += __builtin_popcountll(row);
  return cells;
}

// Feet of a layer, absolute, or nothing.
constexpr double kNowhere = 1e18;
double sample(const bake::Layer& layer, int32_t x, int32_t z) {
  const uint16_t feet = layer.feet[static_cast<size_t>(z * bake::kTileSide + x)];
  return feet == bake::kNone16 ? kNowhere : layer.base + feet;
}

// The gentler of the rises to both sides, nought if they disagree; at the rim as one cell inside.
double gentler(double a, double b, double c) {
  if (a == kNowhere || b == kNowhere || c == kNowhere) return 0;
  const double first = b - a, second = c - b;
  if (first * second <= 0) return 0;
  return std::fabs(first) < std::fabs(second) ? first : second;
}

struct Plane {
  double middle, gx, gz;
  [[nodiscard]] double at(double u, double v) const {
    return middle + gx * (u - 0.5) + gz * (v - 0.5);
  }
  [[nodiscard]] int32_t tilt() const {
    return static_cast<int32_t>(std::ceil((std::fabs(gx) + std::fabs(gz)) / 2));
  }
};

Plane feet_plane(const bake::Layer& layer, int32_t x, int32_t z) {
  const int32_t ix = std::clamp(x, 1, kLast - 1), iz = std::clamp(z, 1, kLast - 1);
  return {
      sample(layer, x, z),
      gentler(sample(layer, ix - 1, z), sample(layer, ix, z), sample(layer, ix + 1, z)),
      gentler(sample(layer, x, iz - 1), sample(layer, x, iz), sample(layer, x, iz + 1)),
  };
}

double true_bottom(const AvatarClass& avatar) {
  return 1000 * std::max(avatar.step_height,
                         avatar.radius * std::tan(avatar.max_slope * std::numbers::pi / 180));
}

// Distance from a point of cell (x, z) to the square of another cell. [cells]
double distance(double px, double pz, int32_t bx, int32_t bz) {
  const double dx = std::max({bx - px, px - bx - 1, 0.0});
  const double dz = std::max({bz - pz, pz - bz - 1, 0.0});
  return std::sqrt(dx * dx + dz * dz);
}

// Does column B have a free span that holds a body whose feet lie in [low, high]?
bool column_holds(const naive::FreeSpanBlock& free_spans, int32_t x, int32_t z, double low,
                  double high, double bottom, double height) {
  if (!free_spans.inside(x, z)) return false;
  for (const naive::FreeSpan& free_span : free_spans.at(x, z)) {
    if (free_span.top <= low + bottom && free_span.top >= high - bottom &&
        free_span.ceiling >= high + height) {
      return true;
    }
  }
  return false;
}

// Is the body of a class safe at every one of some points of the cell?
bool body_is_safe(const AssignedBlock& world, const bake::Layer& layer, size_t c, int32_t x,
                  int32_t z) {
  const AvatarClass& avatar = world.classes[c];
  const Plane plane = feet_plane(layer, x, z);
  const double radius = avatar.radius / world.cell, bottom = true_bottom(avatar);
  const auto reach = static_cast<int32_t>(std::ceil(radius)) + 1;
  const auto odd = static_cast<uint64_t>(z * bake::kTileSide + x);
  const double u3 = random_unit(c, odd, 1), v3 = random_unit(c, odd, 2);
  for (const auto& [u, v] : {std::pair{0.0, 0.0},
                             {1.0, 0.0},
                             {0.0, 1.0},
                             {1.0, 1.0},
                             {0.5, 0.5},
                             {0.5, 0.0},
                             {0.0, 0.5},
                             {u3, v3}}) {
    // Feet are kept in whole millimetres.
    const double exact = plane.at(u, v), whole = std::floor(exact + 0.5);
    const double low = std::min(exact, whole), high = std::max(exact, whole);
    for (int32_t bz = z - reach; bz <= z + reach; ++bz) {
      for (int32_t bx = x - reach; bx <= x + reach; ++bx) {
        if (distance(x + u, z + v, bx, bz) >= radius - 1e-9) continue;
        if (!column_holds(world.free_spans, bx, bz, low, high, bottom + 1e-6,
                          avatar.height * 1000 - 1e-6))
          return false;
      }
    }
  }
  return true;
}

// The free span of the cell's own column on which the layer stands, if the class may stand there.
bool stands(const AssignedBlock& world, const bake::Layer& layer, size_t c, int32_t x, int32_t z) {
  const double feet = sample(layer, x, z);
  for (const naive::FreeSpan& free_span : world.free_spans.at(x, z)) {
    if (free_span.support == bake::kNoSupport || free_span.support != feet) continue;
    if (free_span.top != layer.base + layer.top[static_cast<size_t>(z * bake::kTileSide + x)])
      continue;
    return (world.codes.allowed[static_cast<size_t>(free_span.code)] >> c & 1) != 0;
  }
  return false;
}

// The rule of the window, word by word, on columns of one free span each.
bool window_rule(const AssignedBlock& world, const bake::Layer& layer, size_t c, int32_t x,
                 int32_t z) {
  if (sample(layer, x, z) == kNowhere || !stands(world, layer, c, x, z)) return false;
  const AvatarClass& avatar = world.classes[c];
  const Plane plane = feet_plane(layer, x, z);
  const double low = plane.middle - plane.tilt(), high = plane.middle + plane.tilt();
  const double radius = avatar.radius / world.cell;
  const double bottom = std::floor(true_bottom(avatar) + 1e-6);
  const auto reach = static_cast<int32_t>(std::ceil(radius)) + 1;
  for (int32_t bz = z - reach; bz <= z + reach; ++bz) {
    for (int32_t bx = x - reach; bx <= x + reach; ++bx) {
      const double dx = std::max(std::abs(bx - x) - 1, 0), dz = std::max(std::abs(bz - z) - 1, 0);
      if (std::sqrt(dx * dx + dz * dz) >= radius - 1e-9) continue;
      if (!world.free_spans.inside(bx, bz) || world.free_spans.at(bx, bz).size() != 1) return false;
      const naive::FreeSpan& free_span = world.free_spans.at(bx, bz)[0];
      if (free_span.top > low + bottom || free_span.top < high - bottom) return false;
      if (free_span.ceiling < high + std::ceil(avatar.height * 1000 - 1e-6)) return false;
    }
  }
  return true;
}

// What was found over all layers of the middle tile, and how much of it the window alone knew.
struct Tally {
  int64_t legal = 0, rechecked = 0, layers = 0;
};

void expect_safe(const AssignedBlock& world, const std::string& what, Tally& tally) {
  for (size_t s = 0; s < world.tiles[4].size(); ++s) {
    const bake::Layer& layer = *world.tiles[4][s];
    ++tally.layers;
    for (size_t c = 0; c < world.classes.size(); ++c) {
      const Verdict verdict = judge(world, s, c);
      tally.legal += count(verdict.legal);
      tally.rechecked += count(verdict.legal) - count(verdict.window);
      for (int32_t z = 0; z < bake::kTileSide; ++z) {
        for (int32_t x = 0; x < bake::kTileSide; ++x) {
          if (!has(verdict.legal, x, z)) continue;
          ASSERT_TRUE(stands(world, layer, c, x, z))
              << what << ": " << world.classes[c].name << " has no floor at " << x << " " << z;
          ASSERT_TRUE(body_is_safe(world, layer, c, x, z))
              << what << ": " << world.classes[c].name << " on layer " << s << " at " << x << " "
              << z;
        }
      }
    }
  }
}

std::string words(const naive::RandomBlock& b) {
  return "seed " + std::to_string(b.seed) + " ground " + std::to_string(b.ground);
}

TEST(Legality, ABodyOnALegalCellClearsEveryColumnThatItCanTouch) {
  Tally tally;
  for (uint64_t seed = 1; seed <= 24; ++seed) {
    const naive::RandomBlock block{.seed = seed,
                                   .ground = static_cast<int32_t>(seed % 5),
                                   .decks = seed % 3 != 0,
                                   .ceilings = seed % 2 == 0,
                                   .holes = seed % 4 == 0,
                                   .codes = 3};
    const AssignedBlock world(naive::random_solids(block), default_classes(), 0.1);
    ASSERT_NO_FATAL_FAILURE(expect_safe(world, words(block), tally));
  }
  EXPECT_GT(tally.layers, 60);
  EXPECT_GT(tally.legal, 100000);
  EXPECT_GT(tally.rechecked, 3000);
}

TEST(Legality, BodiesOfAllSizesAndCellsAreSafe) {
  Tally tally;
  for (uint64_t seed = 1; seed <= 30; ++seed) {
    const auto pick = [&](uint64_t n, double low, double high) {
      return low + (high - low) * random_unit(seed, 9, n);
    };
    AvatarClass avatar{.name = "any", .height = pick(0, 0.3, 4), .radius = pick(1, 0.02, 0.8)};
    avatar.step_height = std::floor(pick(2, 0, avatar.height / 2) * 1000) / 1000;
    avatar.max_slope = pick(3, 0, 70);
    const naive::RandomBlock block{.seed = seed + 100,
                                   .ground = static_cast<int32_t>(seed % 5),
                                   .decks = seed % 2 == 0,
                                   .ceilings = true,
                                   .holes = seed % 5 == 0};
    const double cell = seed % 3 == 0 ? 0.05 : (seed % 3 == 1 ? 0.17 : 0.4);
    const AssignedBlock world(naive::random_solids(block), {avatar}, cell);
    ASSERT_NO_FATAL_FAILURE(expect_safe(world, words(block), tally));
  }
  EXPECT_GT(tally.legal, 10000);
}

TEST(Legality, OnASingleLayerTheWindowFindsExactlyWhatTheDefinitionSays) {
  int64_t legal = 0;
  for (uint64_t seed = 1; seed <= 32; ++seed) {
    const naive::RandomBlock block{.seed = seed + 200,
                                   .ground = static_cast<int32_t>(seed % 5),
                                   .holes = seed % 2 == 0,
                                   .codes = seed % 3 == 0 ? 3 : 1};
    naive::SolidBlock solids = naive::random_solids(block);
    for (auto& column : solids.cells) {  // one free span each; some under a ceiling
      if (column.size() > 1) column.resize(1);
    }
    AssignedBlock plain(solids, default_classes(), 0.1);
    if (seed % 4 == 1) {  // ceilings without free spans above them
      for (int32_t z = -64; z < 128; ++z) {
        for (int32_t x = -64; x < 128; ++x) {
          for (naive::FreeSpan& free_span : plain.free_spans.at(x, z)) {
            const auto slab = static_cast<uint64_t>((z + 64) / 23 * 10 + (x + 64) / 17);
            if (random_unit(seed, 3, slab) > 0.4) continue;
            free_span.ceiling = free_span.top + bake::BodyLimits::kHighFreeSpan +
                                static_cast<int32_t>(2000 * random_unit(seed, 4, slab));
          }
        }
      }
      for (size_t i = 0; i < 9; ++i) {
        const auto n = static_cast<int32_t>(i);
        naive::assign_tile(plain.free_spans, n % 3 - 1, n / 3 - 1, plain.limits, plain.pool,
                           plain.tiles[i]);
        plain.list(i);
      }
    }
    ASSERT_LE(plain.tiles[4].size(), 1u) << words(block);
    if (plain.tiles[4].empty()) continue;
    const bake::Layer& layer = *plain.tiles[4][0];
    for (size_t c = 0; c < plain.classes.size(); ++c) {
      const Verdict verdict = judge(plain, 0, c);
      legal += count(verdict.window);
      for (int32_t z = 0; z < bake::kTileSide; ++z) {
        for (int32_t x = 0; x < bake::kTileSide; ++x) {
          ASSERT_EQ(has(verdict.window, x, z), window_rule(plain, layer, c, x, z))
              << words(block) << " " << plain.classes[c].name << " at " << x << " " << z;
          if (has(verdict.window, x, z)) {
            ASSERT_TRUE(has(verdict.legal, x, z));
          }
        }
      }
    }
  }
  EXPECT_GT(legal, 40000);
}

naive::SolidBlock flat_block(int32_t height) {
  naive::SolidBlock solids;
  for (auto& column : solids.cells) column.push_back({height - 500, height, height, 0});
  return solids;
}

TEST(Legality, ABodyThatJustTouchesAColumnIsNotStoppedByIt) {
  // The radius is 3 cells: from the near side of a cell 3 cells away, a pillar is just touched.
  const AvatarClass avatar{.name = "a", .height = 1.8, .radius = 0.3};
  naive::SolidBlock solids = flat_block(0);
  solids.at(30, 30).push_back({0, 2500, bake::kNoSupport, 0});
  const AssignedBlock world(solids, {avatar}, 0.1);
  const Verdict verdict = judge(world, 0, 0);
  for (int32_t x = 27; x <= 33; ++x) EXPECT_FALSE(has(verdict.legal, x, 30)) << x;
  EXPECT_TRUE(has(verdict.legal, 26, 30));
  EXPECT_TRUE(has(verdict.legal, 34, 30));
  EXPECT_TRUE(has(verdict.legal, 30, 26));
  EXPECT_TRUE(has(verdict.legal, 30, 34));
  // Diagonally: (3, 3) leaves 2 x 2 cells between, 2.83 away; (3, 4) is 3.6 away.
  EXPECT_FALSE(has(verdict.legal, 33, 33));
  EXPECT_TRUE(has(verdict.legal, 33, 34));
}

TEST(Legality, EvenSlopesUpToTheClasssLimitAreLegalAllOver) {
  const AvatarClass adult;
  for (const double degrees : {5.0, 20.0, 35.0, 44.9}) {
    const double rise = 100 * std::tan(degrees * std::numbers::pi / 180);
    for (const double turn : {0.0, 0.4, 0.8}) {
      naive::SolidBlock solids;
      const double gx = rise * std::cos(turn), gz = rise * std::sin(turn);
      for (int32_t z = -64; z < 128; ++z) {
        for (int32_t x = -64; x < 128; ++x) {
          const double middle = gx * (x + 0.5) + gz * (z + 0.5), half = (gx + gz) / 2;
          solids.at(x, z).push_back({static_cast<int32_t>(middle - half - 500),
                                     static_cast<int32_t>(std::ceil(middle + half)),
                                     static_cast<int32_t>(std::lround(middle)), 0});
        }
      }
      const AssignedBlock world(solids, {adult}, 0.1);
      ASSERT_EQ(world.tiles[4].size(), 1u);
      EXPECT_EQ(count(judge(world, 0, 0).legal), bake::kTileArea)
          << degrees << " degrees, " << turn;
    }
  }
}

TEST(Legality, WhatAllLegalPassesEveryCellPasses) {
  int32_t passed = 0, stopped = 0;
  for (uint64_t seed = 1; seed <= 60; ++seed) {
    naive::SolidBlock solids = flat_block(1000);
    const auto rough = static_cast<int32_t>(1 + 90 * random_unit(seed, 1, 0));
    for (size_t c = 0; c < solids.cells.size(); ++c) {
      naive::Solid& s = solids.cells[c][0];
      s.high += static_cast<int32_t>(random_below(seed, 2, c, static_cast<uint64_t>(rough)));
      s.support = s.high - static_cast<int32_t>(random_below(seed, 3, c, 3));
    }
    if (seed % 3 == 0) {  // A ceiling over one cell, too low for some or for all.
      const auto at = static_cast<size_t>(random_below(seed, 6, 0, solids.cells.size()));
      const auto room = 900 + static_cast<int32_t>(random_below(seed, 7, 0, 2500));
      solids.cells[at].push_back({1000 + room, 1000 + room + 50, bake::kNoSupport, 0});
    }
    if (seed % 2 == 0) {  // A neighbour that could block, or just not.
      const auto at = static_cast<size_t>(random_below(seed, 4, 0, solids.cells.size()));
      solids.cells[at][0].high += static_cast<int32_t>(random_below(seed, 5, 0, 800));
    }
    const AssignedBlock world(solids, default_classes(), 0.1);
    for (size_t c = 0; c < world.classes.size(); ++c) {
      if (!bake::all_legal(world.around, 0, world.bodies[c], world.limits)) {
        ++stopped;
        continue;
      }
      ++passed;
      for (int32_t i = static_cast<int32_t>(seed % 7); i < bake::kTileArea; i += 7) {
        ASSERT_TRUE(
            body_is_safe(world, *world.tiles[4][0], c, i % bake::kTileSide, i / bake::kTileSide))
            << "seed " << seed << " " << world.classes[c].name;
      }
    }
  }
  EXPECT_GT(passed, 20);
  EXPECT_GT(stopped, 20);
}

TEST(Legality, StepSafeIsTrueIffNoTwoLegalNeighboursDifferByMoreThanTheStep) {
  const auto layer = std::make_unique<bake::Layer>();
  int32_t safe = 0;
  for (uint64_t seed = 1; seed <= 400; ++seed) {
    const auto range = 1 + random_below(seed, 0, 0, 500);
    bake::BitPlane legal{};
    for (size_t c = 0; c < bake::kTileArea; ++c) {
      layer->feet[c] = static_cast<uint16_t>(4000 + random_below(seed, 1, c, range));
      if (random_unit(seed, 2, c) < 0.02) layer->feet[c] = bake::kNone16;
      const bool stands = layer->feet[c] != bake::kNone16 && random_unit(seed, 3, c) < 0.9;
      legal[c / 64] |= static_cast<uint64_t>(stands) << (c % 64);
    }
    if (seed % 2 == 0) {  // One step that is too high, somewhere: also along the rim.
      const size_t at = random_below(seed, 4, 0, bake::kTileArea);
      layer->feet[at] = static_cast<uint16_t>(5000 + range);
    }
    const auto step = static_cast<int32_t>(range) - 1 + static_cast<int32_t>(seed % 3) - 1;
    bool expected = true;
    for (int32_t i = 0; i < bake::kTileArea; ++i) {
      const int32_t x = i % 64, z = i / 64;
      if (!has(legal, x, z)) continue;
      for (const auto& [nx, nz] : {std::pair{x + 1, z}, {x, z + 1}}) {
        if (nx > kLast || nz > kLast || !has(legal, nx, nz)) continue;
        const int32_t other = layer->feet[static_cast<size_t>(nz * 64 + nx)];
        expected = expected && std::abs(other - layer->feet[static_cast<size_t>(i)]) <= step;
      }
    }
    safe += expected ? 1 : 0;
    ASSERT_EQ(bake::step_safe(*layer, legal, step), expected) << "seed " << seed;
  }
  // Each pair of neighbours alone.
  for (int32_t i = 0; i < bake::kTileArea; ++i) {
    const int32_t x = i % 64, z = i / 64;
    for (const auto& [nx, nz] : {std::pair{x + 1, z}, {x, z + 1}}) {
      if (nx > kLast || nz > kLast) continue;
      layer->feet.fill(4000);
      layer->feet[static_cast<size_t>(i)] = 4300;
      bake::BitPlane legal{};
      legal[static_cast<size_t>(z)] |= uint64_t{1} << x;
      legal[static_cast<size_t>(nz)] |= uint64_t{1} << nx;
      ASSERT_TRUE(bake::step_safe(*layer, legal, 300)) << x << " " << z;
      ASSERT_FALSE(bake::step_safe(*layer, legal, 299))
          << x << " " << z << " to " << nx << " " << nz;
    }
  }
  EXPECT_GT(safe, 50);
  EXPECT_LT(safe, 350);
}

TEST(Legality, ATallBodyUnderAFarCeilingOfATallTileKeepsItsHead) {
  // The tile climbs 50 m; over its upper end a ceiling hangs 12 m above the floor: more than 65 m
  // above the lowest floor, too low for a body of 15 m.
  const AvatarClass tall{.name = "tall", .height = 15, .radius = 0.5, .step_height = 1};
  naive::SolidBlock solids;
  for (int32_t z = -64; z < 128; ++z) {
    for (int32_t x = -64; x < 128; ++x) {
      const int32_t floor = std::clamp(x, 0, 60) * 900;
      solids.at(x, z).push_back({floor - 500, floor, floor, 0});
      if (x > 56) solids.at(x, z).push_back({floor + 12000, floor + 12500, bake::kNoSupport, 0});
    }
  }
  Tally tally;
  expect_safe(AssignedBlock(solids, {AvatarClass{}, tall}, 1.0), "tall tile", tally);
  EXPECT_GT(tally.legal, 1000);
}

TEST(Legality, ABodyThatStepsFarDownDoesNotStepOverADeeperEdge) {
  // bottom is 5 m; beside the tile the ground lies 12 m lower, in another tile's layer.
  const AvatarClass wide{.name = "wide", .height = 20, .radius = 1, .step_height = 5};
  for (const int32_t drop : {3000, 5500, 12000, 40000}) {
    naive::SolidBlock solids = flat_block(0);
    for (int32_t z = -64; z < 128; ++z) {
      for (int32_t x = 64; x < 128; ++x) {
        solids.at(x, z)[0] = {-drop - 500, -drop, -drop, 0};
        // A second floor there, so that its layers are chosen line by line.
        if (drop == 40000)
          solids.at(x, z).push_back({-drop - 61000, -drop - 60500, bake::kNoSupport, 0});
      }
    }
    Tally tally;
    expect_safe(AssignedBlock(solids, {wide}, 1.0), "drop " + std::to_string(drop), tally);
    EXPECT_GT(tally.legal, 3000);
  }
}

TEST(Legality, SameBitsForEverySimdWidth) {
  const auto hash_all = [] {
    uint64_t hash = 0;
    for (uint64_t seed = 1; seed <= 5; ++seed) {
      const naive::RandomBlock block{.seed = seed,
                                     .ground = static_cast<int32_t>(seed % 5),
                                     .decks = true,
                                     .ceilings = true,
                                     .holes = true,
                                     .codes = 3};
      const AssignedBlock world(naive::random_solids(block), default_classes(), 0.1);
      for (size_t s = 0; s < world.tiles[4].size(); ++s) {
        for (size_t c = 0; c < world.classes.size(); ++c) {
          const Verdict verdict = judge(world, s, c);
          hash = hash_span(std::span<const uint64_t>(verdict.legal), hash);
          const bool safe =
              bake::step_safe(*world.tiles[4][s], verdict.legal, world.bodies[c].step);
          hash = hash_bytes(&safe, sizeof safe, hash);
        }
      }
    }
    return hash;
  };
  const uint64_t expected = hash_all();
  test::for_every_simd_target(
      [&](const char* target) { EXPECT_EQ(hash_all(), expected) << target; });
}

}  // namespace
}  // namespace throng
