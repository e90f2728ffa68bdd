// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "impostor/block_codec.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

// Encodes a block as two end colours and colours on the line between them. The ends start at the
// extremes along the axis of largest variance, are fitted to their texels by least squares, and are
// then moved by single steps of their quantised components while the error falls. Invisible texels
// have no weight, so all of a block's range serves the visible ones.
namespace throng::impostor {
namespace {

using Colour = std::array<int32_t, 3>;

// An end colour in 5, 6, 5 bits.
struct End {
  Colour c{};
  [[nodiscard]] uint16_t packed() const {
    return static_cast<uint16_t>(c[0] << 11 | c[1] << 5 | c[2]);
  }
  [[nodiscard]] Colour wide() const {
    return {c[0] << 3 | c[0] >> 2, c[1] << 2 | c[1] >> 4, c[2] << 3 | c[2] >> 2};
  }
};

constexpr Colour kLargest{31, 63, 31};

End unpack(uint16_t packed) { return {{packed >> 11, packed >> 5 & 63, packed & 31}}; }

End quantise(const std::array<double, 3>& colour) {
  End end;
  for (size_t k = 0; k < 3; ++k) {
    const double steps = std::clamp(colour[k], 0.0, 255.0) * kLargest[k] / 255;
    end.c[k] = static_cast<int32_t>(steps + 0.5);
  }
  return end;
}

// The colours of a block: the two ends, then two between them, or one and a hole.
std::array<Colour, 4> palette(const End& a, const End& b, bool three) {
  const Colour x = a.wide(), y = b.wide();
  std::array<Colour, 4> out{x, y, {}, {}};
  for (size_t k = 0; k < 3; ++k) {
    out[2][k] = three ? (x[k] + y[k]) / 2 : (2 * x[k] + y[k]) / 3;
    out[3][k] = three ? 0 : (x[k] + 2 * y[k]) / 3;
  }
  return out;
}

struct Fit {
  End a, b;
  std::array<uint8_t, 16> index{};
  int64_t error = INT64_MAX;
};

// The texels with weight.
struct Seen {
  std::array<Colour, 16> colour{};
  std::array<int32_t, 16> weight{};
  std::array<uint8_t, 16> place{};
  size_t count = 0;
};

void fit_indices(const Seen& seen, bool three, Fit& fit) {
  const auto colours = palette(fit.a, fit.b, three);
  fit.error = 0;
  for (size_t i = 0; i < seen.count; ++i) {
    int32_t best = INT32_MAX;
    for (uint8_t p = 0; p < (three ? 3 : 4); ++p) {
      const int32_t r = seen.colour[i][0] - colours[p][0];
      const int32_t g = seen.colour[i][1] - colours[p][1];
      const int32_t b = seen.colour[i][2] - colours[p][2];
      const int32_t error = r * r + g * g + b * b;
      if (error >= best) continue;
      best = error;
      fit.index[i] = p;
    }
    fit.error += int64_t{best} * seen.weight[i];
  }
}

// The ends that serve the chosen indices best.
bool min_squares(const Seen& seen, bool three, const Fit& fit, std::array<double, 3>& a,
                 std::array<double, 3>& b) {
  const double share_of_a[4] = {1, 0, three ? 0.5 : 2.0 / 3, 1.0 / 3};
  double aa = 0, ab = 0, bb = 0;
  std::array<double, 3> ax{}, bx{};
  for (size_t i = 0; i < seen.count; ++i) {
    const double s = share_of_a[fit.index[i]], t = 1 - s;
    const double w = seen.weight[i];
    aa += w * s * s, ab += w * s * t, bb += w * t * t;
    for (size_t k = 0; k < 3; ++k) {
      ax[k] += w * s * seen.colour[i][k];
      bx[k] += w * t * seen.colour[i][k];
    }
  }
  const double determinant = aa * bb - ab * ab;
  if (std::fabs(determinant) < 1e-9) return false;
  for (size_t k = 0; k < 3; ++k) {
    a[k] = (ax[k] * bb - bx[k] * ab) / determinant;
    b[k] = (bx[k] * aa - ax[k] * ab) / determinant;
  }
  return true;
}

// Extremes along the axis of largest variance, by power iteration.
void first_ends(const Seen& seen, End& low, End& high) {
  std::array<double, 3> mean{};
  for (size_t i = 0; i < seen.count; ++i) {
    for (size_t k = 0; k < 3; ++k) mean[k] += seen.colour[i][k] / static_cast<double>(seen.count);
  }
  double variance[3][3] = {};
  for (size_t i = 0; i < seen.count; ++i) {
    for (size_t r = 0; r < 3; ++r) {
      for (size_t c = 0; c < 3; ++c) {
        variance[r][c] += (seen.colour[i][r] - mean[r]) * (seen.colour[i][c] - mean[c]);
      }
    }
  }
  std::array<double, 3> axis{1, 1.1,
                             0.9};  // Nearly even, so that no pure colour is perpendicular to it.
  for (int round = 0; round < 8; ++round) {
    std::array<double, 3> next{};
    double largest = 0;
    for (size_t r = 0; r < 3; ++r) {
      for (size_t c = 0; c < 3; ++c) next[r] += variance[r][c] * axis[c];
      largest = std::max(largest, std::fabs(next[r]));
    }
    if (largest == 0) break;
    for (size_t k = 0; k < 3; ++k) axis[k] = next[k] / largest;
  }
  const auto along = [&](size_t i) {
    return seen.colour[i][0] * axis[0] + seen.colour[i][1] * axis[1] + seen.colour[i][2] * axis[2];
  };
  size_t first = 0, last = 0;
  for (size_t i = 1; i < seen.count; ++i) {
    if (along(i) < along(first)) first = i;
    if (along(i) > along(last)) last = i;
  }
  const auto end_of = [&](size_t i) {
    return quantise({static_cast<double>(seen.colour[i][0]), static_cast<double>(seen.colour[i][1]),
                     static_cast<double>(seen.colour[i][2])});
  };
  low = end_of(first);
  high = end_of(last);
}

Fit fit_colours(const Seen& seen, bool three) {
  Fit best;
  first_ends(seen, best.a, best.b);
  fit_indices(seen, three, best);
  for (int round = 0; round < 4 && best.error > 0; ++round) {
    std::array<double, 3> a{}, b{};
    if (!min_squares(seen, three, best, a, b)) break;
    Fit next;
    next.a = quantise(a);
    next.b = quantise(b);
    fit_indices(seen, three, next);
    if (next.error >= best.error) break;
    best = next;
  }
  for (bool better = best.error > 0; better;) {
    better = false;
    for (size_t k = 0; k < 12; ++k) {
      Fit next = best;
      int32_t& step = (k < 6 ? next.a : next.b).c[k % 3];
      step += k / 3 % 2 == 0 ? 1 : -1;
      if (step < 0 || step > kLargest[k % 3]) continue;
      fit_indices(seen, three, next);
      if (next.error >= best.error) continue;
      best = next;
      better = best.error > 0;
    }
  }
  return best;
}

// The eight values of a BC4 block: six between its ends, or four and both limits.
std::array<int32_t, 8> ramp(int32_t a, int32_t b) {
  std::array<int32_t, 8> out{a, b};
  if (a > b) {
    for (int32_t i = 1; i < 7; ++i) out[static_cast<size_t>(i) + 1] = ((7 - i) * a + i * b) / 7;
  } else {
    for (int32_t i = 1; i < 5; ++i) out[static_cast<size_t>(i) + 1] = ((5 - i) * a + i * b) / 5;
    out[6] = 0;
    out[7] = 255;
  }
  return out;
}

struct ChannelFit {
  int32_t a = 0, b = 0;
  std::array<uint8_t, 16> index{};
  int64_t error = INT64_MAX;
};

ChannelFit fit_channel(const ChannelBlock& block, const TexelWeights& weights, int32_t a,
                       int32_t b) {
  ChannelFit fit{.a = a, .b = b, .index = {}, .error = 0};
  const auto values = ramp(a, b);
  for (size_t i = 0; i < 16; ++i) {
    if (weights[i] == 0) continue;
    int32_t best = INT32_MAX;
    for (uint8_t p = 0; p < 8; ++p) {
      const int32_t off = block[i] - values[p];
      if (off * off >= best) continue;
      best = off * off;
      fit.index[i] = p;
    }
    fit.error += best;
  }
  return fit;
}

}  // namespace

Bytes8 encode_bc1(const ColourBlock& block, const TexelWeights& weights, bool holes) {
  Seen seen;
  bool three = false;
  for (uint8_t i = 0; i < 16; ++i) {
    three = three || (holes && block[i][3] < 128);
    if (weights[i] == 0 || (holes && block[i][3] < 128)) continue;
    seen.weight[seen.count] = weights[i];
    seen.colour[seen.count] = {block[i][0], block[i][1], block[i][2]};
    seen.place[seen.count++] = i;
  }
  Fit fit;
  if (seen.count > 0) fit = fit_colours(seen, three);
  // The order of the ends gives the kind of block. Equal ends always mean the kind with a hole; the
  // first colour then serves all texels.
  uint16_t a = fit.a.packed(), b = fit.b.packed();
  std::array<uint8_t, 16> index{};
  for (size_t i = 0; i < seen.count; ++i) index[seen.place[i]] = fit.index[i];
  if (a == b) {
    index.fill(0);
  } else if (three ? a > b : a < b) {
    std::swap(a, b);
    for (uint8_t& i : index) i = three && i == 2 ? 2 : static_cast<uint8_t>(i ^ 1);
  }
  uint32_t bits = 0;
  for (size_t i = 0; i < 16; ++i) {
    const bool hole = holes && block[i][3] < 128;
    bits |= static_cast<uint32_t>(hole ? 3 : index[i]) << (2 * i);
  }
  return {static_cast<uint8_t>(a),          static_cast<uint8_t>(a >> 8),
          static_cast<uint8_t>(b),          static_cast<uint8_t>(b >> 8),
          static_cast<uint8_t>(bits),       static_cast<uint8_t>(bits >> 8),
          static_cast<uint8_t>(bits >> 16), static_cast<uint8_t>(bits >> 24)};
}

void decode_bc1(const Bytes8& bytes, bool holes, ColourBlock& block) {
  const auto a = static_cast<uint16_t>(bytes[0] | bytes[1] << 8);
  const auto b = static_cast<uint16_t>(bytes[2] | bytes[3] << 8);
  const bool three = holes && a <= b;
  const auto colours = palette(unpack(a), unpack(b), three);
  for (size_t i = 0; i < 16; ++i) {
    const auto index = static_cast<size_t>(bytes[4 + i / 4] >> (i % 4 * 2) & 3);
    for (size_t k = 0; k < 3; ++k) block[i][k] = static_cast<uint8_t>(colours[index][k]);
    if (holes) block[i][3] = three && index == 3 ? 0 : 255;
  }
}

Bytes8 encode_bc4(const ChannelBlock& block, const TexelWeights& weights) {
  int32_t low = 256, high = -1, inner_low = 256, inner_high = -1;
  for (size_t i = 0; i < 16; ++i) {
    if (weights[i] == 0) continue;
    const int32_t value = block[i];
    low = std::min(low, value), high = std::max(high, value);
    if (value == 0 || value == 255) continue;
    inner_low = std::min(inner_low, value), inner_high = std::max(inner_high, value);
  }
  if (high < 0) return {};
  if (inner_high < 0) inner_low = inner_high = 128;
  ChannelFit best = fit_channel(block, weights, inner_low, inner_high);
  if (high > low) {
    const ChannelFit wide = fit_channel(block, weights, high, low);
    if (wide.error < best.error) best = wide;
  }
  for (bool better = best.error > 0; better;) {
    better = false;
    for (int32_t k = 0; k < 4; ++k) {
      const int32_t step = k % 2 == 0 ? 1 : -1;
      const int32_t a = best.a + (k < 2 ? step : 0), b = best.b + (k < 2 ? 0 : step);
      if (a < 0 || b < 0 || a > 255 || b > 255) continue;
      const ChannelFit next = fit_channel(block, weights, a, b);
      if (next.error >= best.error) continue;
      best = next;
      better = best.error > 0;
    }
  }
  uint64_t bits = 0;
  for (size_t i = 0; i < 16; ++i) bits |= uint64_t{best.index[i]} << (3 * i);
  Bytes8 out{static_cast<uint8_t>(best.a), static_cast<uint8_t>(best.b)};
  for (size_t i = 0; i < 6; ++i) out[2 + i] = static_cast<uint8_t>(bits >> (8 * i));
  return out;
}

void decode_bc4(const Bytes8& bytes, ChannelBlock& block) {
  const auto values = ramp(bytes[0], bytes[1]);
  uint64_t bits = 0;
  for (size_t i = 0; i < 6; ++i) bits |= uint64_t{bytes[2 + i]} << (8 * i);
  for (size_t i = 0; i < 16; ++i) block[i] = static_cast<uint8_t>(values[bits >> (3 * i) & 7]);
}

}  // namespace throng::impostor
