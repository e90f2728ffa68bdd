// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "impostor/etc2_codec.h"
#include "impostor/etc2_tables.h"

// Tries all five modes of a block and writes the one with the smallest error. A mode of bases and
// steps is fitted like k-means: texels choose steps, then each base becomes the mean of the texels
// that chose it, less their steps; at last bases move by single steps of their quantised components
// while the error falls. Source of the modes: [KDF].
namespace throng::impostor {
namespace {

using namespace etc2;

// The texels by component; those that do not count have no weight. Compilers vectorise loops over
// all of them in whole numbers that a float stores exactly.
struct BlockTexels {
  std::array<std::array<float, 16>, 3> part{};
  std::array<int32_t, 16> weight{};
  std::array<uint8_t, 16> place{};  // By column.
  size_t count = 0;
  void add(const Colour& colour, int32_t heavy, uint8_t by_column) {
    for (size_t k = 0; k < 3; ++k) part[k][count] = static_cast<float>(colour[k]);
    weight[count] = heavy;
    place[count++] = by_column;
  }
  [[nodiscard]] int32_t value(size_t i, size_t k) const { return static_cast<int32_t>(part[k][i]); }
};

// Which of the four colours each texel chooses.
struct Choice {
  std::array<int32_t, 16> index{};
  int64_t error = INT64_MAX;
};

// A block, with indices by place.
struct Block {
  uint64_t word = 0;
  int64_t error = INT64_MAX;
};

using Exact = std::array<double, 3>;

int32_t quantise(double value, int32_t largest) {
  return static_cast<int32_t>(std::clamp(value, 0.0, 255.0) * largest / 255 + 0.5);
}

Colour quantise(const Exact& value, int32_t largest) {
  return {quantise(value[0], largest), quantise(value[1], largest), quantise(value[2], largest)};
}

// With `hole`, index 2 is not available.
Choice choose(const BlockTexels& seen, std::array<Colour, 4> colours, bool hole) {
  if (hole) colours[2] = colours[0];  // Of two equal colours the first is chosen.
  std::array<std::array<float, 4>, 3> part{};
  for (size_t p = 0; p < 4; ++p) {
    for (size_t k = 0; k < 3; ++k) part[k][p] = static_cast<float>(colours[p][k]);
  }
  Choice choice;
  std::array<int32_t, 16> error{};
  const size_t texels = seen.count <= 8 ? 8 : 16;
  for (size_t i = 0; i < texels; ++i) {
    float best = 1e9F;
    int32_t index = 0;
    for (size_t p = 0; p < 4; ++p) {
      const float r = seen.part[0][i] - part[0][p], g = seen.part[1][i] - part[1][p];
      const float b = seen.part[2][i] - part[2][p];
      const float off = r * r + g * g + b * b;
      index = off < best ? static_cast<int32_t>(p) : index;
      best = off < best ? off : best;
    }
    choice.index[i] = index;
    error[i] = static_cast<int32_t>(best) * seen.weight[i];
  }
  choice.error = 0;
  for (size_t i = 0; i < seen.count; ++i) choice.error += error[i];
  return choice;
}

// The mean, less its step, of the texels that chose an index for which `mine` holds.
template <class Mine>
std::optional<Exact> mean_less_steps(const BlockTexels& seen, const Choice& choice,
                                     const std::array<int32_t, 4>& steps, Mine mine) {
  Colour sum{};
  int32_t weight = 0;
  for (size_t i = 0; i < seen.count; ++i) {
    const int32_t index = choice.index[i];
    if (!mine(index)) continue;
    const int32_t step = steps[static_cast<size_t>(index)];
    for (size_t k = 0; k < 3; ++k) sum[k] += seen.weight[i] * (seen.value(i, k) - step);
    weight += seen.weight[i];
  }
  if (weight == 0) return std::nullopt;
  Exact mean{};
  for (size_t k = 0; k < 3; ++k) mean[k] = static_cast<double>(sum[k]) / weight;
  return mean;
}

uint64_t field(int32_t value, int32_t low) { return static_cast<uint64_t>(value) << low; }

uint64_t index_bits(const BlockTexels& seen, const Choice& choice) {
  uint64_t word = 0;
  for (size_t i = 0; i < seen.count; ++i) {
    word |=
        field(choice.index[i] >> 1, 16 + seen.place[i]) | field(choice.index[i] & 1, seen.place[i]);
  }
  return word;
}

// Half a block: one base and one table of steps.

struct Half {
  Colour base{};
  size_t table = 0;
  Choice choice;
};

// The bases that a half may have. `largest`: of a component, 15 or 31.
struct Bases {
  int32_t largest = 31;
  Colour low{0, 0, 0}, high{31, 31, 31};
  [[nodiscard]] Colour nearest(const Exact& value) const {
    Colour base = quantise(value, largest);
    for (size_t k = 0; k < 3; ++k) base[k] = std::clamp(base[k], low[k], high[k]);
    return base;
  }
  [[nodiscard]] bool has(const Colour& base) const {
    bool inside = true;
    for (size_t k = 0; k < 3; ++k) inside = inside && base[k] >= low[k] && base[k] <= high[k];
    return inside;
  }
  [[nodiscard]] Colour wide(const Colour& base) const {
    const auto widen = largest == 15 ? widen4 : widen5;
    return {widen(base[0]), widen(base[1]), widen(base[2])};
  }
};

constexpr Bases kAnyOf4{15, {0, 0, 0}, {15, 15, 15}}, kAnyOf5{31, {0, 0, 0}, {31, 31, 31}};

Bases near(const Colour& base, int32_t below, int32_t above) {
  Bases out;
  for (size_t k = 0; k < 3; ++k) {
    out.low[k] = std::max(0, base[k] - below);
    out.high[k] = std::min(31, base[k] + above);
  }
  return out;
}

void try_half(const BlockTexels& seen, const Bases& bases, const Colour& base, size_t table,
              bool hole, Half& best) {
  const Choice choice = choose(seen, half_colours(bases.wide(base), table, hole), hole);
  if (choice.error < best.choice.error) best = {base, table, choice};
}

Half fit_half(const BlockTexels& seen, const Bases& bases, bool hole) {
  Half best;
  best.base = bases.low;
  if (seen.count == 0) {
    best.choice.error = 0;
    return best;
  }
  const auto any = [](int32_t) { return true; };
  const Exact middle = *mean_less_steps(seen, best.choice, {}, any);
  for (size_t table = 0; table < 8 && best.choice.error > 0; ++table) {
    const int32_t close = hole ? 0 : kSteps[table][0], far = kSteps[table][1];
    Half own{.base = bases.nearest(middle), .table = table, .choice = {}};
    for (int32_t round = 0; round < 3; ++round) {
      const Choice choice = choose(seen, half_colours(bases.wide(own.base), table, hole), hole);
      if (choice.error >= own.choice.error) break;
      own.choice = choice;
      if (choice.error < best.choice.error) best = own;
      own.base = bases.nearest(*mean_less_steps(seen, choice, {close, far, -close, -far}, any));
    }
  }
  for (int64_t before = INT64_MAX; best.choice.error > 0 && best.choice.error < before;) {
    before = best.choice.error;
    for (size_t k = 0; k < 6; ++k) {
      Colour base = best.base;
      base[k % 3] += k < 3 ? 1 : -1;
      if (bases.has(base)) try_half(seen, bases, base, best.table, hole, best);
    }
    for (const size_t table : {best.table - 1, best.table + 1}) {
      if (table < 8) try_half(seen, bases, best.base, table, hole, best);
    }
  }
  return best;
}

uint64_t half_bits(const BlockTexels& first, const BlockTexels& second, const Half& a,
                   const Half& b, bool rows) {
  return index_bits(first, a.choice) | index_bits(second, b.choice) |
         field(static_cast<int32_t>(a.table), 37) | field(static_cast<int32_t>(b.table), 34) |
         field(rows ? 1 : 0, 32);
}

// Two halves beside each other or, with `rows`, one above the other. `hole`: some texel is one.
Block fit_halves(const BlockTexels& seen, bool holes, bool hole, bool rows) {
  BlockTexels first, second;
  for (size_t i = 0; i < seen.count; ++i) {
    BlockTexels& to = (rows ? seen.place[i] % 4 >= 2 : seen.place[i] >= 8) ? second : first;
    to.add({seen.value(i, 0), seen.value(i, 1), seen.value(i, 2)}, seen.weight[i], seen.place[i]);
  }
  Half a = fit_half(first, kAnyOf5, hole), b = fit_half(second, kAnyOf5, hole);
  // The second base is stored as a difference from the first: -4 to 3.
  if (first.count == 0) a.base = b.base;
  if (second.count == 0) b.base = a.base;
  const bool apart = !near(a.base, 4, 3).has(b.base);
  if (apart) {
    const Half b_near = fit_half(second, near(a.base, 4, 3), hole);
    const Half a_near = fit_half(first, near(b.base, 3, 4), hole);
    if (a.choice.error + b_near.choice.error <= a_near.choice.error + b.choice.error) {
      b = b_near;
    } else {
      a = a_near;
    }
  }
  Block out;
  out.error = a.choice.error + b.choice.error;
  out.word = half_bits(first, second, a, b, rows) | field(hole ? 0 : 1, 33);
  for (int32_t k = 0; k < 3; ++k) {
    const auto c = static_cast<size_t>(k);
    out.word |= field(a.base[c], 59 - 8 * k) | field((b.base[c] - a.base[c]) & 7, 56 - 8 * k);
  }
  if (!apart || holes) return out;
  // The distance of bases of four bits is not limited.
  a = fit_half(first, kAnyOf4, false);
  b = fit_half(second, kAnyOf4, false);
  if (a.choice.error + b.choice.error >= out.error) return out;
  out.error = a.choice.error + b.choice.error;
  out.word = half_bits(first, second, a, b, rows);
  for (int32_t k = 0; k < 3; ++k) {
    const auto c = static_cast<size_t>(k);
    out.word |= field(a.base[c], 60 - 8 * k) | field(b.base[c], 56 - 8 * k);
  }
  return out;
}

// The modes T and H: two bases for the whole block. T takes the first as it is and the second at
// three steps, H both at two.

struct Pair {
  bool h = false;
  Colour a{}, b{};  // Of 4 bits.
  int32_t distance = 0;
  Choice choice;
};

std::array<int32_t, 4> steps_of(const Pair& pair) {
  const int32_t d = kDistances[pair.distance];
  return pair.h ? std::array<int32_t, 4>{d, -d, d, -d} : std::array<int32_t, 4>{0, d, 0, -d};
}

// In H the order of the bases is a bit of the distance; without holes they can be exchanged.
bool can_be_written(const Pair& pair, bool hole) {
  if (!pair.h) return true;
  if (pair.a == pair.b) return pair.distance % 2 == 1;
  return !hole || (pair.a > pair.b) == (pair.distance % 2 == 1);
}

void try_pair(const BlockTexels& seen, bool hole, Pair pair, Pair& best) {
  if (!can_be_written(pair, hole)) return;
  const Colour a{widen4(pair.a[0]), widen4(pair.a[1]), widen4(pair.a[2])};
  const Colour b{widen4(pair.b[0]), widen4(pair.b[1]), widen4(pair.b[2])};
  const int32_t d = kDistances[pair.distance];
  pair.choice = choose(seen, pair.h ? h_colours(a, b, d) : t_colours(a, b, d), hole);
  if (pair.choice.error < best.choice.error) best = pair;
}

void improve_pair(const BlockTexels& seen, bool hole, Pair& best) {
  for (int32_t round = 0; round < 3 && best.choice.error > 0; ++round) {
    const int64_t before = best.choice.error;
    const auto of_a = [&](int32_t index) { return best.h ? index < 2 : index == 0; };
    const auto a = mean_less_steps(seen, best.choice, steps_of(best), of_a);
    const auto b = mean_less_steps(seen, best.choice, steps_of(best),
                                   [&](int32_t index) { return !of_a(index); });
    Pair next = best;
    if (a) next.a = quantise(*a, 15);
    if (b) next.b = quantise(*b, 15);
    try_pair(seen, hole, next, best);
    if (best.choice.error == before) break;
  }
  for (int64_t before = INT64_MAX; best.choice.error > 0 && best.choice.error < before;) {
    before = best.choice.error;
    for (size_t k = 0; k < 14; ++k) {
      Pair next = best;
      int32_t& part = k < 6 ? next.a[k % 3] : k < 12 ? next.b[k % 3] : next.distance;
      part += k % 6 < 3 && k != 13 ? 1 : -1;
      if (part < 0 || part > (k < 12 ? 15 : 7)) continue;
      try_pair(seen, hole, next, best);
    }
  }
}

// Two groups of texels, by which of the two that are furthest apart is nearer. `by_hue` ignores
// lightness, along which the steps lie anyway.
std::array<Exact, 2> two_groups(const BlockTexels& seen, bool by_hue) {
  std::array<Exact, 16> at{};
  for (size_t i = 0; i < seen.count; ++i) {
    for (size_t k = 0; k < 3; ++k) at[i][k] = seen.part[k][i];
    const double grey = by_hue ? (at[i][0] + at[i][1] + at[i][2]) / 3 : 0;
    for (double& part : at[i]) part -= grey;
  }
  const auto apart = [](const Exact& x, const Exact& y) {
    return (x[0] - y[0]) * (x[0] - y[0]) + (x[1] - y[1]) * (x[1] - y[1]) +
           (x[2] - y[2]) * (x[2] - y[2]);
  };
  std::array<Exact, 2> middle{at[0], at[0]};
  double furthest = -1;
  for (size_t i = 0; i < seen.count; ++i) {
    for (size_t j = 0; j < i; ++j) {
      if (apart(at[i], at[j]) <= furthest) continue;
      furthest = apart(at[i], at[j]);
      middle = {at[j], at[i]};
    }
  }
  std::array<Exact, 2> mean{};
  for (int32_t round = 0; round < 3; ++round) {
    std::array<Exact, 2> sum{}, place{};
    std::array<double, 2> weight{};
    for (size_t i = 0; i < seen.count; ++i) {
      const size_t group = apart(at[i], middle[1]) < apart(at[i], middle[0]) ? 1 : 0;
      for (size_t k = 0; k < 3; ++k) {
        sum[group][k] += seen.weight[i] * static_cast<double>(seen.part[k][i]);
        place[group][k] += seen.weight[i] * at[i][k];
      }
      weight[group] += seen.weight[i];
    }
    for (size_t g = 0; g < 2; ++g) {
      if (weight[g] == 0) continue;
      for (size_t k = 0; k < 3; ++k) {
        mean[g][k] = sum[g][k] / weight[g];
        middle[g][k] = place[g][k] / weight[g];
      }
    }
  }
  return mean;
}

// The bit that keeps a component in its range: five bits, the highest of them free, from `low` + 3
// up, and three from `low`.
uint64_t stay(uint64_t word, int32_t low) {
  return bits(word, low + 3, 4) + signed3(bits(word, low, 3)) < 0 ? field(1, low + 7) : 0;
}

// The bits that send a component, of which two and two bits are given, out of its range: over it
// where these suffice, else under it.
uint64_t leave(uint64_t word, int32_t low) {
  return bits(word, low + 3, 2) + bits(word, low, 2) >= 4 ? field(7, low + 5) : field(1, low + 2);
}

uint64_t t_bits(const Pair& pair) {
  const uint64_t word = field(pair.a[0] >> 2, 59) | field(pair.a[0] & 3, 56) |
                        field(pair.a[1], 52) | field(pair.a[2], 48) | field(pair.b[0], 44) |
                        field(pair.b[1], 40) | field(pair.b[2], 36) |
                        field(pair.distance >> 1, 34) | field(pair.distance & 1, 32);
  return word | leave(word, 56);
}

uint64_t h_bits(const Pair& pair) {
  const uint64_t word = field(pair.a[0], 59) | field(pair.a[1] >> 1, 56) |
                        field(pair.a[1] & 1, 52) | field(pair.a[2] >> 3, 51) |
                        field(pair.a[2] & 7, 47) | field(pair.b[0], 43) | field(pair.b[1], 39) |
                        field(pair.b[2], 35) | field(pair.distance >> 2, 34) |
                        field(pair.distance >> 1 & 1, 32);
  return word | stay(word, 56) | leave(word, 48);
}

Block fit_pair(const BlockTexels& seen, bool hole, bool h) {
  Pair best;
  for (const bool by_hue : {false, true}) {
    Pair own;
    const auto middle = two_groups(seen, by_hue);
    for (size_t turn = 0; turn < 2; ++turn) {
      // Without holes the order of the bases does not change H.
      if (turn == 1 && h && !hole) break;
      for (int32_t distance = 0; distance < 8; ++distance) {
        try_pair(seen, hole,
                 {.h = h,
                  .a = quantise(middle[turn], 15),
                  .b = quantise(middle[1 - turn], 15),
                  .distance = distance,
                  .choice = {}},
                 own);
      }
    }
    if (own.choice.error == INT64_MAX) continue;
    improve_pair(seen, hole, own);
    if (own.choice.error < best.choice.error) best = own;
  }
  if (best.choice.error == INT64_MAX) return {};
  if (h && (best.a >= best.b) != (best.distance % 2 == 1)) {
    std::swap(best.a, best.b);
    for (int32_t& index : best.choice.index) index ^= 2;
  }
  return {
      (h ? h_bits(best) : t_bits(best)) | field(hole ? 0 : 1, 33) | index_bits(seen, best.choice),
      best.choice.error};
}

// Planar: a slope, given by the colours at the block's corner and beyond its ends.

// One component: at the corner, across and down. Six bits each, or seven.
struct Slope {
  std::array<int32_t, 3> end{};
  int64_t error = INT64_MAX;
};

int64_t slope_error(const BlockTexels& seen, size_t k, const std::array<int32_t, 3>& end) {
  const auto widen = k == 1 ? widen7 : widen6;
  const int32_t corner = widen(end[0]), across = widen(end[1]), down = widen(end[2]);
  int64_t error = 0;
  for (size_t i = 0; i < seen.count; ++i) {
    const int32_t x = seen.place[i] / 4, y = seen.place[i] % 4;
    const int32_t value =
        byte_of((x * (across - corner) + y * (down - corner) + 4 * corner + 2) >> 2);
    const int32_t off = seen.value(i, k) - value;
    error += int64_t{off * off} * seen.weight[i];
  }
  return error;
}

Slope fit_slope(const BlockTexels& seen, size_t k) {
  // The plane of least squares about the mean, regularised for blocks with too few texels.
  double weight = 0, mx = 0, my = 0, mc = 0;
  for (size_t i = 0; i < seen.count; ++i) {
    const double w = seen.weight[i];
    weight += w;
    mx += w * (seen.place[i] / 4);
    my += w * (seen.place[i] % 4);
    mc += w * static_cast<double>(seen.part[k][i]);
  }
  mx /= weight, my /= weight, mc /= weight;
  double xx = weight * 1e-3, xy = 0, yy = weight * 1e-3, xc = 0, yc = 0;
  for (size_t i = 0; i < seen.count; ++i) {
    const double w = seen.weight[i], x = seen.place[i] / 4 - mx, y = seen.place[i] % 4 - my;
    const double c = static_cast<double>(seen.part[k][i]) - mc;
    xx += w * x * x, xy += w * x * y, yy += w * y * y, xc += w * x * c, yc += w * y * c;
  }
  const double determinant = xx * yy - xy * xy;
  const double across = (xc * yy - yc * xy) / determinant;
  const double down = (yc * xx - xc * xy) / determinant;
  const double corner = mc - across * mx - down * my;
  const int32_t largest = k == 1 ? 127 : 63;
  Slope best;
  best.end = {quantise(corner, largest), quantise(corner + 4 * across, largest),
              quantise(corner + 4 * down, largest)};
  best.error = slope_error(seen, k, best.end);
  for (int64_t before = INT64_MAX; best.error > 0 && best.error < before;) {
    before = best.error;
    for (size_t step = 0; step < 6; ++step) {
      Slope next = best;
      int32_t& part = next.end[step % 3];
      part += step < 3 ? 1 : -1;
      if (part < 0 || part > largest) continue;
      next.error = slope_error(seen, k, next.end);
      if (next.error < best.error) best = next;
    }
  }
  return best;
}

Block fit_planar(const BlockTexels& seen) {
  const Slope r = fit_slope(seen, 0), g = fit_slope(seen, 1), b = fit_slope(seen, 2);
  uint64_t word = field(r.end[0], 57) | field(g.end[0] >> 6, 56) | field(g.end[0] & 63, 49) |
                  field(b.end[0] >> 5, 48) | field(b.end[0] >> 3 & 3, 43) |
                  field(b.end[0] & 7, 39) | field(r.end[1] >> 1, 34) | field(1, 33) |
                  field(r.end[1] & 1, 32) | field(g.end[1], 25) | field(b.end[1], 19) |
                  field(r.end[2], 13) | field(g.end[2], 6) | field(b.end[2], 0);
  word |= stay(word, 56) | stay(word, 48) | leave(word, 40);
  return {word, r.error + g.error + b.error};
}

}  // namespace

Bytes8 encode_etc2(const ColourBlock& block, const TexelWeights& weights, bool holes) {
  BlockTexels seen;
  uint64_t hole_bits = 0;
  for (size_t i = 0; i < 16; ++i) {
    const bool is_hole = holes && block[i][3] < 128;
    const size_t place = turned(i);
    if (is_hole) hole_bits |= uint64_t{1} << (16 + place);  // Index 2.
    if (weights[i] == 0 || is_hole) continue;
    seen.add({block[i][0], block[i][1], block[i][2]}, weights[i], static_cast<uint8_t>(place));
  }
  const bool hole = hole_bits != 0;
  if (seen.count == 0) return bytes_of(hole_bits | field(holes && !hole ? 1 : 0, 33));
  Block best;
  const auto take = [&](const Block& other) {
    if (other.error < best.error) best = other;
  };
  take(fit_halves(seen, holes, hole, false));
  if (best.error > 0) take(fit_halves(seen, holes, hole, true));
  if (best.error > 0 && !hole) take(fit_planar(seen));
  for (const bool h : {false, true}) {
    if (best.error > 0) take(fit_pair(seen, hole, h));
  }
  return bytes_of(best.word | hole_bits);
}

}  // namespace throng::impostor
