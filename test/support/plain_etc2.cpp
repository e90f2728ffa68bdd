// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "plain_etc2.h"

// Decodes one texel at a time, after [KDF].
namespace throng::test {
namespace {

using Block = std::array<uint8_t, 8>;

// Bits `high` to `low` of the block, of which bit 63 is the first byte's highest.
int field(const Block& block, int high, int low) {
  int value = 0;
  for (int bit = high; bit >= low; --bit) {
    value = value * 2 + (block[static_cast<size_t>(7 - bit / 8)] / (1 << bit % 8)) % 2;
  }
  return value;
}

// Fields of the same value that lie apart are read one after the other.
int joined(const Block& block, std::initializer_list<std::array<int, 2>> fields) {
  int value = 0;
  for (const auto& [high, low] : fields) {
    value = (value << (high - low + 1)) + field(block, high, low);
  }
  return value;
}

// From `bits` to eight by repeating them from the top.
int repeated(int value, int bits) { return (value << (8 - bits)) + (value >> (2 * bits - 8)); }

int limited(int value, int most) { return value < 0 ? 0 : value > most ? most : value; }

int second_base(const Block& block, int first_low) {
  const int delta = field(block, first_low - 1, first_low - 3);
  return field(block, first_low + 4, first_low) + (delta > 3 ? delta - 8 : delta);
}

bool overflows(int five) { return five < 0 || five > 31; }

PlainTexel lighter(int red, int green, int blue, int by) {
  return {limited(red + by, 255), limited(green + by, 255), limited(blue + by, 255), 255};
}

// By its two bits, the high one first.
int texel_index(const Block& block, int x, int y) {
  const int number = x * 4 + y;
  return 2 * field(block, 16 + number, 16 + number) + field(block, number, number);
}

constexpr int kDistance[8] = {3, 6, 11, 16, 23, 32, 41, 64};

PlainTexel t_texel(const Block& block, int index) {
  const int distance = kDistance[joined(block, {{35, 34}, {32, 32}})];
  const int r1 = repeated(joined(block, {{60, 59}, {57, 56}}), 4);
  const int g1 = repeated(field(block, 55, 52), 4), b1 = repeated(field(block, 51, 48), 4);
  const int r2 = repeated(field(block, 47, 44), 4), g2 = repeated(field(block, 43, 40), 4);
  const int b2 = repeated(field(block, 39, 36), 4);
  switch (index) {
    case 0:
      return lighter(r1, g1, b1, 0);
    case 1:
      return lighter(r2, g2, b2, distance);
    case 2:
      return lighter(r2, g2, b2, 0);
    default:
      return lighter(r2, g2, b2, -distance);
  }
}

PlainTexel h_texel(const Block& block, int index) {
  const int r1 = field(block, 62, 59), g1 = joined(block, {{58, 56}, {52, 52}});
  const int b1 = joined(block, {{51, 51}, {49, 47}});
  const int r2 = field(block, 46, 43), g2 = field(block, 42, 39), b2 = field(block, 38, 35);
  const bool first_is_larger = r1 * 256 + g1 * 16 + b1 >= r2 * 256 + g2 * 16 + b2;
  const int distance =
      kDistance[4 * field(block, 34, 34) + 2 * field(block, 32, 32) + (first_is_larger ? 1 : 0)];
  const int by = index == 0 || index == 2 ? distance : -distance;
  return index < 2 ? lighter(repeated(r1, 4), repeated(g1, 4), repeated(b1, 4), by)
                   : lighter(repeated(r2, 4), repeated(g2, 4), repeated(b2, 4), by);
}

int slope(int origin, int across, int down, int x, int y) {
  const int four = x * (across - origin) + y * (down - origin) + 4 * origin + 2;
  return limited(four < 0 ? -1 : four / 4, 255);
}

PlainTexel planar_texel(const Block& block, int x, int y) {
  const int ro = repeated(field(block, 62, 57), 6);
  const int go = repeated(joined(block, {{56, 56}, {54, 49}}), 7);
  const int bo = repeated(joined(block, {{48, 48}, {44, 43}, {41, 39}}), 6);
  const int rh = repeated(joined(block, {{38, 34}, {32, 32}}), 6);
  const int gh = repeated(field(block, 31, 25), 7), bh = repeated(field(block, 24, 19), 6);
  const int rv = repeated(field(block, 18, 13), 6), gv = repeated(field(block, 12, 6), 7);
  const int bv = repeated(field(block, 5, 0), 6);
  return {slope(ro, rh, rv, x, y), slope(go, gh, gv, x, y), slope(bo, bh, bv, x, y), 255};
}

// Individual and differential.
PlainTexel half_texel(const Block& block, bool by_difference, bool clear, int x, int y, int index) {
  constexpr int kTable[8][4] = {{-8, -2, 2, 8},       {-17, -5, 5, 17},    {-29, -9, 9, 29},
                                {-42, -13, 13, 42},   {-60, -18, 18, 60},  {-80, -24, 24, 80},
                                {-106, -33, 33, 106}, {-183, -47, 47, 183}};
  const bool flipped = field(block, 32, 32) == 1;
  const bool second = flipped ? y >= 2 : x >= 2;
  int base[3];
  for (int c = 0; c < 3; ++c) {
    const int top = 63 - 8 * c;
    if (by_difference) {
      base[c] = repeated(second ? second_base(block, top - 4) : field(block, top, top - 4), 5);
    } else {
      base[c] = repeated(second ? field(block, top - 4, top - 7) : field(block, top, top - 3), 4);
    }
  }
  const int* table = kTable[second ? field(block, 36, 34) : field(block, 39, 37)];
  // Indices 3, 2, 0, 1 name the table's columns from the left.
  const int column = index == 3 ? 0 : index == 2 ? 1 : index == 0 ? 2 : 3;
  const bool middle = column == 1 || column == 2;
  return lighter(base[0], base[1], base[2], clear && middle ? 0 : table[column]);
}

int eac_step(const Block& block, int x, int y) {
  constexpr int kTable[16][8] = {{-3, -6, -9, -15, 2, 5, 8, 14}, {-3, -7, -10, -13, 2, 6, 9, 12},
                                 {-2, -5, -8, -13, 1, 4, 7, 12}, {-2, -4, -6, -13, 1, 3, 5, 12},
                                 {-3, -6, -8, -12, 2, 5, 7, 11}, {-3, -7, -9, -11, 2, 6, 8, 10},
                                 {-4, -7, -8, -11, 3, 6, 7, 10}, {-3, -5, -8, -11, 2, 4, 7, 10},
                                 {-2, -6, -8, -10, 1, 5, 7, 9},  {-2, -5, -8, -10, 1, 4, 7, 9},
                                 {-2, -4, -8, -10, 1, 3, 7, 9},  {-2, -5, -7, -10, 1, 4, 6, 9},
                                 {-3, -4, -7, -10, 2, 3, 6, 9},  {-1, -2, -3, -10, 0, 1, 2, 9},
                                 {-4, -6, -8, -9, 3, 5, 7, 8},   {-3, -5, -7, -9, 2, 4, 6, 8}};
  const int top = 47 - 3 * (x * 4 + y);
  return kTable[field(block, 51, 48)][field(block, top, top - 2)];
}

}  // namespace

std::string plain_etc2_mode(const Block& block, bool punch) {
  if (!punch && field(block, 33, 33) == 0) return "individual";
  if (overflows(second_base(block, 59))) return "T";
  if (overflows(second_base(block, 51))) return "H";
  if (overflows(second_base(block, 43))) return "planar";
  return "differential";
}

PlainTexel plain_etc2(const Block& block, bool punch, int x, int y) {
  const std::string mode = plain_etc2_mode(block, punch);
  if (mode == "planar") return planar_texel(block, x, y);
  const int index = texel_index(block, x, y);
  const bool clear = punch && field(block, 33, 33) == 0;
  if (clear && index == 2) return {};
  if (mode == "T") return t_texel(block, index);
  if (mode == "H") return h_texel(block, index);
  return half_texel(block, mode == "differential", clear, x, y, index);
}

int plain_eac8(const Block& block, int x, int y) {
  return limited(field(block, 63, 56) + eac_step(block, x, y) * field(block, 55, 52), 255);
}

int plain_eac11(const Block& block, int x, int y) {
  const int factor = field(block, 55, 52);
  const int off = eac_step(block, x, y) * (factor == 0 ? 1 : 8 * factor);
  return limited(field(block, 63, 56) * 8 + 4 + off, 2047);
}

}  // namespace throng::test
