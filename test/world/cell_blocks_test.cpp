// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "world/cell_blocks.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "bake/folder/cell_packer.h"
#include "core/random.h"
#include "simd_targets.h"

namespace throng {
namespace {

// Row by row, and some entries more, because the packer reads past the end.
struct Cells {
  std::vector<uint16_t> values = std::vector<uint16_t>(world::kBlocks * 64 + 32, bake::kNone16);
  std::vector<uint16_t> feet = std::vector<uint16_t>(world::kBlocks * 64 + 32, bake::kNone16);

  void set(size_t cell, int64_t value) {
    values[cell] = static_cast<uint16_t>(value);
    feet[cell] = 1;
  }
};

Cells make_cells(const std::function<int64_t(int32_t x, int32_t z)>& value) {
  Cells cells;
  for (int32_t c = 0; c < 4096; ++c) cells.set(static_cast<size_t>(c), value(c % 64, c / 64));
  return cells;
}

void pack(const Cells& cells, uint16_t base, std::vector<uint64_t>& words) {
  world::CellRows has{};
  int32_t count = 0;
  for (size_t c = 0; c < 4096; ++c) {
    const bool stands = cells.feet[c] != bake::kNone16;
    has[c / 64] |= uint64_t{stands} << (c % 64);
    count += stands ? 1 : 0;
  }
  bake::pack_values(cells.values.data(), cells.feet.data(), count == 4096 ? nullptr : &has, base,
                    words);
}

uint32_t below(uint64_t seed, int32_t x, int32_t z, uint32_t limit) {
  return static_cast<uint32_t>(random_below(seed, static_cast<uint64_t>(z * 64 + x), 0, limit));
}

// Easy ones, hard ones, and ones that end where the numbers end.
std::vector<std::pair<std::string, Cells>> all_cells() {
  std::vector<std::pair<std::string, Cells>> out;
  const auto add = [&](const std::string& name, const auto& value) {
    out.emplace_back(name, make_cells(value));
  };
  out.emplace_back("nothing", Cells{});
  for (const size_t cell : {0u, 63u, 64u, 4032u, 4095u, 1234u}) {
    Cells one;
    one.set(cell, 4711);
    out.emplace_back("cell " + std::to_string(cell), one);
    Cells sky;
    sky.feet[cell] = 1;
    out.emplace_back("hole " + std::to_string(cell), sky);
  }
  add("one value", [](int32_t, int32_t) { return 65534; });
  add("only holes", [](int32_t, int32_t) { return world::kNoValue; });
  add("ground", [](int32_t, int32_t) { return 0; });
  add("rows alike", [](int32_t x, int32_t) { return 1000 + below(1, x, 0, 3000); });
  add("columns alike", [](int32_t, int32_t z) { return 1000 + below(1, 0, z, 3000); });
  add("all rows distinct", [](int32_t x, int32_t z) { return z * 64 + x; });
  add("board", [](int32_t x, int32_t z) { return (x + z) % 2 == 0 ? 0 : 65534; });
  add("board with holes",
      [](int32_t x, int32_t z) { return (x + z) % 2 == 0 ? 0 : world::kNoValue; });
  add("edge", [](int32_t x, int32_t) { return x < 13 ? 0 : 65534; });
  for (const int32_t spread : {1, 2, 3, 4, 15, 16, 17, 255, 256, 257, 4095, 4096, 4097, 65534}) {
    const std::string name = "noise of " + std::to_string(spread);
    const auto limit = static_cast<uint32_t>(spread) + 1;
    add(name, [=](int32_t x, int32_t z) { return below(2, x, z, limit); });
    add(name + " with holes", [=](int32_t x, int32_t z) {
      return below(3, x, z, 5) == 0 ? world::kNoValue : below(2, x, z, std::min(limit, 65535u));
    });
    Cells some = make_cells([=](int32_t x, int32_t z) { return below(2, x, z, limit); });
    for (size_t c = 0; c < 4096; ++c) {
      if (random_below(4, c, 0, 3) == 0) some.feet[c] = bake::kNone16;
      if (random_below(4, c, 1, 50) == 0) some.values[c] = world::kNoValue;
    }
    out.emplace_back(name + " of some", some);
  }
  for (const double slope : {0.01, 0.3, 7.0, 99.9, 511.0, 513.0, 4000.0}) {
    for (const double turn : {0.0, 0.4, 1.6, 3.2, 4.5}) {
      const auto plane = [=](int32_t x, int32_t z) {
        const double y = 32000 + slope * (std::cos(turn) * (x - 31) + std::sin(turn) * (z - 31));
        return std::clamp<int64_t>(std::llround(y), 0, 65534);
      };
      const std::string name = "slope " + std::to_string(slope) + ", " + std::to_string(turn);
      add(name, plane);
      Cells some = make_cells(plane);
      for (size_t c = 0; c < 4096; ++c) {
        if (random_below(5, c, 0, 2) == 0) some.feet[c] = bake::kNone16;
      }
      out.emplace_back(name + " of some", some);
      add(name + " with steps", [=](int32_t x, int32_t z) {
        return std::min<int64_t>(plane(x, z) + (x % 5 == 0 ? 200 : 0), 65534);
      });
    }
  }
  return out;
}

TEST(CellBlocks, ValuesComeBackAsTheyWere) {
  for (const auto& [name, cells] : all_cells()) {
    uint16_t low = bake::kNone16;
    for (size_t c = 0; c < 4096; ++c) {
      if (cells.feet[c] != bake::kNone16) low = std::min(low, cells.values[c]);
    }
    if (low == bake::kNone16) low = 0;
    for (const uint16_t base : {uint16_t{0}, low}) {
      std::vector<uint64_t> words(3, 0x1234567812345678);  // Others' words before.
      pack(cells, base, words);
      ASSERT_TRUE(world::values_fit(words, 3)) << name;
      EXPECT_LE(words.size(), 3 + world::kValueHead + world::kBlocks * 16) << name;
      ASSERT_EQ(words[0], 0x1234567812345678u);
      const uint64_t* packed = &words[3];
      std::vector<uint16_t> unpacked(4096);
      world::unpack_values(packed, unpacked.data());
      for (int32_t z = 0; z < 64; ++z) {
        for (int32_t x = 0; x < 64; ++x) {
          const auto c = static_cast<size_t>(z * 64 + x);
          const uint16_t value = world::value_at(packed, x, z);
          ASSERT_EQ(unpacked[c], value) << name;
          if (cells.feet[c] == bake::kNone16) continue;
          const uint16_t expected = cells.values[c] == bake::kNone16
                                        ? world::kNoValue
                                        : static_cast<uint16_t>(cells.values[c] - base);
          ASSERT_EQ(value, expected) << name << ", cell " << x << " " << z;
        }
      }
    }
  }
}

TEST(CellBlocks, ACrossIsItsFiveValues) {
  for (const auto& [name, cells] : all_cells()) {
    std::vector<uint64_t> words;
    pack(cells, 0, words);
    for (int32_t z = 1; z < 63; ++z) {
      for (int32_t x = 1; x < 63; ++x) {
        if (!world::is_inside_block(x, z)) continue;
        const auto at = [&](int32_t i, int32_t k) { return world::value_at(words.data(), i, k); };
        const uint16_t five[] = {at(x, z), at(x - 1, z), at(x + 1, z), at(x, z - 1), at(x, z + 1)};
        if (std::count(five, five + 5, world::kNoValue) != 0) continue;
        const world::ValueCross cross = world::cross_at(words.data(), x, z);
        const uint16_t found[] = {cross.middle, cross.left, cross.right, cross.up, cross.down};
        ASSERT_TRUE(std::equal(five, five + 5, found)) << name << ", cell " << x << " " << z;
      }
    }
  }
}

TEST(CellBlocks, SameWordsForEverySimdWidth) {
  for (const auto& [name, cells] : all_cells()) {
    const auto packed = [&cells = cells] {
      std::vector<uint64_t> words;
      pack(cells, 0, words);
      return words;
    };
    const std::vector<uint64_t> expected = packed();
    test::for_every_simd_target([&, &name = name](const char* target) {
      EXPECT_EQ(packed(), expected) << target << ", " << name;
    });
  }
}

TEST(CellBlocks, APlaneTakesTwoBitsACell) {
  const Cells cells =
      make_cells([](int32_t x, int32_t z) { return std::lround(20000 + 31.37 * x - 77.71 * z); });
  std::vector<uint64_t> words;
  pack(cells, 0, words);
  EXPECT_LE(words.size(), world::kValueHead + world::kBlocks * 2);
}

std::vector<world::CellRows> all_rows() {
  std::vector<world::CellRows> out;
  const auto add = [&](const auto& has) {
    world::CellRows rows{};
    for (int32_t c = 0; c < 4096; ++c) {
      rows[static_cast<size_t>(c / 64)] |= static_cast<uint64_t>(has(c % 64, c / 64)) << (c % 64);
    }
    out.push_back(rows);
  };
  add([](int32_t, int32_t) { return false; });
  add([](int32_t, int32_t) { return true; });
  for (const int32_t cell : {0, 63, 64, 4032, 4095, 2345}) {
    add([=](int32_t x, int32_t z) { return z * 64 + x == cell; });
    add([=](int32_t x, int32_t z) { return z * 64 + x != cell; });
  }
  add([](int32_t x, int32_t z) { return (x + z) % 2 == 0; });
  add([](int32_t x, int32_t) { return x % 3 == 0; });
  add([](int32_t, int32_t z) { return z >= 3; });
  add([](int32_t x, int32_t z) { return x / 8 == z / 8; });
  add([](int32_t x, int32_t z) { return x + 2 * z < 90; });
  for (const uint32_t one_in : {2, 10, 500}) {
    add([=](int32_t x, int32_t z) { return below(7, x, z, one_in) == 0; });
    add([=](int32_t x, int32_t z) { return below(8, x, z, one_in) != 0; });
  }
  return out;
}

TEST(CellBlocks, SetsComeBackAsTheyWere) {
  std::vector<uint64_t> words(2, 99);
  for (const world::CellRows& rows : all_rows()) {
    const size_t first = words.size();
    bake::pack_bits(rows, words);
    const uint64_t* packed = &words[first];
    ASSERT_EQ(world::end_of_bits(words, first), words.size());
    ASSERT_EQ(world::bit_words(packed), words.size() - first);
    world::CellRows unpacked;
    world::unpack_bits(packed, unpacked);
    EXPECT_EQ(unpacked, rows);
    uint32_t count = 0;
    for (int32_t c = 0; c < 4096; ++c) {
      const bool expected = (rows[static_cast<size_t>(c / 64)] >> (c % 64) & 1) != 0;
      ASSERT_EQ(world::bit_at(packed, c % 64, c / 64), expected);
      if (!expected) continue;
      ASSERT_EQ(world::nth_bit(packed, count), static_cast<uint32_t>(c));
      ++count;
    }
    EXPECT_EQ(world::count_bits(packed), count);
  }
}

TEST(CellBlocks, WhatEndsBehindTheWordsIsRefused) {
  std::vector<uint64_t> words;
  bake::pack_bits(all_rows()[2], words);  // one cell
  ASSERT_EQ(words.size(), 3u);
  EXPECT_TRUE(world::end_of_bits(words, 0));
  for (size_t size = 0; size < words.size(); ++size) {
    EXPECT_FALSE(world::end_of_bits({words.data(), size}, 0)) << size;
  }
  for (const uint64_t offset : {uint64_t{2}, uint64_t{3}, uint64_t{4}, uint64_t{UINT32_MAX}}) {
    EXPECT_FALSE(world::end_of_bits(words, offset)) << offset;
  }

  words.clear();
  const Cells noise = make_cells([](int32_t x, int32_t z) { return below(1, x, z, 60000); });
  pack(noise, 0, words);
  EXPECT_EQ(words.size(), world::kValueHead + world::kBlocks * 16);
  EXPECT_TRUE(world::values_fit(words, 0));
  for (const size_t size : {size_t{0}, size_t{1}, size_t{63}, size_t{64}, words.size() - 1}) {
    EXPECT_FALSE(world::values_fit({words.data(), size}, 0)) << size;
  }
  for (const uint64_t offset :
       {uint64_t{1}, words.size(), words.size() + 1, uint64_t{UINT32_MAX}}) {
    EXPECT_FALSE(world::values_fit(words, offset)) << offset;
  }
  for (const uint64_t code : {6, 7}) {  // 32 and 64 bits a cell
    std::vector<uint64_t> bad = words;
    bad[17] = (bad[17] & ~(uint64_t{7} << 48)) | code << 48;
    EXPECT_FALSE(world::values_fit(bad, 0));
  }
}

TEST(CellBlocks, HeadsComeBackAsTheyWere) {
  for (const uint8_t width : std::initializer_list<uint8_t>{0, 1, 2, 4, 8, 16}) {
    const world::ValueBlock block{.base = 65535,
                                  .slope_x = -32768,
                                  .slope_z = 32767,
                                  .width = width,
                                  .holes = width == 4,
                                  .first = 1023};
    const world::ValueBlock back = world::unpack_head(world::pack_head(block));
    EXPECT_EQ(back.base, block.base);
    EXPECT_EQ(back.slope_x, block.slope_x);
    EXPECT_EQ(back.slope_z, block.slope_z);
    EXPECT_EQ(back.width, block.width);
    EXPECT_EQ(back.holes, block.holes);
    EXPECT_EQ(back.first, block.first);
  }
}

}  // namespace
}  // namespace throng
