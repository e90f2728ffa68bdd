// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

/// How a zone file holds something for each of the 64 x 64 cells of a level tile: in 64 blocks of
/// 8 x 8 cells, so that what is the same over a block costs nothing and any one cell is found in
/// constant time, in the mapped file. A block of bits is one word; a block of values is a slope
/// and, in as few bits as it takes, what differs from it.
///
/// Block b holds cells (8 (b % 8) + i % 8, 8 (b / 8) + i / 8) for i in [0, 64).
namespace throng::world {

inline constexpr size_t kBlocks = 64;        ///< Of a level tile.
inline constexpr uint16_t kNoValue = 65535;  ///< No floor, or no ceiling.
using CellRows = std::array<uint64_t, 64>;   ///< Bit x of row z is cell (x, z).

constexpr uint32_t block_of(int32_t x, int32_t z) {
  return static_cast<uint32_t>((z >> 3) * 8 + (x >> 3));
}
constexpr uint32_t place_in_block(int32_t x, int32_t z) {
  return static_cast<uint32_t>((z & 7) * 8 + (x & 7));
}

/// A set of cells. `words` are: which blocks are mixed, which of the others are full, and a word of
/// cells for each mixed block, in order.
inline constexpr size_t kBitHead = 2;

/// Bits of a word. Without the instruction, std::popcount is a call, and this is in every move.
constexpr uint32_t count_ones(uint64_t word) {
  word -= (word >> 1) & 0x5555555555555555;
  word = (word & 0x3333333333333333) + ((word >> 2) & 0x3333333333333333);
  word = (word + (word >> 4)) & 0x0f0f0f0f0f0f0f0f;
  return static_cast<uint32_t>((word * 0x0101010101010101) >> 56);
}

/// Where the word of a block of a set is, if it is mixed. [block < 64]
inline const uint64_t* block_word(const uint64_t* words, uint32_t block) {
  return words + kBitHead + count_ones(words[0] & ((uint64_t{1} << block) - 1));
}

/// The cells of one block of a set. [block < 64]
inline uint64_t block_cells(const uint64_t* words, uint32_t block) {
  if (((words[0] >> block) & 1) == 0) return uint64_t{0} - ((words[1] >> block) & 1);
  return *block_word(words, block);
}

inline bool bit_at(const uint64_t* words, int32_t x, int32_t z) {
  return ((block_cells(words, block_of(x, z)) >> place_in_block(x, z)) & 1) != 0;
}

/// Words that a set takes.
inline size_t bit_words(const uint64_t* words) { return kBitHead + count_ones(words[0]); }

/// Cells of a set.
uint32_t count_bits(const uint64_t* words);
/// The n-th cell of a set in the order of rows, as 64 z + x. [n < count_bits]
uint32_t nth_bit(const uint64_t* words, uint32_t n);
/// All rows of a set.
void unpack_bits(const uint64_t* words, CellRows& rows);

/// What one block of values is: the value of its cell (x, z) is, modulo 2^16,
///   base + (slope_x * x >> 6) + (slope_z * z >> 6) + what differs,
/// the last in 0, 1, 2, 4, 8 or 16 bits a cell. Up to 8 bits, byte x of word z % width has it from
/// bit z / width * width on; 16-bit values go row by row.
struct ValueBlock {
  uint16_t base = 0;
  int16_t slope_x = 0, slope_z = 0;  ///< [1/64 a cell]
  uint8_t width = 0;                 ///< Bits a cell.
  bool holes = false;                ///< All bits set says kNoValue.
  uint32_t first = 0;                ///< Its words, after the heads. [< 1024]
};

/// Heads of a level tile's values, before the words.
inline constexpr size_t kValueHead = kBlocks;

constexpr uint64_t pack_head(const ValueBlock& block) {
  const auto code = static_cast<uint64_t>(std::bit_width(block.width));
  return block.base | uint64_t{static_cast<uint16_t>(block.slope_x)} << 16 |
         uint64_t{static_cast<uint16_t>(block.slope_z)} << 32 | code << 48 |
         uint64_t{block.holes} << 51 | uint64_t{block.first} << 52;
}
constexpr ValueBlock unpack_head(uint64_t head) {
  return {.base = static_cast<uint16_t>(head),
          .slope_x = static_cast<int16_t>(head >> 16),
          .slope_z = static_cast<int16_t>(head >> 32),
          .width = static_cast<uint8_t>((1u << (head >> 48 & 7)) >> 1),
          .holes = (head >> 51 & 1) != 0,
          .first = static_cast<uint32_t>(head >> 52)};
}

/// The slopes' share of a cell's value.
constexpr int32_t slope_part(const ValueBlock& block, uint32_t x, uint32_t z) {
  return ((block.slope_x * static_cast<int32_t>(x)) >> 6) +
         ((block.slope_z * static_cast<int32_t>(z)) >> 6);
}

/// What cell (column, row) of a block differs by from the slopes. `words` are the block's own.
/// [width > 0]
inline uint32_t rest_at(const ValueBlock& block, const uint64_t* words, uint32_t column,
                        uint32_t row) {
  if (block.width == 16) {
    return static_cast<uint16_t>(words[row * 2 + column / 4] >> (column % 4 * 16));
  }
  const uint32_t inside = block.width - 1u;
  return static_cast<uint32_t>(words[row & inside] >> (column * 8 + (row & ~inside))) &
         ((1u << block.width) - 1);
}

/// Where the row of a cell's value begins, if its block has any words.
inline const uint64_t* row_of_value(const uint64_t* words, int32_t x, int32_t z) {
  const ValueBlock block = unpack_head(words[block_of(x, z)]);
  const auto row = static_cast<uint32_t>(z & 7);
  return words + kValueHead + block.first +
         (block.width == 16 ? 2 * row : row & (block.width - 1u));
}

/// Value of a cell, kNoValue where there is none.
inline uint16_t value_at(const uint64_t* words, int32_t x, int32_t z) {
  const ValueBlock block = unpack_head(words[block_of(x, z)]);
  const auto column = static_cast<uint32_t>(x & 7), row = static_cast<uint32_t>(z & 7);
  uint32_t value = block.base + static_cast<uint32_t>(slope_part(block, column, row));
  if (block.width != 0) {
    const uint32_t rest = rest_at(block, words + kValueHead + block.first, column, row);
    if (block.holes && rest == (1u << block.width) - 1) return kNoValue;
    value += rest;
  }
  return static_cast<uint16_t>(value);
}

/// Values of a cell that is not at its block's rim, and of the four beside it.
struct ValueCross {
  uint16_t middle = 0, left = 0, right = 0, up = 0, down = 0;
};
constexpr bool is_inside_block(int32_t x, int32_t z) {
  return static_cast<uint32_t>((x & 7) - 1) < 6 && static_cast<uint32_t>((z & 7) - 1) < 6;
}
/// The bits of such a cross in the word of its block.
constexpr uint64_t cross_bits(int32_t x, int32_t z) {
  constexpr uint64_t kCross = uint64_t{2} | uint64_t{7} << 8 | uint64_t{2} << 16;
  return kCross << (place_in_block(x, z) - 9);
}
/// As value_at five times. [is_inside_block(x, z), no kNoValue among them]
inline ValueCross cross_at(const uint64_t* words, int32_t x, int32_t z) {
  const ValueBlock block = unpack_head(words[block_of(x, z)]);
  const auto column = static_cast<uint32_t>(x & 7), row = static_cast<uint32_t>(z & 7);
  const auto sloped = [&](uint32_t i, uint32_t k) {
    return block.base + static_cast<uint32_t>(slope_part(block, i, k));
  };
  uint32_t middle = sloped(column, row), left = sloped(column - 1, row);
  uint32_t right = sloped(column + 1, row), up = sloped(column, row - 1);
  uint32_t down = sloped(column, row + 1);
  if (block.width != 0) {
    const uint64_t* payload = words + kValueHead + block.first;
    const auto rest = [&](uint32_t i, uint32_t k) { return rest_at(block, payload, i, k); };
    middle += rest(column, row);
    left += rest(column - 1, row);
    right += rest(column + 1, row);
    up += rest(column, row - 1);
    down += rest(column, row + 1);
  }
  const auto cut = [](uint32_t value) { return static_cast<uint16_t>(value); };
  return {cut(middle), cut(left), cut(right), cut(up), cut(down)};
}

/// All values of a level tile, row by row: 4096.
void unpack_values(const uint64_t* words, uint16_t* values);

/// Where the set at `offset` ends, or none if it does not lie within `words`.
std::optional<size_t> end_of_bits(std::span<const uint64_t> words, uint64_t offset);
/// True if a tile's values at `offset` lie within `words`.
bool values_fit(std::span<const uint64_t> words, uint64_t offset);

}  // namespace throng::world
