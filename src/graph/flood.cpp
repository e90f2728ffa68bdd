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

uint64_t lowest(uint64_t cells) { return cells & (0 - cells); }

// Cells of a run.
uint32_t length(uint64_t run) {
  return static_cast<uint32_t>(64 - std::countl_zero(run) - std::countr_zero(run));
}

// The rows from the first to the last that are open.
struct OpenRows {
  size_t begin = 0, end = 64;

  explicit OpenRows(const CellRows& open) {
    while (begin < 64 && open[begin] == 0) ++begin;
    while (end > begin && open[end - 1] == 0) --end;
  }
};

// Tells most parts from several at a glance: rows of one run each that meet the one above. Without
// comparing, so that compilers make vectors of it. [rows.begin < rows.end]
bool is_chain(const CellRows& open, OpenRows rows) {
  uint64_t split = 0, meets = ~uint64_t{0};
  for (size_t z = rows.begin; z < rows.end; ++z) split |= open[z] & (open[z] + lowest(open[z]));
  for (size_t z = rows.begin + 1; z < rows.end; ++z) {
    const uint64_t both = open[z] & open[z - 1];
    meets &= both | (0 - both);  // the highest bit: not 0
  }
  return split == 0 && meets >> 63 != 0;
}

}  // namespace

CellRows flood(const CellRows& open, const StepCuts* cuts, int32_t x, int32_t z) {
  return Filler(open, cuts).fill(x, z);
}

void PartFinder::find(const CellRows& open, const StepCuts* cuts, PartList& list) {
  const auto start = static_cast<uint32_t>(list.rows.size());
  const OpenRows open_rows(open);
  if (open_rows.begin == open_rows.end) return;
  if (cuts == nullptr && is_chain(open, open_rows)) {
    const auto begin = static_cast<uint16_t>(open_rows.begin);
    const auto end = static_cast<uint16_t>(open_rows.end);
    uint32_t cells = 0;
    for (size_t z = begin; z < end; ++z) cells += length(open[z]);
    list.parts.push_back({start, begin, end, cells});
    list.rows.insert(list.rows.end(), open.begin() + begin, open.begin() + end);
    return;
  }
  find_runs(open, cuts);
  // Parents come first: one look-up leads to the root.
  const size_t first_part = list.parts.size();
  part_.resize(cells_.size());
  for (size_t z = 0; z < 64; ++z) {
    for (size_t i = first_[z]; i < first_[z + 1]; ++i) {
      parent_[i] = parent_[parent_[i]];
      if (parent_[i] == i) {
        part_[i] = static_cast<uint32_t>(list.parts.size());
        list.parts.push_back({0, static_cast<uint16_t>(z), 0, 0});
      }
      PartList::Part& part = list.parts[part_[parent_[i]]];
      part.end = static_cast<uint16_t>(z + 1);
      part.cells += length(cells_[i]);
    }
  }
  uint32_t rows = start;
  for (size_t p = first_part; p < list.parts.size(); ++p) {
    list.parts[p].rows = rows;
    rows += static_cast<uint32_t>(list.parts[p].end - list.parts[p].begin);
  }
  list.rows.resize(rows, 0);
  for (size_t z = 0; z < 64; ++z) {
    for (size_t i = first_[z]; i < first_[z + 1]; ++i) {
      const PartList::Part& part = list.parts[part_[parent_[i]]];
      list.rows[part.rows + z - part.begin] |= cells_[i];
    }
  }
}

uint16_t PartFinder::root(uint16_t run) {
  while (parent_[run] != run) run = parent_[run] = parent_[parent_[run]];
  return run;
}

void PartFinder::find_runs(const CellRows& open, const StepCuts* cuts) {
  cells_.clear();
  parent_.clear();
  for (size_t z = 0; z < 64; ++z) {
    first_[z] = static_cast<uint16_t>(cells_.size());
    const uint64_t row = open[z], cut = cuts != nullptr ? cuts->across[z] : 0;
    const uint64_t pass = cuts != nullptr && z > 0 ? ~cuts->along[z - 1] : ~uint64_t{0};
    size_t above = z > 0 ? first_[z - 1] : 0;
    uint64_t left = row;
    for (uint64_t ends = row & (~(row >> 1) | cut); ends != 0; ends &= ends - 1) {
      const uint64_t up_to = ends ^ (ends - 1), run = left & up_to;
      left &= ~up_to;
      const auto own = static_cast<uint16_t>(cells_.size());
      cells_.push_back(run);
      parent_.push_back(own);
      // Those above that end before it begins end before all that follow.
      while (above < first_[z] && cells_[above] < lowest(run)) ++above;
      for (size_t i = above; i < first_[z] && lowest(cells_[i]) <= run; ++i) {
        if ((cells_[i] & run & pass) == 0) continue;
        const uint16_t a = root(static_cast<uint16_t>(i)), b = root(own);
        parent_[std::max(a, b)] = std::min(a, b);
      }
    }
  }
  first_[64] = static_cast<uint16_t>(cells_.size());
}

}  // namespace throng
