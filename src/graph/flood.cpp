// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "graph/flood.h"

#include <algorithm>
#include <bit>

// Connected parts of rows of bits. From one cell: fills of whole rows until nothing changes. All
// parts: runs of a row are joined with those of the row above by union-find [RP66]. Linear in the
// runs.
namespace throng::graph {
namespace {

// Fills up and down from the seeds by doubling; `up` and `down` are the bits that may be entered
// from the bit below and from the bit above. (The occluded fill of chess programs.)
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
  Filler(const world::CellRows& open, const StepCuts* cuts) : open_(open), cuts_(cuts) {}

  world::CellRows fill(int32_t x, int32_t z) {
    world::CellRows filled{};
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

  bool enter(world::CellRows& filled, size_t z, uint64_t from) const {
    const uint64_t seed = from & open_[z] & ~filled[z];
    if (seed == 0) return false;
    filled[z] |= row(z, seed);
    return true;
  }

  const world::CellRows& open_;
  const StepCuts* cuts_;
};

uint64_t lowest(uint64_t cells) { return cells & (0 - cells); }

// Cells of a run.
uint32_t length(uint64_t run) {
  return static_cast<uint32_t>(64 - std::countl_zero(run) - std::countr_zero(run));
}

}  // namespace

world::CellRows flood(const world::CellRows& open, const StepCuts* cuts, int32_t x, int32_t z) {
  return Filler(open, cuts).fill(x, z);
}

void PartFinder::find(const world::CellRows& open, const StepCuts* cuts, PartList& list) {
  add_parts(open, cuts, find_bands(open, cuts), list);
}

bool PartFinder::find_few(const world::CellRows& open, PartList& list) {
  constexpr size_t kMaxBands = 12;
  const bool is_chain = find_bands(open, nullptr);
  if (!is_chain && band_count_ > kMaxBands) return false;
  add_parts(open, nullptr, is_chain, list);
  return true;
}

void PartFinder::add_parts(const world::CellRows& open, const StepCuts* cuts, bool is_chain,
                           PartList& list) {
  const auto start = static_cast<uint32_t>(list.rows.size());
  if (band_count_ == 0) return;
  if (is_chain) {
    const uint16_t begin = bands_[0].begin, end = bands_[band_count_ - 1].end;
    PartList::Part& part = list.parts.emplace_back();
    part.rows = start;
    part.begin = begin;
    for (size_t b = 0; b < band_count_; ++b) add_run(open[bands_[b].begin], bands_[b], part);
    list.rows.insert(list.rows.end(), open.begin() + begin, open.begin() + end);
    return;
  }
  find_runs(open, cuts);
  // Parents come first: one look-up leads to the root.
  const size_t first_part = list.parts.size();
  part_.resize(cells_.size());
  for (size_t b = 0; b < band_count_; ++b) {
    for (size_t i = bands_[b].first_run; i < bands_[b + 1].first_run; ++i) {
      parent_[i] = parent_[parent_[i]];
      if (parent_[i] == i) {
        part_[i] = static_cast<uint32_t>(list.parts.size());
        list.parts.emplace_back().begin = bands_[b].begin;
      }
      add_run(cells_[i], bands_[b], list.parts[part_[parent_[i]]]);
    }
  }
  uint32_t rows = start;
  for (size_t p = first_part; p < list.parts.size(); ++p) {
    list.parts[p].rows = rows;
    rows += static_cast<uint32_t>(list.parts[p].end - list.parts[p].begin);
  }
  list.rows.resize(rows, 0);
  for (size_t b = 0; b < band_count_; ++b) {
    const Band& band = bands_[b];
    for (size_t i = band.first_run; i < bands_[b + 1].first_run; ++i) {
      const PartList::Part& part = list.parts[part_[parent_[i]]];
      uint64_t* row = &list.rows[part.rows + band.begin - part.begin];
      for (size_t z = band.begin; z < band.end; ++z) *row++ |= cells_[i];
    }
  }
}

void PartFinder::add_run(uint64_t run, const Band& band, PartList::Part& part) {
  const auto height = static_cast<uint32_t>(band.end - band.begin);
  const uint64_t rows = ~uint64_t{0} >> (64 - height) << band.begin;
  part.end = band.end;
  part.cells += length(run) * height;
  part.side[kWest] |= rows & (0 - (run & 1));
  part.side[kEast] |= rows & (0 - (run >> 63));
  if (band.begin == 0) part.side[kNorth] |= run;
  if (band.end == 64) part.side[kSouth] |= run;
}

uint16_t PartFinder::root(uint16_t run) {
  while (parent_[run] != run) run = parent_[run] = parent_[parent_[run]];
  return run;
}

// From the first row that is open to the last. True if it is seen at a glance that all is one part,
// as most are: bands of one run each that meet the one above.
bool PartFinder::find_bands(const world::CellRows& open, const StepCuts* cuts) {
  band_count_ = 0;
  size_t z = 0, end = 64;
  while (z < 64 && open[z] == 0) ++z;
  while (end > z && open[end - 1] == 0) --end;
  uint64_t split = 0, above = ~uint64_t{0};
  bool meets = true;
  while (z < end) {
    const size_t begin = z++;
    const uint64_t row = open[begin];
    while (cuts == nullptr && z < end && open[z] == row) ++z;
    bands_[band_count_++] = {static_cast<uint16_t>(begin), static_cast<uint16_t>(z), 0};
    split |= row & (row + lowest(row));
    meets &= (row & above) != 0;
    above = row;
  }
  return cuts == nullptr && meets && split == 0;
}

void PartFinder::find_runs(const world::CellRows& open, const StepCuts* cuts) {
  cells_.clear();
  parent_.clear();
  for (size_t b = 0; b < band_count_; ++b) {
    const size_t z = bands_[b].begin, end = cells_.size();
    bands_[b].first_run = static_cast<uint16_t>(end);
    const uint64_t row = open[z], cut = cuts != nullptr ? cuts->across[z] : 0;
    const uint64_t pass = cuts != nullptr && z > 0 ? ~cuts->along[z - 1] : ~uint64_t{0};
    size_t above = b > 0 ? bands_[b - 1].first_run : 0;
    uint64_t left = row;
    for (uint64_t ends = row & (~(row >> 1) | cut); ends != 0; ends &= ends - 1) {
      const uint64_t up_to = ends ^ (ends - 1), run = left & up_to;
      left &= ~up_to;
      const auto own = static_cast<uint16_t>(cells_.size());
      cells_.push_back(run);
      parent_.push_back(own);
      // Those above that end before it begins end before all that follow.
      while (above < end && cells_[above] < lowest(run)) ++above;
      for (size_t i = above; i < end && lowest(cells_[i]) <= run; ++i) {
        if ((cells_[i] & run & pass) == 0) continue;
        const uint16_t a = root(static_cast<uint16_t>(i)), b_root = root(own);
        parent_[std::max(a, b_root)] = std::min(a, b_root);
      }
    }
  }
  bands_[band_count_].first_run = static_cast<uint16_t>(cells_.size());
}

}  // namespace throng::graph
