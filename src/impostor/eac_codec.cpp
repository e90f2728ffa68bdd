// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cstdlib>

#include "impostor/etc2_codec.h"
#include "impostor/etc2_tables.h"

// Source: [KDF]. A block is a base, a factor, and one of sixteen tables of eight steps.
// For each table, the encoder tries the factors that just span the values, with a base that centres
// them; the best of all is then moved by single steps while the error falls.
namespace throng::impostor {
namespace {

using namespace etc2;

// One of the two kinds of block: 8 bits or 11.
struct Kind {
  int32_t scale;      // Of a base.
  int32_t offset;     // Of a base.
  int32_t max_value;  // Largest value.
  int32_t factor;     // Smallest: encoders of 8 bits must not write 0.
};
constexpr Kind kEight{1, 0, 255, 1}, kEleven{8, 4, 2047, 0};

int32_t value_of(const Kind& kind, int32_t base, int32_t factor, size_t table, size_t index) {
  // A factor of zero means an eighth where there are bits for it.
  const int32_t step = factor == 0 && kind.scale > 1 ? 1 : factor * kind.scale;
  return std::clamp(base * kind.scale + kind.offset + channel_step(table, index) * step, 0,
                    kind.max_value);
}

struct EacFit {
  int32_t base = 0, factor = 1;
  size_t table = 13;
  int64_t error = INT64_MAX;
};

// Which texels count. Compilers vectorise loops over all sixteen in 16 bits.
struct ChannelTexels {
  std::array<int16_t, 16> value{};
  std::array<int16_t, 16> counts{};  // 1 or 0.
  int32_t low = INT32_MAX, high = 0;
};

std::array<int16_t, 8> values_of(const Kind& kind, const EacFit& fit) {
  std::array<int16_t, 8> values;
  for (size_t p = 0; p < 8; ++p) {
    values[p] = static_cast<int16_t>(value_of(kind, fit.base, fit.factor, fit.table, p));
  }
  return values;
}

void try_fit(const Kind& kind, const ChannelTexels& seen, int32_t base, int32_t factor,
             size_t table, EacFit& best) {
  if (base < 0 || base > 255 || factor < kind.factor || factor > 15) return;
  EacFit fit{.base = base, .factor = factor, .table = table, .error = 0};
  const auto values = values_of(kind, fit);
  std::array<int16_t, 16> nearest;
  for (size_t i = 0; i < 16; ++i) {
    int16_t smallest = INT16_MAX;
    for (size_t p = 0; p < 8; ++p) {
      const auto off = static_cast<int16_t>(seen.value[i] - values[p]);
      smallest = std::min(smallest, std::max(off, static_cast<int16_t>(-off)));
    }
    nearest[i] = smallest;
  }
  int32_t error = 0;
  for (size_t i = 0; i < 16; ++i) error += nearest[i] * nearest[i] * seen.counts[i];
  fit.error = error;
  if (fit.error < best.error) best = fit;
}

EacFit fit_channel(const Kind& kind, const ChannelTexels& seen) {
  EacFit best;
  const int32_t range = seen.high - seen.low, middle = (seen.high + seen.low) / 2;
  for (size_t t = 0; t < 16 && best.error > 0; ++t) {
    const int32_t width = (-1 - 2 * kChannelSteps[t][3]) * kind.scale;  // Of the steps, by one.
    // A factor too small cuts the ends, one too large leaves steps unused: either may be better.
    const int32_t factor = range / width;
    for (int32_t f = factor; f <= factor + 2; ++f) {
      // Steps extend one further down than up, so the middle lies half a factor under the base.
      const int32_t base = (middle - kind.offset + f * kind.scale / 2) / kind.scale;
      for (int32_t b = base - 1; b <= base + 1; ++b) try_fit(kind, seen, b, f, t, best);
    }
    // The limits may clip values beyond an end: tries bases for which the far end still fits.
    if (seen.low > 0 && seen.high < kind.max_value) continue;
    const int32_t reach = kChannelSteps[t][3];
    for (int32_t f = std::max(1, factor); f <= std::min(15, factor + 4); ++f) {
      try_fit(kind, seen, (seen.low - kind.offset) / kind.scale - reach * f, f, t, best);
      try_fit(kind, seen, (seen.high - kind.offset) / kind.scale + (reach + 1) * f, f, t, best);
    }
  }
  for (int64_t before = INT64_MAX; best.error > 0 && best.error < before;) {
    before = best.error;
    const EacFit from = best;
    for (int32_t f = -1; f <= 1; ++f) {
      for (int32_t b = -2; b <= 2; ++b) {
        try_fit(kind, seen, from.base + b, from.factor + f, from.table, best);
      }
    }
  }
  return best;
}

Bytes8 encode(const Kind& kind, const ChannelBlock& block, const TexelWeights& weights) {
  ChannelTexels seen;
  for (size_t i = 0; i < 16; ++i) {
    const int32_t value = (2 * block[i] * kind.max_value + 255) / 510;
    seen.value[i] = static_cast<int16_t>(value);
    if (weights[i] == 0) continue;
    seen.counts[i] = 1;
    seen.low = std::min(seen.low, value);
    seen.high = std::max(seen.high, value);
  }
  EacFit fit{.base = 0, .factor = 1, .table = 13, .error = INT64_MAX};
  if (seen.high >= seen.low) fit = fit_channel(kind, seen);
  const auto values = values_of(kind, fit);
  auto word = static_cast<uint64_t>(fit.base << 8 | fit.factor << 4) | fit.table;
  for (size_t i = 0; i < 16; ++i) {
    const size_t texel = turned(i);
    uint64_t index = 0;
    for (size_t p = 1; p < 8 && seen.counts[texel] != 0; ++p) {
      const int32_t value = seen.value[texel];
      if (std::abs(value - values[p]) < std::abs(value - values[index])) index = p;
    }
    word = word << 3 | index;
  }
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

}  // namespace throng::impostor
