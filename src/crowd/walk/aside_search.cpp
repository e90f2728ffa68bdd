// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "crowd/walk/aside_search.h"

#include <algorithm>
#include <cmath>

// The nearest place beside paths, over the cells around a body. Time: linear in the cells visited,
// a legal move each.
namespace throng::crowd {

void PathLine::add(double x, double z, double y) {
  double along = 0;
  if (!points_.empty()) {
    const double dx = x - points_.back().x, dz = z - points_.back().z;
    along = points_.back().along + std::sqrt(dx * dx + dz * dz);
  }
  points_.push_back({x, z, y, along});
}

PathLine::Nearest PathLine::nearest(double x, double z, double y, double height) const {
  Nearest found;
  for (size_t i = 1; i < points_.size(); ++i) {
    const Point &a = points_[i - 1], &b = points_[i];
    const double ux = b.x - a.x, uz = b.z - a.z, size = ux * ux + uz * uz;
    if (!(size > 0)) continue;
    const double part = std::clamp(((x - a.x) * ux + (z - a.z) * uz) / size, 0.0, 1.0);
    if (std::fabs(a.y + part * (b.y - a.y) - y) > height) continue;
    const double dx = x - a.x - part * ux, dz = z - a.z - part * uz, square = dx * dx + dz * dz;
    if (square >= found.square) continue;
    const double whole = std::sqrt(size);
    found = {square, a.along + part * whole, ux / whole, uz / whole};
  }
  return found;
}

bool AsideSearch::find(const StrideGround& ground, const Body& body,
                       FunctionRef<bool(const Stand&)> is_free,
                       FunctionRef<bool(const Stand&)> is_good, std::vector<PathPoint>& corners) {
  constexpr int32_t kMiddle = world::kUnitsPerCell / 2;
  constexpr std::array<std::array<int32_t, 2>, 4> kSides{{{1, 0}, {0, 1}, {-1, 0}, {0, -1}}};
  seen_.assign(size_t{kSide} * kSide, 0);
  nodes_.clear();
  const int32_t left = body.point().cell_x() - kSide / 2, low = body.point().cell_z() - kSide / 2;
  const auto take = [&](int32_t cell_x, int32_t cell_z) {
    const int32_t x = cell_x - left, z = cell_z - low;
    if (x < 0 || z < 0 || x >= kSide || z >= kSide) return false;
    uint8_t& seen = seen_[static_cast<size_t>(z) * kSide + static_cast<size_t>(x)];
    return seen++ == 0;
  };
  (void)take(body.point().cell_x(), body.point().cell_z());
  nodes_.push_back({body.stand(), 0});
  for (size_t n = 0; n < nodes_.size() && nodes_.size() < kMaxCells; ++n) {
    const Node from = nodes_[n];
    if (n > 0 && is_good(from.at)) {
      write_corners(ground, n, corners);
      return true;
    }
    const world::GroundPoint here{from.at.x, from.at.z};
    for (const auto& [dx, dz] : kSides) {
      const int32_t cell_x = here.cell_x() + dx, cell_z = here.cell_z() + dz;
      if (!take(cell_x, cell_z)) continue;
      const Stand to{cell_x * world::kUnitsPerCell + kMiddle,
                     cell_z * world::kUnitsPerCell + kMiddle, from.at.y, from.at.level};
      StrideGround::Landing landing;
      if (!ground.move(from.at.level, from.at.y, here, {to.x, to.z}, landing)) continue;
      const Stand there{to.x, to.z, landing.y, landing.level};
      if (is_free(there)) nodes_.push_back({there, static_cast<uint32_t>(n)});
    }
  }
  return false;
}

// As few corners as see each other.
void AsideSearch::write_corners(const StrideGround& ground, size_t last,
                                std::vector<PathPoint>& corners) {
  chain_.clear();
  for (size_t n = last; n != 0; n = nodes_[n].parent) chain_.push_back(static_cast<uint32_t>(n));
  chain_.push_back(0);
  std::reverse(chain_.begin(), chain_.end());
  corners.clear();
  for (size_t at = 0; at + 1 < chain_.size();) {
    size_t next = at + 1;
    const Stand& from = nodes_[chain_[at]].at;
    for (; next + 1 < chain_.size(); ++next) {
      const Stand& to = nodes_[chain_[next + 1]].at;
      if (!ground.sees(from.level, {from.x, from.z}, {to.x, to.z}, to.level, HUGE_VALF)) break;
    }
    const Stand& to = nodes_[chain_[next]].at;
    corners.push_back({to.x, to.z, to.level});
    at = next;
  }
}

}  // namespace throng::crowd
