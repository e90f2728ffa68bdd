// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "bake/layers/layers.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "core/hash.h"
#include "core/random.h"
#include "gap_worlds.h"
#include "simd_targets.h"

namespace throng {
namespace {

bake::SurfaceCodes three_codes(size_t classes) {
  const uint32_t all = (1u << classes) - 1;
  return {.codes = {{0, kAreaWalkable}, {1, kAreaWalkable}, {2, kAreaBlocked}},
          .allowed = {all, all & ~1u, 0}};
}

bake::BodyLimits limits_of(const std::vector<AvatarClass>& classes, double cell = 0.1) {
  return bake::body_limits(classes, three_codes(classes.size()), cell);
}

constexpr int32_t kBlockedCode = 2;

// The free spans of one tile with what the definitions say of them.
struct Node {
  int32_t cell;
  naive::FreeSpan free_span;
  bool usable;         // some class may stand here
  int32_t group = -1;  // of free spans that a step joins
};

struct Group {
  int32_t count = 0;
  bool reaches_border = false;
};

struct Expected {
  std::vector<Node> nodes;
  std::vector<Group> groups;
};

bool joined(const naive::FreeSpan& a, const naive::FreeSpan& b, const bake::BodyLimits& limits) {
  const int64_t step = std::abs(int64_t{a.top} - b.top);
  const int64_t room = int64_t{std::min(a.ceiling, b.ceiling)} - std::max(a.top, b.top);
  const int32_t least = limits.min_free_span < bake::BodyLimits::kHighFreeSpan
                            ? limits.low_free_span
                            : bake::BodyLimits::kHighFreeSpan;
  return step <= limits.link_step && room >= least;
}

// The high free spans, and the others of `all`.
naive::FreeSpanBlock by_height(const naive::FreeSpanBlock& high, const naive::FreeSpanBlock& all) {
  naive::FreeSpanBlock out = all;
  for (size_t c = 0; c < out.cells.size(); ++c) {
    for (naive::FreeSpan& free_span : out.cells[c]) {
      for (const naive::FreeSpan& like : high.cells[c]) {
        if (like.top == free_span.top) free_span = like;
      }
    }
  }
  return out;
}

// Every free span of the middle tile, and which of them are connected: a flood fill over all pairs
// of free spans in neighbouring columns.
Expected expect(const naive::FreeSpanBlock& block, const bake::BodyLimits& limits) {
  Expected out;
  std::vector<std::vector<size_t>> of_cell(bake::kTileArea);
  for (int32_t c = 0; c < bake::kTileArea; ++c) {
    for (const naive::FreeSpan& free_span : block.at(c % 64, c / 64)) {
      const bool surface = free_span.support != bake::kNoSupport && free_span.code != kBlockedCode;
      const bool usable = surface &&
                          int64_t{free_span.top} - free_span.support <= limits.max_bottom &&
                          int64_t{free_span.ceiling} - free_span.support >= limits.min_height;
      of_cell[static_cast<size_t>(c)].push_back(out.nodes.size());
      out.nodes.push_back({c, free_span, usable});
    }
  }
  for (size_t seed = 0; seed < out.nodes.size(); ++seed) {
    if (out.nodes[seed].group >= 0) continue;
    const auto group = static_cast<int32_t>(out.groups.size());
    out.groups.emplace_back();
    std::vector<size_t> open{seed};
    out.nodes[seed].group = group;
    while (!open.empty()) {
      const Node node = out.nodes[open.back()];
      open.pop_back();
      const int32_t x = node.cell % 64, z = node.cell / 64;
      ++out.groups.back().count;
      out.groups.back().reaches_border |= x == 0 || z == 0 || x == 63 || z == 63;
      for (const auto& [nx, nz] : {std::pair{x - 1, z}, {x + 1, z}, {x, z - 1}, {x, z + 1}}) {
        if (nx < 0 || nz < 0 || nx > 63 || nz > 63) continue;
        for (const size_t other : of_cell[static_cast<size_t>(nz * 64 + nx)]) {
          if (out.nodes[other].group >= 0 ||
              !joined(node.free_span, out.nodes[other].free_span, limits))
            continue;
          out.nodes[other].group = group;
          open.push_back(other);
        }
      }
    }
  }
  return out;
}

// What an assignment must be, whatever its choices.
void expect_good_layers(const naive::FreeSpanBlock& block, const bake::BodyLimits& limits,
                        const std::string& what) {
  bake::LayerPool pool;
  bake::TileLayers layers;
  naive::assign_tile(block, 0, 0, limits, pool, layers);
  const naive::FreeSpanBlock high = naive::high_free_spans(block),
                             lent = naive::with_lent_supports(block);
  const Expected expected =
      expect(limits.min_free_span < bake::BodyLimits::kHighFreeSpan ? by_height(high, lent) : high,
             limits);

  std::map<std::pair<int32_t, int32_t>, int32_t> assigned;  // cell and top: how often
  for (size_t s = 0; s < layers.size(); ++s) {
    const bake::Layer& layer = *layers[s];
    int32_t cells = 0, present = 0, low_feet = INT32_MAX, high_feet = INT32_MIN;
    for (int32_t c = 0; c < bake::kTileArea; ++c) {
      const auto cell = static_cast<size_t>(c);
      if (layer.top[cell] == bake::kNone16) {
        ASSERT_EQ(layer.feet[cell], bake::kNone16) << what;
        ASSERT_EQ(layer.ceiling[cell], 0) << what << ": a ceiling where there is no free span";
        continue;
      }
      ++cells;
      const int32_t top = layer.base + layer.top[cell];
      ++assigned[{c, top}];
      const auto& column = (layer.is_low ? lent : high).at(c % 64, c / 64);
      const auto free_span = std::find_if(column.begin(), column.end(),
                                          [&](const naive::FreeSpan& g) { return g.top == top; });
      ASSERT_NE(free_span, column.end()) << what << ": layer " << s << " invents a top";
      ASSERT_GE(layer.top[cell], bake::Layer::kBaseDepth) << what;
      ASSERT_LE(layer.top[cell], bake::Layer::kMaxTop) << what;
      if (free_span->ceiling == bake::kOpenSkyMm) {
        ASSERT_EQ(layer.ceiling[cell], bake::kNone16) << what;
      } else {  // exact, or the highest of 16 bits
        ASSERT_EQ(layer.ceiling[cell], std::min(free_span->ceiling - layer.base, 65534)) << what;
      }
      const bool surface = free_span->support != bake::kNoSupport;
      const bool deep = surface && int64_t{free_span->top} - free_span->support > limits.max_bottom;
      const bool low =
          surface && int64_t{free_span->ceiling} - free_span->support < limits.min_height;
      const bool useful = surface && free_span->code != kBlockedCode && !deep && !low;
      ASSERT_EQ(layer.useful[cell / 64] >> cell % 64 & 1, useful ? 1u : 0u) << what;
      if (!surface || free_span->support < layer.base) {  // nothing to stand on, or out of range
        ASSERT_EQ(layer.feet[cell], bake::kNone16) << what;
        continue;
      }
      ++present;
      ASSERT_EQ(layer.base + layer.feet[cell], free_span->support) << what;
      ASSERT_EQ(layer.code[cell], free_span->code) << what;
      low_feet = std::min(low_feet, free_span->support);
      high_feet = std::max(high_feet, free_span->support);
    }
    ASSERT_EQ(layer.cells, cells) << what;
    ASSERT_EQ(layer.present, present) << what;
    ASSERT_GT(present, 0) << what << ": a layer without feet";
    ASSERT_EQ(layer.base + layer.low_feet, low_feet) << what;
    ASSERT_EQ(layer.base + layer.high_feet, high_feet) << what;
    if (s > 0) {
      ASSERT_LE(layers[s - 1]->base, layer.base) << what << ": order";
    }
  }
  for (const Node& node : expected.nodes) {
    const auto found = assigned.find({node.cell, node.free_span.top});
    const int32_t times = found == assigned.end() ? 0 : found->second;
    ASSERT_LE(times, 1) << what << ": a free span in two layers";
    const Group& group = expected.groups[static_cast<size_t>(node.group)];
    const bool crumb = group.count < limits.min_footprint && !group.reaches_border;
    if (node.usable && !crumb) {
      ASSERT_EQ(times, 1) << what << ": a free span is lost at " << node.cell % 64 << " "
                          << node.cell / 64 << " top " << node.free_span.top;
    }
  }
}

naive::RandomBlock random_block(uint64_t seed) {
  return {.seed = seed,
          .ground = static_cast<int32_t>(seed % 5),
          .decks = seed % 3 != 0,
          .ceilings = seed % 2 == 0,
          .holes = seed % 4 < 2,
          .codes = seed % 5 == 0 ? 1 : 3};
}

TEST(Layers, EveryFreeSpanThatAClassCanUseIsInExactlyOneLayerButCrumbs) {
  for (uint64_t seed = 1; seed <= 40; ++seed) {
    const auto classes = default_classes();
    const bake::BodyLimits limits = limits_of(classes, seed % 2 == 0 ? 0.1 : 0.3);
    const naive::FreeSpanBlock block =
        naive::free_spans_of(naive::random_solids(random_block(seed)), limits.min_free_span);
    ASSERT_NO_FATAL_FAILURE(expect_good_layers(block, limits, "seed " + std::to_string(seed)));
  }
}

// Free spans at random heights, as many as fit: no floor continues for long.
naive::FreeSpanBlock noise(uint64_t seed, const bake::BodyLimits& limits, int32_t layers,
                           double spread) {
  naive::FreeSpanBlock block;
  for (int32_t c = 0; c < bake::kTileArea; ++c) {
    uint64_t n = 0;
    const auto unit = [&] { return random_unit(seed, static_cast<uint64_t>(c), n++); };
    auto& column = block.at(c % 64, c / 64);
    int64_t top = -static_cast<int64_t>(1000 * unit());
    const auto count = static_cast<int32_t>(unit() * (layers + 1));
    for (int32_t k = 0; k < count; ++k) {
      const auto room = limits.min_free_span + static_cast<int32_t>(unit() * spread);
      naive::FreeSpan free_span{static_cast<int32_t>(top), static_cast<int32_t>(top + room)};
      if (k + 1 == count) free_span.ceiling = bake::kOpenSkyMm;
      if (unit() < 0.8)
        free_span.support = free_span.top - static_cast<int32_t>(unit() * unit() * 1000);
      free_span.code = static_cast<int32_t>(unit() * 3);
      column.push_back(free_span);
      top += room + 1 + static_cast<int64_t>(unit() * spread * 0.3);
    }
  }
  return block;
}

TEST(Layers, NoiseOfManyLayersIsAssignedWithoutLoss) {
  const bake::BodyLimits limits = limits_of(default_classes());
  for (uint64_t seed = 1; seed <= 10; ++seed) {
    const double spread = seed % 2 == 0 ? 300 : 3000;
    const naive::FreeSpanBlock block = noise(seed, limits, 2 + static_cast<int32_t>(seed), spread);
    ASSERT_NO_FATAL_FAILURE(expect_good_layers(block, limits, std::to_string(seed)));
  }
}

TEST(Layers, HeightsKilometresApartAreExactAndTakeMoreLayers) {
  const bake::BodyLimits limits = limits_of(default_classes());
  for (uint64_t seed = 1; seed <= 6; ++seed) {
    naive::FreeSpanBlock block;
    for (int32_t c = 0; c < bake::kTileArea; ++c) {
      const int32_t x = c % 64, z = c / 64;
      auto& column = block.at(x, z);
      // Floors at -1 km, 1 km and 2 km; a cliff of 90 m across the lowest.
      const int32_t rough =
          static_cast<int32_t>(random_below(seed, 1, static_cast<uint64_t>(c), 40));
      const int32_t low = -1'000'000 + rough + (x > 30 ? 90'000 : 0);
      column.push_back({low, 999'000, low, 0});
      column.push_back({1'000'000 + rough, 1'999'000, 1'000'000, 0});
      column.push_back({2'000'000 + rough, bake::kOpenSkyMm, 2'000'000, 1});
    }
    ASSERT_NO_FATAL_FAILURE(expect_good_layers(block, limits, std::to_string(seed)));
    bake::LayerPool pool;
    bake::TileLayers layers;
    naive::assign_tile(block, 0, 0, limits, pool, layers);
    EXPECT_EQ(layers.size(), 4u);
  }
}

TEST(Layers, AStairOfMoreHeightThanSixteenBitsHoldIsCutNotBent) {
  // 4096 cells along a line that winds through the tile, a step up at each: one component, 120 m.
  const bake::BodyLimits limits = limits_of({AvatarClass{}});
  for (const int32_t rise : {13, 14, 15, 30, 90, 390}) {
    naive::FreeSpanBlock block;
    for (int32_t z = 0; z < 64; ++z) {
      for (int32_t i = 0; i < 64; ++i) {
        const int32_t top = (z * 64 + i) * rise;
        block.at(z % 2 == 0 ? i : 63 - i, z).push_back({top, bake::kOpenSkyMm, top, 0});
      }
    }
    ASSERT_NO_FATAL_FAILURE(expect_good_layers(block, limits, std::to_string(rise)));
  }
}

TEST(Layers, ALevelFloorUnderALevelFloorIsTwoLayersLowestFirst) {
  const bake::BodyLimits limits = limits_of(default_classes());
  naive::FreeSpanBlock block;
  for (int32_t c = 0; c < bake::kTileArea; ++c) {
    block.at(c % 64, c / 64) = {{0, 2800, 0, 0}, {3000, bake::kOpenSkyMm, 3000, 1}};
  }
  bake::LayerPool pool;
  bake::TileLayers layers;
  naive::assign_tile(block, 0, 0, limits, pool, layers);
  ASSERT_EQ(layers.size(), 2u);
  for (size_t s = 0; s < 2; ++s) {
    EXPECT_EQ(layers[s]->present, bake::kTileArea);
    EXPECT_EQ(layers[s]->base + layers[s]->low_feet, s == 0 ? 0 : 3000);
    EXPECT_FALSE(layers[s]->seams);
    EXPECT_TRUE(layers[s]->one_code);
  }
}

TEST(Layers, TheTopsOfPillarsAreCrumbsUnlessTheyReachTheBorder) {
  const bake::BodyLimits limits = limits_of({AvatarClass{}});
  naive::FreeSpanBlock block;
  for (int32_t c = 0; c < bake::kTileArea; ++c)
    block.at(c % 64, c / 64) = {{0, bake::kOpenSkyMm, 0, 0}};
  block.at(20, 20) = {{1500, bake::kOpenSkyMm, 1500, 0}};
  block.at(63, 40) = {{1500, bake::kOpenSkyMm, 1500, 0}};
  for (const auto& [x, z] : {std::pair{20, 20}, {63, 40}})
    block.at(x, z).insert(block.at(x, z).begin(), {-9000, -7000, bake::kNoSupport, 0});
  bake::LayerPool pool;
  bake::TileLayers layers;
  naive::assign_tile(block, 0, 0, limits, pool, layers);
  int32_t inside = 0, border = 0;
  for (const auto& layer : layers) {
    inside += layer->top[20 * 64 + 20] != bake::kNone16 ? 1 : 0;
    border += layer->top[40 * 64 + 63] != bake::kNone16 ? 1 : 0;
  }
  EXPECT_EQ(inside, 0);
  EXPECT_EQ(border, 1);
}

TEST(Layers, AnEmptyTileHasNone) {
  bake::LayerPool pool;
  bake::TileLayers layers;
  naive::assign_tile({}, 0, 0, limits_of(default_classes()), pool, layers);
  EXPECT_TRUE(layers.empty());
}

TEST(Layers, SameLayersForEverySimdWidth) {
  const auto hash_all = [] {
    uint64_t hash = 0;
    const bake::BodyLimits limits = limits_of(default_classes());
    bake::LayerPool pool;
    for (uint64_t seed = 1; seed <= 12; ++seed) {
      const naive::FreeSpanBlock block =
          seed % 3 == 0 ? noise(seed, limits, 5, 1000)
                        : naive::free_spans_of(naive::random_solids(random_block(seed)),
                                               limits.min_free_span);
      bake::TileLayers layers;
      naive::assign_tile(block, 0, 0, limits, pool, layers);
      for (auto& layer : layers) {
        hash = hash_span(std::span<const uint16_t>(layer->top), hash);
        hash = hash_span(std::span<const uint16_t>(layer->ceiling), hash);
        hash = hash_span(std::span<const uint16_t>(layer->feet), hash);
        const int32_t numbers[] = {layer->base, layer->cells, layer->present, layer->some_code,
                                   layer->one_code};
        hash = hash_bytes(numbers, sizeof numbers, hash);
        for (size_t c = 0; c < bake::kTileArea; ++c) {
          if (layer->feet[c] != bake::kNone16) hash = hash_bytes(&layer->code[c], 1, hash);
        }
        pool.give(std::move(layer));
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
