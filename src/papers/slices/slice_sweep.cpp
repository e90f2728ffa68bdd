// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "papers/slices/slice_sweep.h"

#include <algorithm>
#include <limits>
#include <string>

#include "core/parallel.h"

// [ML06] algorithms 2 and 3 without rendering a slice again. Going down, a cell's value changes
// only when the cut passes below it, so each cell keeps a cursor to the span it shows, and a cut
// visits only rows of a tile whose highest value lies above it. A row is one vector loop: where the
// cut runs inside the span the value becomes the cut's own height; only cells whose span ends walk
// on.
//
// Algorithm 2 needs no pass over the cells either. Call a cell *fresh* when a cut changes it and
// leaves at least an avatar's height above its new value.
// - Cells that changed at earlier, dismissed cuts were not fresh, and the lower cut makes them more
//   useless still. So the current slice holds something new iff a cell is fresh now; else DISMISS.
// - REPLACE asks that no cell needs the previous slice: cells in which it differs from the one
//   before, and which it leaves usable, must be the same and still usable in the current one. These
//   are exactly the cells that were fresh when it was kept (or fresh in what it replaced), and they
//   are the same and usable iff the highest of their values is an avatar's height below the cut.
// So two numbers decide: is any cell fresh, and the highest value of the previous slice's fresh
// cells.
namespace throng::papers {
namespace {

constexpr int32_t kRow = kTileCells;
constexpr int32_t kCells = kTileCells * kTileCells;
constexpr int32_t kLowest = std::numeric_limits<int32_t>::min();
// A kept slice is a full grid; this many bytes of them are refused with a sentence instead of a
// crash.
constexpr uint64_t kMaxKeptBytes = uint64_t{16} << 30;

// What one cut did to a tile.
struct CutResult {
  bool fresh = false;
  int32_t fresh_max = kLowest;
};

// One tile at the present cut: value and the span that gives it, per cell.
class TileState {
 public:
  TileState(const SliceTile& tile, int32_t far_plane)
      : tile_(&tile),
        far_plane_(far_plane),
        value_(kCells, far_plane),
        low_(kCells, kLowest),
        cursor_(tile.first.begin(), tile.first.end() - 1),
        row_max_(kTileCells, far_plane) {
    for (size_t cell = 0; cell < kCells; ++cell) {
      if (tile.first[cell] == tile.first[cell + 1]) continue;
      show(cell, tile.first[cell + 1] - 1);
    }
    for (size_t row = 0; row < kTileCells; ++row) update_row_max(row);
    max_ = *std::max_element(row_max_.begin(), row_max_.end());
  }

  [[nodiscard]] int32_t max() const { return max_; }
  [[nodiscard]] bool is_dirty() const { return dirty_; }
  [[nodiscard]] const SliceTile& tile() const { return *tile_; }
  [[nodiscard]] std::span<const int32_t> row(size_t z) const {
    return std::span(value_).subspan(z * kRow, kRow);
  }
  void set_clean() { dirty_ = false; }

  // Lowers the cut to `height`.
  CutResult cut(int32_t height, int32_t avatar_height) {
    CutResult result;
    for (size_t row = 0; row < kTileCells; ++row) {
      if (row_max_[row] <= height) continue;
      if (cut_row(row, height)) walk_row(row, height, height - avatar_height, result);
      update_row_max(row);
    }
    max_ = *std::max_element(row_max_.begin(), row_max_.end());
    dirty_ = true;
    return result;
  }

 private:
  void show(size_t cell, uint32_t span) {
    cursor_[cell] = span;
    value_[cell] = tile_->high[span];
    low_[cell] = tile_->low[span];
  }

  void update_row_max(size_t row) {
    const int32_t* value = value_.data() + row * kRow;
    int32_t highest = value[0];
    for (int32_t x = 1; x < kRow; ++x) highest = std::max(highest, value[x]);
    row_max_[row] = highest;
  }

  // Cells whose span continues below the cut record the cut itself. Returns whether other cells are
  // left.
  bool cut_row(size_t row, int32_t height) {
    int32_t* value = value_.data() + row * kRow;
    const int32_t* low = low_.data() + row * kRow;
    int32_t ended = 0;
    for (int32_t x = 0; x < kRow; ++x) {
      const bool above = value[x] > height;
      const bool goes_on = low[x] <= height;
      ended |= static_cast<int32_t>(above & !goes_on);
      value[x] = (above & goes_on) ? height : value[x];
    }
    return ended != 0;
  }

  // Moves the cursors of cells whose span ended above the cut to the next lower span, or to none.
  void walk_row(size_t row, int32_t height, int32_t usable, CutResult& result) {
    for (size_t cell = row * kRow; cell < (row + 1) * kRow; ++cell) {
      if (value_[cell] <= height) continue;
      uint32_t span = cursor_[cell];
      while (span > tile_->first[cell] && tile_->low[span] > height) --span;
      if (tile_->low[span] <= height) {
        show(cell, span);
        value_[cell] = std::min(value_[cell], height);
      } else {
        cursor_[cell] = span;
        value_[cell] = far_plane_;
        low_[cell] = kLowest;
      }
      if (value_[cell] <= usable) {
        result.fresh = true;
        result.fresh_max = std::max(result.fresh_max, value_[cell]);
      }
    }
  }

  const SliceTile* tile_;
  int32_t far_plane_;
  int32_t max_ = kLowest;
  bool dirty_ = true;  // Changed since the last kept slice was written.
  std::vector<int32_t> value_;
  std::vector<int32_t> low_;      // Of the span shown.
  std::vector<uint32_t> cursor_;  // The span shown.
  std::vector<int32_t> row_max_;
};

class Sweep {
 public:
  Sweep(std::span<const SliceTile> tiles, const SweepConfig& config) : config_(config) {
    states_.reserve(tiles.size());
    for (const SliceTile& tile : tiles) states_.emplace_back(tile, config.far_plane);
    set_.width = config.width;
    set_.depth = config.depth;
    set_.far_plane = config.far_plane;
    set_.avatar_height = config.avatar_height;
    set_.resolution = config.resolution;
  }

  Result<SliceSet> run(Context& context) {
    const int32_t top = config_.max_y + config_.avatar_height + config_.resolution;  // eq. 1
    take(top_of_given(top));
    cut_at(set_.taken_heights[0]);
    keep(set_.taken_heights[0]);
    const uint64_t total = depth_below(top, config_.min_y + config_.avatar_height);
    while (has_next()) {
      if (context.cancel) return Error{Errc::kCancelled, "slices: cancelled"};
      const int32_t height = next_height();
      take(height);
      const CutResult cut = cut_at(height);
      // DISMISS_CURRENT_SLICE: nothing new in it.
      if (cut.fresh && !decide(height, cut)) return too_many();
      if (context.on_progress) context.on_progress({"slice", depth_below(top, height), total});
    }
    if (context.on_progress) context.on_progress({"slice", total, total});
    return std::move(set_);
  }

 private:
  static uint64_t depth_below(int32_t top, int32_t height) {
    return static_cast<uint64_t>(std::max<int64_t>(0, int64_t{top} - height));
  }

  [[nodiscard]] int32_t top_of_given(int32_t own) const {
    return config_.heights.empty() ? own : config_.heights[0];
  }

  void take(int32_t height) {
    set_.taken_heights.push_back(height);
    ++set_.taken;
  }

  [[nodiscard]] bool has_next() const {
    if (!config_.heights.empty()) {
      return static_cast<size_t>(set_.taken) < config_.heights.size();
    }
    return max_ > config_.min_y + config_.avatar_height;  // Algorithm 3
  }

  [[nodiscard]] int32_t next_height() const {
    if (!config_.heights.empty()) return config_.heights[static_cast<size_t>(set_.taken)];
    return max_ - config_.resolution;  // eq. 3
  }

  CutResult cut_at(int32_t height) {
    active_.clear();
    for (size_t i = 0; i < states_.size(); ++i) {
      if (states_[i].max() > height) active_.push_back(i);
    }
    cuts_.assign(active_.size(), {});
    parallel_for(active_.size(), config_.workers, [&](size_t i) {
      cuts_[i] = states_[active_[i]].cut(height, config_.avatar_height);
    });
    CutResult all;
    for (const CutResult& cut : cuts_) {
      all.fresh = all.fresh || cut.fresh;
      all.fresh_max = std::max(all.fresh_max, cut.fresh_max);
    }
    max_ = config_.far_plane;
    for (const TileState& state : states_) max_ = std::max(max_, state.max());
    return all;
  }

  // KEEP_SLICES or REPLACE_PREVIOUS_SLICE. False if the kept slices would not fit.
  bool decide(int32_t height, const CutResult& cut) {
    const bool replace = config_.rule == SliceRule::kDismissAndReplace && set_.kept.size() > 1 &&
                         needed_max_ <= height - config_.avatar_height;
    if (replace) {
      needed_max_ = std::max(needed_max_, cut.fresh_max);
      set_.kept.back().height = height;
      write(set_.kept.back());
      return true;
    }
    needed_max_ = cut.fresh_max;
    return keep(height);
  }

  bool keep(int32_t height) {
    const size_t cells = static_cast<size_t>(set_.width) * static_cast<size_t>(set_.depth);
    if ((set_.kept.size() + 1) * cells * sizeof(int32_t) > kMaxKeptBytes) return false;
    Slice slice{.height = height, .surface = {}};
    if (set_.kept.empty()) {
      slice.surface.assign(cells, config_.far_plane);
    } else {
      slice.surface = set_.kept.back().surface;
    }
    write(slice);
    set_.kept.push_back(std::move(slice));
    return true;
  }

  // Brings a copy of the previous slice up to date: only tiles that changed since.
  void write(Slice& slice) {
    parallel_for(states_.size(), config_.workers, [&](size_t i) {
      TileState& state = states_[i];
      if (!state.is_dirty()) return;
      const int32_t x = state.tile().tile_x * kTileCells;
      const int32_t z = state.tile().tile_z * kTileCells;
      const int32_t columns = std::min(kTileCells, set_.width - x);
      const int32_t rows = std::min(kTileCells, set_.depth - z);
      for (int32_t row = 0; row < rows; ++row) {
        const auto values = state.row(static_cast<size_t>(row)).first(static_cast<size_t>(columns));
        const size_t to =
            static_cast<size_t>(z + row) * static_cast<size_t>(set_.width) + static_cast<size_t>(x);
        std::copy(values.begin(), values.end(), slice.surface.begin() + static_cast<ptrdiff_t>(to));
      }
      state.set_clean();
    });
  }

  [[nodiscard]] Error too_many() const {
    return {Errc::kLimit, "slices: " + std::to_string(set_.kept.size() + 1) + " kept slices of " +
                              std::to_string(set_.width) + " x " + std::to_string(set_.depth) +
                              " cells pass 16 GiB; use a larger cell"};
  }

  const SweepConfig& config_;
  std::vector<TileState> states_;
  std::vector<size_t> active_;
  std::vector<CutResult> cuts_;
  SliceSet set_;
  int32_t max_ = 0;
  int32_t needed_max_ = kLowest;  // Highest value of the cells that need the previous slice.
};

}  // namespace

Result<SliceSet> sweep_slices(std::span<const SliceTile> tiles, const SweepConfig& config,
                              Context& context) {
  THRONG_ASSERT(config.avatar_height > 0 && config.resolution > 0);
  THRONG_ASSERT(config.far_plane < config.min_y);
  return Sweep(tiles, config).run(context);
}

SliceSet slice_tile(const SliceTile& tile, const SweepConfig& config) {
  SliceTile alone = tile;
  alone.tile_x = 0;
  alone.tile_z = 0;
  SweepConfig one = config;
  one.width = kTileCells;
  one.depth = kTileCells;
  one.workers = 1;
  Context silent;
  return *Sweep({&alone, 1}, one).run(silent);  // One tile never passes the limit.
}

}  // namespace throng::papers
