// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "throng/recording.h"

// Summary of a recording in two passes: the first finds storeys and bounds, the second counts.
// Time: linear in the positions, times the lines.
namespace throng {
namespace {

Result<void> check_config(const SummaryConfig& config) {
  const auto positive = [](double v) { return v >= 1e-3 && v < 1e9; };
  if (!positive(config.bin) || !positive(config.cell) || !positive(config.storey) ||
      !positive(config.slow)) {
    return Error{Errc::kBadConfig, "summary: bin, cell, storey and slow must be at least 0.001"};
  }
  for (size_t i = 0; i < config.lines.size(); ++i) {
    const FlowLine& l = config.lines[i];
    const double size = std::fabs(l.x1 - l.x0) + std::fabs(l.z1 - l.z0);
    if (size > 0 && size < 1e9 && std::fabs(l.x0) < 1e9 && std::fabs(l.z0) < 1e9) continue;
    return Error{Errc::kBadConfig,
                 "summary: line " + std::to_string(i + 1) + " needs two different ends"};
  }
  return {};
}

class Summary {
 public:
  Summary(Replay& replay, const SummaryConfig& config, Context& context)
      : replay_(replay), config_(config), context_(context) {}

  Result<ReplaySummary> make() {
    if (auto ok = check_config(config_); !ok) return ok.error();
    if (replay_.frame_count() == 0) {
      return Error{Errc::kBadFile, "summary: the recording holds no frame; record the run again"};
    }
    if (auto ok = measure(); !ok) return ok.error();
    if (auto ok = lay_out(); !ok) return ok.error();
    if (auto ok = count(); !ok) return ok.error();
    return std::move(out_);
  }

 private:
  Result<void> read(uint64_t pass, uint64_t f, RecordedFrame& frame) {
    const uint64_t frames = replay_.frame_count();
    if (context_.on_progress) context_.on_progress({"summary", pass * frames + f, 2 * frames});
    if (context_.cancel) return Error{Errc::kCancelled, "summary: cancelled"};
    return replay_.read(f, frame);
  }

  Result<void> measure() {
    for (uint64_t f = 0; f < replay_.frame_count(); ++f) {
      if (auto ok = read(0, f, now_); !ok) return ok;
      out_.time.push_back(now_.time);
      out_.present.push_back(static_cast<uint32_t>(now_.size()));
      for (const Vec3d& p : now_.positions) {
        box_.add(p);
        const int64_t storey = storey_of(p.y);
        if (storeys_.empty() || storeys_.back() != storey) storeys_.push_back(storey);
      }
      if (storeys_.size() > 10000) sort_storeys();
    }
    sort_storeys();
    return {};
  }

  [[nodiscard]] int64_t storey_of(double y) const {
    return static_cast<int64_t>(std::floor(y / config_.storey + 1e-6));
  }
  void sort_storeys() {
    std::sort(storeys_.begin(), storeys_.end());
    storeys_.erase(std::unique(storeys_.begin(), storeys_.end()), storeys_.end());
  }

  Result<void> lay_out() {
    const double seconds = out_.time.back() - out_.time.front();
    if (seconds / config_.bin > 1e7) {
      return Error{Errc::kLimit, "summary: more than 10 million bins; take longer ones"};
    }
    const auto bins = static_cast<size_t>(std::max(1.0, std::ceil(seconds / config_.bin - 1e-9)));
    out_.lines.resize(config_.lines.size());
    for (LineFlow& line : out_.lines) {
      line.forth.resize(bins);
      line.back.resize(bins);
    }
    if (box_.empty()) return {};
    x_first_ = std::floor(box_.min.x / config_.cell);
    z_first_ = std::floor(box_.min.z / config_.cell);
    const double width = std::floor(box_.max.x / config_.cell) - x_first_ + 1;
    const double depth = std::floor(box_.max.z / config_.cell) - z_first_ + 1;
    const double all = width * depth * static_cast<double>(storeys_.size());
    if (!(all <= static_cast<double>(config_.max_cells)) || width > 1e6 || depth > 1e6) {
      return Error{Errc::kLimit, "summary: the maps would have more than " +
                                     std::to_string(config_.max_cells) +
                                     " cells; take larger cells"};
    }
    for (const int64_t storey : storeys_) {
      SummaryMap map{.lowest = static_cast<double>(storey) * config_.storey,
                     .highest = static_cast<double>(storey + 1) * config_.storey,
                     .x0 = x_first_ * config_.cell,
                     .z0 = z_first_ * config_.cell,
                     .cell = config_.cell,
                     .width = static_cast<int32_t>(width),
                     .depth = static_cast<int32_t>(depth),
                     .density = {},
                     .waiting = {}};
      map.density.resize(static_cast<size_t>(width * depth));
      map.waiting.resize(map.density.size());
      out_.maps.push_back(std::move(map));
    }
    return {};
  }

  // The map and the cell of a position.
  std::pair<SummaryMap*, size_t> cell_of(const Vec3d& p) {
    const auto at = std::lower_bound(storeys_.begin(), storeys_.end(), storey_of(p.y));
    SummaryMap& map = out_.maps[static_cast<size_t>(at - storeys_.begin())];
    const auto i = static_cast<int64_t>(std::floor(p.x / config_.cell) - x_first_);
    const auto k = static_cast<int64_t>(std::floor(p.z / config_.cell) - z_first_);
    return {&map, static_cast<size_t>(k * map.width + i)};
  }

  Result<void> count() {
    const double area = config_.cell * config_.cell;
    const double seconds = out_.time.back() - out_.time.front();
    uint64_t entered = 0, left = 0;
    double walked = 0, walked_time = 0;
    for (uint64_t f = 0; f < replay_.frame_count(); ++f) {
      if (auto ok = read(1, f, now_); !ok) return ok;
      out_.positions += now_.size();
      const double next = f + 1 < out_.time.size() ? out_.time[f + 1] : now_.time;
      const double weight = seconds > 0 ? (next - now_.time) / seconds : 1;
      for (const Vec3d& p : now_.positions) {
        const auto [map, cell] = cell_of(p);
        map->density[cell] += weight / area;
      }
      // Both frames are in order of id.
      size_t stay = 0;
      double moved = 0;
      const double dt = f > 0 ? now_.time - before_.time : 0;
      const size_t before = f > 0 ? before_.size() : 0;
      for (size_t a = 0, b = 0; a < before || b < now_.size();) {
        const bool has_left = b == now_.size() || (a < before && before_.ids[a] < now_.ids[b]);
        const bool is_new = a == before || (b < now_.size() && now_.ids[b] < before_.ids[a]);
        entered += is_new ? 1 : 0;
        left += has_left ? 1 : 0;
        if (has_left) out_.last_left = now_.time;
        if (!has_left && !is_new) {
          ++stay;
          moved += move(before_.positions[a], now_.positions[b], dt);
        }
        a += is_new ? 0 : 1;
        b += has_left ? 0 : 1;
      }
      out_.entered.push_back(entered);
      out_.left.push_back(left);
      if (f > 0) {
        const double n = static_cast<double>(std::max<size_t>(stay, 1));
        out_.speed.push_back(moved / n / dt);
        walked += moved;
        walked_time += static_cast<double>(stay) * dt;
      }
      std::swap(before_, now_);
    }
    out_.speed.push_back(out_.speed.empty() ? 0 : out_.speed.back());
    out_.mean_speed = walked_time > 0 ? walked / walked_time : 0;
    return {};
  }

  // Adds the move of one body since the frame before. Returns its length.
  double move(const Vec3d& from, const Vec3d& to, double dt) {
    const double moved = length(to - from);
    if (moved < config_.slow * dt) {
      const auto [map, cell] = cell_of(from);
      map->waiting[cell] += dt / (config_.cell * config_.cell);
      out_.waited += dt;
    }
    for (size_t l = 0; l < config_.lines.size(); ++l) cross(l, from, to, dt);
    return moved;
  }

  void cross(size_t index, const Vec3d& from, const Vec3d& to, double dt) {
    const FlowLine& l = config_.lines[index];
    const double dx = l.x1 - l.x0, dz = l.z1 - l.z0;
    const double a = dx * (from.z - l.z0) - dz * (from.x - l.x0);
    const double b = dx * (to.z - l.z0) - dz * (to.x - l.x0);
    if ((a > 0) == (b > 0)) return;  // The line belongs to its left side: a crossing counts once.
    const double part = a / (a - b);
    const Vec3d at = from + (to - from) * part;
    const double along = ((at.x - l.x0) * dx + (at.z - l.z0) * dz) / (dx * dx + dz * dz);
    if (!(along >= 0 && along <= 1) || at.y < l.lowest || at.y > l.highest) return;
    LineFlow& flow = out_.lines[index];
    const double when = before_.time + part * dt - out_.time.front();
    const auto bin = std::min(static_cast<size_t>(when / config_.bin), flow.forth.size() - 1);
    ++(b > 0 ? flow.forth : flow.back)[bin];
    ++(b > 0 ? flow.total_forth : flow.total_back);
  }

  Replay& replay_;
  const SummaryConfig& config_;
  Context& context_;
  Box3d box_;                         // of all positions
  double x_first_ = 0, z_first_ = 0;  // whole numbers of cells
  std::vector<int64_t> storeys_;      // that had avatars, ascending
  RecordedFrame now_, before_;
  ReplaySummary out_;
};

}  // namespace

Result<ReplaySummary> summarise(Replay& replay, const SummaryConfig& config, Context& context) {
  return Summary(replay, config, context).make();
}

}  // namespace throng
