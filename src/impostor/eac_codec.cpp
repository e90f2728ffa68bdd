// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <algorithm>

#include "impostor/etc2_codec.h"
#include "impostor/etc2_tables.h"

// Source: [KDF]. A block is a base, a factor, and one of sixteen tables of eight steps.
// For each table, the factors that just span the values are tried, with a base that centres them,
// and the best of all is then moved by single steps for as long as the error falls.
namespace throng {
namespace {

using namespace etc2;

// Which of the two kinds of block: 8 bits, or 11.
struct Kind {
  int32_t scale;   // Of a base.
  int32_t offset;  // Of a base.
  int32_t most;    // Largest value.
  int32_t factor;  // Smallest: encoders of 8 bits must not write 0.
};
constexpr Kind kEight{1, 0, 255, 1}, kEleven{8, 4, 2047, 0};

int32_t value_of(const Kind& kind, int32_t base, int32_t factor, size_t table, size_t index) {
  // A factor of zero means an eighth where there are bits for it.
  const int32_t step = factor == 0 && kind.scale > 1 ? 1 : factor * kind.scale;
  return std::clamp(base * kind.scale + kind.offset + channel_step(table, index) * step, 0,
                    kind.most);
}

struct Fit {
  int32_t base = 0, factor = 1;
  size_t table = 13;
  std::array<uint8_t, 16> index{};
  int64_t error = INT64_MAX;
};

// The texels that count.
struct Seen {
  std::array<int32_t, 16> value{};
  std::array<uint8_t, 16> place{};
  size_t count = 0;
  int32_t low = INT32_MAX, high = 0;
};

// Fits indices; gives up where the error is no less than `most`.
Fit fit_indices(const Kind& kind, const Seen& seen, int32_t base, int32_t factor, size_t table,
                int64_t most) {
  Fit fit{.base = base, .factor = factor, .table = table, .index = {}, .error = 0};
  std::array<int32_t, 8> values{};
  for (size_t p = 0; p < 8; ++p) values[p] = value_of(kind, base, factor, table, p);
  for (size_t i = 0; i < seen.count && fit.error < most; ++i) {
    int32_t best = INT32_MAX;
    for (uint8_t p = 0; p < 8; ++p) {
      const int32_t off = seen.value[i] - values[p];
      if (off * off >= best) continue;
      best = off * off;
      fit.index[i] = p;
    }
    fit.error += best;
  }
  return fit;
}

void try_fit(const Kind& kind, const Seen& seen, int32_t base, int32_t factor, size_t table,
             Fit& best) {
  if (base < 0 || base > 255 || factor < kind.factor || factor > 15) return;
  const Fit fit = fit_indices(kind, seen, base, factor, table, best.error);
  if (fit.error < best.error) best = fit;
}

Fit fit_channel(const Kind& kind, const Seen& seen) {
  Fit best;
  const int32_t range = seen.high - seen.low, middle = (seen.high + seen.low) / 2;
  for (size_t t = 0; t < 16 && best.error > 0; ++t) {
    const int32_t width = (-1 - 2 * kChannelSteps[t][3]) * kind.scale;  // Of the steps, by one.
    // A factor too small cuts the ends, one too large leaves steps unused: either may be better.
    const int32_t factor = range / width;
    for (int32_t f = factor; f <= factor + 2; ++f) {
      // Steps reach one further down than up, so the middle lies half a factor under the base.
      const int32_t base = (middle - kind.offset + f * kind.scale / 2) / kind.scale;
      for (int32_t b = base - 2; b <= base + 2; ++b) try_fit(kind, seen, b, f, t, best);
    }
    // The limits may cut what lies over an end: bases for which the far end still fits.
    if (seen.low > 0 && seen.high < kind.most) continue;
    const int32_t reach = kChannelSteps[t][3];
    for (int32_t f = std::max(1, factor / 2); f <= std::min(15, factor * 2 + 1); ++f) {
      try_fit(kind, seen, (seen.low - kind.offset) / kind.scale - reach * f, f, t, best);
      try_fit(kind, seen, (seen.high - kind.offset) / kind.scale + (reach + 1) * f, f, t, best);
    }
  }
  for (int64_t before = INT64_MAX; best.error > 0 && best.error < before;) {
    before = best.error;
    const Fit from = best;
    for (int32_t f = -1; f <= 1; ++f) {
      for (int32_t b = -2; b <= 2; ++b) {
        try_fit(kind, seen, from.base + b, from.factor + f, from.table, best);
      }
    }
  }
  return best;
}

Bytes8 encode(const Kind& kind, const ChannelBlock& block, const TexelWeights& weights) {
  Seen seen;
  for (uint8_t i = 0; i < 16; ++i) {
    if (weights[i] == 0) continue;
    const int32_t value = (2 * block[i] * kind.most + 255) / 510;
    seen.value[seen.count] = value;
    seen.place[seen.count++] = i;
    seen.low = std::min(seen.low, value);
    seen.high = std::max(seen.high, value);
  }
  Fit fit;
  if (seen.count > 0) fit = fit_channel(kind, seen);
  std::array<uint8_t, 16> index{};
  for (size_t i = 0; i < seen.count; ++i) index[turned(seen.place[i])] = fit.index[i];
  auto word = static_cast<uint64_t>(fit.base << 8 | fit.factor << 4) | fit.table;
  for (const uint8_t i : index) word = word << 3 | i;
  return bytes_of(word);
}

template <class Block>
void decode(const Kind& kind, const Bytes8& bytes, Block& block) {
  const uint64_t word = word_of(bytes);
  for (size_t i = 0; i < 16; ++i) {
    const auto index = static_cast<size_t>(bits(word, 45 - 3 * static_cast<int32_t>(i), 3));
    block[turned(i)] = static_cast<typename Block::value_type>(value_of(
        kind, bits(word, 56, 8), bits(word, 52, 4), static_cast<size_t>(bits(word, 48, 4)), index));
  }
}

}  // namespace

Bytes8 encode_eac(const ChannelBlock& block, const TexelWeights& weights) {
  return encode(kEight, block, weights);
}

void decode_eac(const Bytes8& bytes, ChannelBlock& block) { decode(kEight, bytes, block); }

Bytes8 encode_eac11(const ChannelBlock& block, const TexelWeights& weights) {
  return encode(kEleven, block, weights);
}

void decode_eac11(const Bytes8& bytes, WideChannelBlock& block) { decode(kEleven, bytes, block); }

}  // namespace throng
