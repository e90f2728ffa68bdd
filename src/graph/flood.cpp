// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "graph/flood.h"

#include <algorithm>
#include <bit>

namespace throng {
namespace {

// Fills up and down from the seeds by doubling; `up` and `down` tell which bits may be entered from
// the bit below and from the bit above. (The occluded fill of chess programs.)
uint64_t spread(uint64_t seed, uint64_t up, uint64_t down) {
  uint64_t high = seed, low = seed;
  for (int shift = 1; shift < 64; shift *= 2) {
    high |= up & (high << shift);
    up &= up << shift;
    low |= down & (low >> shift);
    down &= down >> shift;
  }
  return high | low;
}

// Whole runs of `open` that hold a seed. Adding a seed to its run carries through all bits above.
uint64_t spread_runs(uint64_t seed, uint64_t open) {
  const uint64_t high = (open & ~(open + seed)) | seed;
  uint64_t low = high, down = open;
  for (int shift = 1; shift < 64; shift *= 2) {
    low |= down & (low >> shift);
    down &= down >> shift;
  }
  return low;
}

class Filler {
 public:
  Filler(const CellRows& open, const StepCuts* cuts) : open_(open), cuts_(cuts) {}

  CellRows fill(int32_t x, int32_t z) {
    CellRows filled{};
    const auto first = static_cast<size_t>(z);
    filled[first] = row(first, uint64_t{1} << x);
    // Sweeps down and up until one of them finds nothing: a part that winds k times takes about k.
    for (bool is_new = true; is_new;) {
      is_new = false;
      for (size_t i = 1; i < 64; ++i) is_new |= enter(filled, i, filled[i - 1] & ~along(i - 1));
      for (size_t i = 63; i-- > 0;) is_new |= enter(filled, i, filled[i + 1] & ~along(i));
    }
    return filled;
  }

 private:
  [[nodiscard]] uint64_t along(size_t z) const { return cuts_ != nullptr ? cuts_->along[z] : 0; }

  [[nodiscard]] uint64_t row(size_t z, uint64_t seed) const {
    if (cuts_ == nullptr || cuts_->across[z] == 0) return spread_runs(seed, open_[z]);
    const uint64_t cut = cuts_->across[z];
    return spread(seed, open_[z] & ~(cut << 1), open_[z] & ~cut);
  }

  bool enter(CellRows& filled, size_t z, uint64_t from) const {
    const uint64_t seed = from & open_[z] & ~filled[z];
    if (seed == 0) return false;
    filled[z] |= row(z, seed);
    return true;
  }

  const CellRows& open_;
  const StepCuts* cuts_;
};

}  // namespace

CellRows flood(const CellRows& open, const StepCuts* cuts, int32_t x, int32_t z) {
  return Filler(open, cuts).fill(x, z);
}

std::vector<CellRows> connected_parts(const CellRows& open, const StepCuts* cuts) {
  std::vector<CellRows> parts;
  CellRows left = open;
  for (size_t z = 0; z < 64; ++z) {
    while (left[z] != 0) {
      parts.push_back(Filler(open, cuts).fill(std::countr_zero(left[z]), static_cast<int32_t>(z)));
      for (size_t i = z; i < 64; ++i) left[i] &= ~parts.back()[i];
    }
  }
  return parts;
}

}  // namespace throng
