// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "world/cell_blocks.h"

#include <algorithm>

// Counts, unpacks and checks blocks of 8 x 8 cells: sets of bits, and values.
namespace throng::world {

uint32_t count_bits(const uint64_t* words) {
  auto cells = count_ones(words[1] & ~words[0]) * 64;
  for (size_t i = kBitHead; i < bit_words(words); ++i) {
    cells += count_ones(words[i]);
  }
  return cells;
}

uint32_t nth_bit(const uint64_t* words, uint32_t n) {
  for (uint32_t block = 0;; block += 8) {  // a row of blocks at a time
    std::array<uint64_t, 8> cells;
    uint32_t count = 0;
    for (uint32_t i = 0; i < 8; ++i) {
      cells[i] = block_cells(words, block + i);
      count += count_ones(cells[i]);
    }
    if (n >= count && block + 8 < kBlocks) {
      n -= count;
      continue;
    }
    for (uint32_t z = 0; z < 8; ++z) {
      uint64_t row = 0;
      for (uint32_t i = 0; i < 8; ++i) row |= (cells[i] >> (8 * z) & 0xff) << (8 * i);
      const uint32_t in_row = count_ones(row);
      if (n >= in_row && z < 7) {
        n -= in_row;
        continue;
      }
      for (; n > 0; --n) row &= row - 1;
      return (block + z) * 64 + static_cast<uint32_t>(std::countr_zero(row));
    }
  }
}

namespace {

// Swaps the bits of `lower` in one word with those `shift` higher in another.
void swap_bits(uint64_t& a, uint64_t& b, uint32_t shift, uint64_t lower) {
  const uint64_t changed = ((a >> shift) ^ b) & lower;
  b ^= changed;
  a ^= changed << shift;
}

// Byte z of word b becomes byte b of word z.
void transpose_bytes(uint64_t* words) {
  for (size_t i = 0; i < 4; ++i) swap_bits(words[i], words[i + 4], 32, 0x00000000ffffffff);
  for (const size_t i : {0, 1, 4, 5}) swap_bits(words[i], words[i + 2], 16, 0x0000ffff0000ffff);
  for (size_t i = 0; i < 8; i += 2) swap_bits(words[i], words[i + 1], 8, 0x00ff00ff00ff00ff);
}

}  // namespace

void unpack_bits(const uint64_t* words, CellRows& rows) {
  const uint64_t* next = words + kBitHead;
  for (uint32_t block = 0; block < kBlocks; block += 8) {  // a row of blocks at a time
    const uint64_t mixed = words[0] >> block & 0xff, full = words[1] >> block & 0xff;
    uint64_t* row = &rows[block];
    if (mixed == 0 && (full == 0 || full == 0xff)) {
      std::fill_n(row, 8, full == 0 ? 0 : ~uint64_t{0});
      continue;
    }
    for (uint32_t i = 0; i < 8; ++i) {
      row[i] = (mixed >> i & 1) != 0 ? *next++ : uint64_t{0} - (full >> i & 1);
    }
    transpose_bytes(row);
  }
}

void unpack_values(const uint64_t* words, uint16_t* values) {
  for (size_t b = 0; b < kBlocks; ++b) {
    const ValueBlock block = unpack_head(words[b]);
    const uint64_t* payload = words + kValueHead + block.first;
    const uint32_t mask = (1u << block.width) - 1;
    uint16_t* corner = values + b / 8 * 8 * 64 + b % 8 * 8;
    for (uint32_t z = 0; z < 8; ++z) {
      for (uint32_t x = 0; x < 8; ++x) {
        const uint32_t rest = block.width == 0 ? 0 : rest_at(block, payload, x, z);
        const bool hole = block.holes && block.width != 0 && rest == mask;
        const uint32_t value = block.base + static_cast<uint32_t>(slope_part(block, x, z)) + rest;
        corner[z * 64 + x] = hole ? kNoValue : static_cast<uint16_t>(value);
      }
    }
  }
}

std::optional<size_t> end_of_bits(std::span<const uint64_t> words, uint64_t offset) {
  if (offset > words.size() || words.size() - offset < kBitHead) return std::nullopt;
  const uint64_t end = offset + bit_words(words.data() + offset);
  if (end > words.size()) return std::nullopt;
  return end;
}

bool values_fit(std::span<const uint64_t> words, uint64_t offset) {
  if (offset > words.size() || words.size() - offset < kValueHead) return false;
  const size_t room = words.size() - offset - kValueHead;
  return std::all_of(&words[offset], &words[offset] + kValueHead, [&](uint64_t head) {
    const ValueBlock block = unpack_head(head);
    return block.width <= 16 && (block.width == 0 || block.first + size_t{block.width} <= room);
  });
}

}  // namespace throng::world
