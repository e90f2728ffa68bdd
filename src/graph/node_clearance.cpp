// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "graph/node_clearance.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/access.h"
#include "world/cell_blocks.h"
#include "world/zone_data.h"

// What a body may rely on at a place is the best of what the nodes around it promise, since each of
// them promises it everywhere. Along a line it is the worst of that, piece by piece between the
// borders of nodes. Whether a body that is no class fits follows from the bodies that do:
//
//  - one that lies inside the body of a class fits wherever the class stands;
//  - a wider one, if the class stands everywhere around the place as far as the body is wider: the
//    class's bodies there cover it, less what the ground rises between them;
//  - a taller one, if the class stands, and the nodes promise the headroom, everywhere under it.
//
// Time: linear in the nodes and cells of one patch.
namespace throng::graph {
namespace {

constexpr double kTouching = 1e-9;   // of parameters that lie on a border
constexpr double kRounding = 0.002;  // heights of level tiles are whole millimetres [m]
constexpr int32_t kParts = 8;        // of a line, and of a cell's side, where it is sampled

// Of an arc over its chord, on pieces of patches no larger than a cell.
constexpr double kCurved = 1.1;

double radians(double degrees) { return degrees * std::numbers::pi / 180; }

// The part of a line inside a square, as shares of the line; nothing if it does not touch it.
std::optional<std::pair<double, double>> inside(const PatchLine& line, double s0, double t0,
                                                double s1, double t1) {
  double from = 0, to = 1;
  const auto cut = [&](double at, double by, double low, double high) {
    if (by == 0) return at >= low - kTouching && at <= high + kTouching;
    const double a = (low - kTouching - at) / by, b = (high + kTouching - at) / by;
    from = std::max(from, std::min(a, b));
    to = std::min(to, std::max(a, b));
    return from <= to;
  };
  if (!cut(line.s0, line.s1 - line.s0, s0, s1)) return {};
  if (!cut(line.t0, line.t1 - line.t0, t0, t1)) return {};
  return std::pair{from, to};
}

// Which of a block's cells a point is in or on the border of. [s, t in cells of the block]
uint64_t cells_around(double s, double t) {
  uint64_t cells = 0;
  const auto from = [](double at) { return static_cast<int32_t>(std::floor(at - 64 * kTouching)); };
  const auto to = [](double at) { return static_cast<int32_t>(std::floor(at + 64 * kTouching)); };
  for (int32_t j = from(t); j <= to(t); ++j) {
    for (int32_t i = from(s); i <= to(s); ++i) {
      if (i >= 0 && i < 8 && j >= 0 && j < 8) cells |= uint64_t{1} << (8 * j + i);
    }
  }
  return cells;
}

}  // namespace

NodeClearances::NodeClearances(const NodeData& data) : data_(data) {
  for (const AvatarClass& avatar : data_of(data.world)->summary.classes) {
    const double step = avatar.climb_slope > 0 ? avatar.step_height : 0;
    greatest_bottom_ = std::max({greatest_bottom_, body_bottom(avatar), step});
  }
}

// Makes the patch of a node the one that is asked about. False: its zone cannot be used.
bool NodeClearances::open(uint32_t node) {
  const auto [zone, local] = data_.find(node);
  if (zone == nullptr) return false;
  if (zone == zone_ && local >= first_ && local < end_) return true;
  const format::NodePatch& patch = zone->patch_of(local);
  zone_ = zone;
  first_ = patch.first_node();
  end_ = first_ + patch.nodes();
  zone_first_ = node - local;
  surface_ = surface_of(data_, *zone, patch);
  middles_.assign(end_ - first_, {});
  has_middle_.assign(end_ - first_, 0);
  regions_.clear();
  return surface_.is_there();
}

// Those of a partial node's cells on which a class may stand.
uint64_t NodeClearances::cells_of(uint32_t local, int32_t avatar_class) const {
  return data_.cells_of(*zone_, local, avatar_class);
}

// Does the square of a node, whole or partial, hold a point?
bool NodeClearances::is_around(uint32_t local, double s, double t) const {
  const format::Node& node = node_at(local);
  const double side = 1.0 / (1 << node.level());
  return inside({s, t, s, t}, node.s() * side, node.t() * side, (node.s() + 1) * side,
                (node.t() + 1) * side)
      .has_value();
}

// The classes of a node that stand at a point of its square.
uint16_t NodeClearances::classes_at(uint32_t local, double s, double t) const {
  const format::Node& node = node_at(local);
  if ((node.flags() & kPartialFlag) == 0) return node.classes();
  const uint64_t here = cells_around(s * kTileCells - node.s() * 8, t * kTileCells - node.t() * 8);
  uint16_t classes = 0;
  if ((zone_->cells_of(local) & here) == 0) return 0;
  for (uint32_t left = node.classes(); left != 0; left &= left - 1) {
    const int32_t c = std::countr_zero(left);
    if ((cells_of(local, c) & here) != 0) classes |= static_cast<uint16_t>(1u << c);
  }
  return classes;
}

// The least of the limits of classes that stand on some ground, since it is no steeper: a partial
// node promises the steepest of the cells of all its classes. [degrees]
double NodeClearances::gentlest(uint16_t classes) const {
  double least = 180;
  for (uint32_t left = classes; left != 0; left &= left - 1) {
    const AvatarClass& avatar =
        data_of(data_.world)->summary.classes[static_cast<size_t>(std::countr_zero(left))];
    const bool climbs = is_curved() && avatar.climb_slope > 0;
    least = std::min(least, climbs ? avatar.climb_slope : avatar.max_slope);
  }
  return least;
}

// The tallest of the classes that stand along the normal of a curved patch, or of those that stand
// upright; 0 if there is none. Its body is free. [m]
double NodeClearances::tallest(uint16_t classes, bool along_normal) const {
  double most = 0;
  for (uint32_t left = classes; left != 0; left &= left - 1) {
    const AvatarClass& avatar =
        data_of(data_.world)->summary.classes[static_cast<size_t>(std::countr_zero(left))];
    if ((is_curved() && avatar.climb_slope > 0) == along_normal)
      most = std::max(most, avatar.height);
  }
  return most;
}

// Where a line crosses the borders of nodes, ascending from 0 to 1. Inside partial nodes, of cells.
// `touched` gets the nodes.
std::vector<double> NodeClearances::breaks_of(const PatchLine& line,
                                              std::vector<uint32_t>& touched) const {
  std::vector<double> breaks = {0, 1};
  for (uint32_t n = first_; n < end_; ++n) {
    const format::Node& node = node_at(n);
    const double side = 1.0 / (1 << node.level()), s0 = node.s() * side, t0 = node.t() * side;
    const auto part = inside(line, s0, t0, s0 + side, t0 + side);
    if (!part) continue;
    touched.push_back(n);
    breaks.push_back(part->first);
    breaks.push_back(part->second);
    if ((node.flags() & kPartialFlag) == 0) continue;
    const auto add = [&](double at, double by, double low) {
      if (by == 0) return;
      for (int32_t k = 1; k < 8; ++k) {
        const double share = (low + k * side / 8 - at) / by;
        if (share > part->first && share < part->second) breaks.push_back(share);
      }
    };
    add(line.s0, line.s1 - line.s0, s0);
    add(line.t0, line.t1 - line.t0, t0);
  }
  std::sort(breaks.begin(), breaks.end());
  return breaks;
}

NodeClearance NodeClearances::along(int32_t avatar_class, uint32_t node, const PatchLine& line) {
  NodeClearance worst;
  if (!open(node)) return worst;
  const NodeBins& bins = data_.summary.bins;
  const double ds = line.s1 - line.s0, dt = line.t1 - line.t0;
  const bool is_point = ds == 0 && dt == 0;
  // Points of the line, so close that the ground between two of them is no farther off than they
  // are from each other.
  int32_t count = 0;
  if (!is_point) {
    count = kParts;
    const double cells = std::ceil(std::max(std::fabs(ds), std::fabs(dt)) * kTileCells);
    if (!is_curved()) count = std::max(count, 2 * static_cast<int32_t>(cells));
  }
  std::vector<Vec3d> points;
  double apart = 0;
  for (int32_t i = 0; i <= count; ++i) {
    const double f = count == 0 ? 0 : static_cast<double>(i) / count;
    points.push_back(surface_.at(line.s0 + f * ds, line.t0 + f * dt));
    if (i > 0) apart = std::max(apart, length(points.back() - points[points.size() - 2]));
  }
  double closed = std::numeric_limits<double>::infinity();  // to where the class cannot stand
  const Region& stands = region(avatar_class, 0);
  for (int32_t i = 0; i <= count; ++i) {
    const double f = count == 0 ? 0 : static_cast<double>(i) / count;
    closed = std::min(closed, free_distance(stands, line.s0 + f * ds, line.t0 + f * dt) - apart);
  }
  worst.classes = UINT16_MAX;
  worst.inclination = 0;
  worst.height = worst.headroom = worst.width = std::numeric_limits<double>::infinity();
  std::vector<uint32_t> touched;
  const std::vector<double> breaks = breaks_of(line, touched);
  for (size_t k = 0; k + 1 < breaks.size(); ++k) {
    constexpr double kNothing = 1e-9;  // Between two borders that are the same but for rounding.
    if (breaks[k + 1] - breaks[k] < kNothing) continue;
    const double f = (breaks[k] + breaks[k + 1]) / 2;
    const double s = line.s0 + f * ds, t = line.t0 + f * dt;
    NodeClearance best;
    const auto from = static_cast<size_t>(std::floor(breaks[k] * count));
    const auto to =
        std::min(points.size() - 1, static_cast<size_t>(std::ceil(breaks[k + 1] * count)));
    for (const uint32_t n : touched) {
      if (!is_around(n, s, t)) continue;
      const uint16_t classes = classes_at(n, s, t);
      if ((classes >> avatar_class & 1) == 0) continue;
      const format::Node& found = node_at(n);
      best.classes |= classes;
      best.inclination = std::min(
          {best.inclination, bins.inclination_of(found.surface() >> 4), gentlest(classes)});
      best.height = std::max(
          {best.height, bins.height_of(found.surface() & 15), tallest(classes, is_curved())});
      best.headroom =
          std::max({best.headroom, bins.height_of(found.room() >> 4), tallest(classes, false)});
      const double width = bins.width_of(found.room() & 15);
      if (width <= best.width) continue;
      if (has_middle_[n - first_] == 0) {
        const double side = 1.0 / (1 << found.level());
        middles_[n - first_] = surface_.at((found.s() + 0.5) * side, (found.t() + 0.5) * side);
        has_middle_[n - first_] = 1;
      }
      double far = 0;
      for (size_t i = from; i <= to; ++i)
        far = std::max(far, length(points[i] - middles_[n - first_]));
      best.width = std::max(best.width, width - far - apart);
    }
    best.width = std::max({best.width, closed, 0.0});
    worst.classes &= best.classes;
    worst.inclination = std::max(worst.inclination, best.inclination);
    worst.height = std::min(worst.height, best.height);
    worst.headroom = std::min(worst.headroom, best.headroom);
    worst.width = std::min(worst.width, best.width);
  }
  return worst;
}

// A ball that holds the piece of ground between two points of the parameters.
NodeClearances::Ball NodeClearances::ball_of(double s0, double t0, double s1, double t1) const {
  Ball ball{.middle = surface_.at((s0 + s1) / 2, (t0 + t1) / 2), .radius = 0};
  for (const auto& [s, t] : {std::pair{s0, t0}, {s1, t0}, {s0, t1}, {s1, t1}}) {
    ball.radius = std::max(ball.radius, kCurved * length(surface_.at(s, t) - ball.middle));
  }
  return ball;
}

// Made at the first question. Of a curved patch with balls around all that borders on it; of a
// level tile distances are those of cells in the plane.
const NodeClearances::Region& NodeClearances::region(int32_t avatar_class, uint8_t headroom) {
  for (const Region& known : regions_) {
    if (known.avatar_class == avatar_class && known.headroom == headroom) return known;
  }
  Region made{.avatar_class = avatar_class,
              .headroom = headroom,
              .rows = Rows(static_cast<size_t>(side()), 0),
              .borders = {}};
  for (uint32_t n = first_; n < end_; ++n) {
    const format::Node& node = node_at(n);
    if ((node.classes() >> avatar_class & 1) == 0 || node.room() >> 4 < headroom) continue;
    const int32_t size = side() >> node.level(), s = node.s() * size, t = node.t() * size;
    const bool is_partial = (node.flags() & kPartialFlag) != 0;
    const uint64_t cells = is_partial ? cells_of(n, avatar_class) : 0;
    const uint64_t whole = size == 64 ? UINT64_MAX : (uint64_t{1} << size) - 1;
    for (int32_t j = 0; j < size; ++j) {
      const uint64_t row = is_partial ? cells >> (8 * j) & 0xff : whole;
      made.rows[static_cast<size_t>(t + j)] |= row << s;
    }
  }
  if (is_curved()) {
    const double cell = 1.0 / side();
    const auto is_open = [&](int32_t s, int32_t t) {
      return (made.rows[static_cast<size_t>(t)] >> s & 1) != 0;
    };
    for (int32_t t = 0; t < side(); ++t) {
      for (int32_t s = 0; s < side(); ++s) {
        const double u = s * cell, v = t * cell;
        if (!is_open(s, t)) {
          made.borders.push_back(ball_of(u, v, u + cell, v + cell));
          continue;
        }
        if (s == 0) made.borders.push_back(ball_of(u, v, u, v + cell));
        if (t == 0) made.borders.push_back(ball_of(u, v, u + cell, v));
        if (s + 1 == side()) made.borders.push_back(ball_of(u + cell, v, u + cell, v + cell));
        if (t + 1 == side()) made.borders.push_back(ball_of(u, v + cell, u + cell, v + cell));
      }
    }
  }
  return regions_.emplace_back(std::move(made));
}

// Within this distance of a point the whole patch is in the region. [m]
double NodeClearances::free_distance(const Region& region, double s, double t) const {
  double nearest = std::numeric_limits<double>::infinity();
  if (is_curved()) {
    const Vec3d at = surface_.at(s, t);
    for (const Ball& ball : region.borders) {
      nearest = std::min(nearest, length(ball.middle - at) - ball.radius);
    }
    return std::max(0.0, nearest);
  }
  const double cell = data_of(data_.world)->summary.cell, u = s * kTileCells, v = t * kTileCells;
  nearest = std::min({u, v, kTileCells - u, kTileCells - v});
  for (int32_t j = 0; j < kTileCells; ++j) {
    const double dv = std::max({0.0, j - v, v - (j + 1)});
    if (dv >= nearest) continue;
    for (uint64_t shut = ~region.rows[static_cast<size_t>(j)]; shut != 0; shut &= shut - 1) {
      const int32_t i = std::countr_zero(shut);
      const double du = std::max({0.0, i - u, u - (i + 1)});
      nearest = std::min(nearest, std::hypot(du, dv));
    }
  }
  return std::max(0.0, nearest * cell - kRounding);
}

// How much higher or lower than a point the region's ground is within a radius of it, at most.
// `slope`: the steepest ground there. [m, m, degrees]
double NodeClearances::rise(const Region& region, double s, double t, double radius,
                            double slope) const {
  const Vec3d at = surface_.at(s, t);
  double most = 0;
  const double cell = 1.0 / side(), metres = data_of(data_.world)->summary.cell;
  for (int32_t j = 0; j < side(); ++j) {
    for (uint64_t open = region.rows[static_cast<size_t>(j)]; open != 0; open &= open - 1) {
      const int32_t i = std::countr_zero(open);
      if (!is_curved()) {
        const double u = s * kTileCells, v = t * kTileCells;
        const double du = std::max({0.0, i - u, u - (i + 1)}),
                     dv = std::max({0.0, j - v, v - (j + 1)});
        if (std::hypot(du, dv) * metres > radius + kRounding) continue;
        // The floor of a cell is even, so its corners are the highest and the lowest.
        constexpr double kIn = 1e-6;
        for (const double a : {i * cell + kIn, (i + 1) * cell - kIn}) {
          for (const double b : {j * cell + kIn, (j + 1) * cell - kIn}) {
            most = std::max(most, std::fabs(surface_.at(a, b).y - at.y) + kRounding);
          }
        }
        continue;
      }
      const Ball ball = ball_of(i * cell, j * cell, (i + 1) * cell, (j + 1) * cell);
      if (length(ball.middle - at) - ball.radius > radius) continue;
      // Whatever ground is within the radius has one of these points near it.
      const double near = kCurved * ball.radius / kParts;
      for (int32_t a = 0; a <= kParts; ++a) {
        for (int32_t b = 0; b <= kParts; ++b) {
          const Vec3d p = surface_.at((i + static_cast<double>(a) / kParts) * cell,
                                      (j + static_cast<double>(b) / kParts) * cell);
          if (length(p - at) > radius + near) continue;
          most = std::max(most, std::fabs(p.y - at.y) + near * std::sin(radians(slope)));
        }
      }
    }
  }
  return most;
}

bool NodeClearances::fits(uint32_t node, double s, double t, const AvatarClass& body) {
  if (!open(node)) return false;
  const auto& classes = data_of(data_.world)->summary.classes;
  const NodeBins& bins = data_.summary.bins;
  const bool leans = is_curved() && body.climb_slope > 0;
  const auto bottom_of = [&](const AvatarClass& avatar) {
    return leans ? avatar.step_height : body_bottom(avatar);
  };
  uint16_t stand = 0;
  std::array<double, kMaxAvatarClasses> steepest;
  steepest.fill(180);
  for (uint32_t n = first_; n < end_; ++n) {
    if (!is_around(n, s, t)) continue;
    const uint16_t here = classes_at(n, s, t);
    stand |= here;
    for (uint32_t left = here; left != 0; left &= left - 1) {
      double& least = steepest[static_cast<size_t>(std::countr_zero(left))];
      least = std::min({least, bins.inclination_of(node_at(n).surface() >> 4), gentlest(here)});
    }
  }
  const double limit = leans ? body.climb_slope : body.max_slope;
  for (uint32_t left = stand; left != 0; left &= left - 1) {
    const int32_t c = std::countr_zero(left);
    const AvatarClass& avatar = classes[static_cast<size_t>(c)];
    // Upright bodies say nothing about one along the normal, and the reverse.
    if (is_curved() && (avatar.climb_slope > 0) != leans) continue;
    if (steepest[static_cast<size_t>(c)] > limit || bottom_of(body) < bottom_of(avatar)) continue;
    if (body.radius <= avatar.radius && body.height <= avatar.height) return true;
    if (!leans && fits_beside(avatar, c, s, t, body)) return true;
  }
  return false;
}

// Do the bodies of a class around a point, and what is free above them, cover a body?
bool NodeClearances::fits_beside(const AvatarClass& avatar, int32_t avatar_class, double s,
                                 double t, const AvatarClass& body) {
  const NodeBins& bins = data_.summary.bins;
  const double known = free_distance(region(avatar_class, 0), s, t);
  for (const bool is_tall : {false, true}) {
    const double wide = is_tall ? body.radius : std::max(0.0, body.radius - avatar.radius);
    if (wide > known) continue;
    // The ground under it is no farther off than that in the plane and the rise together.
    double radius = wide, up = 0;
    bool is_known = false;
    for (int32_t k = 0; k < 6 && !is_known; ++k) {
      up = rise(region(avatar_class, 0), s, t, radius, avatar.max_slope);
      const double needed = std::hypot(wide, up);
      is_known = needed <= radius;
      radius = std::max(radius, needed + kRounding);
    }
    if (!is_known || body_bottom(body) < body_bottom(avatar) + up) continue;
    uint8_t headroom = 0;
    if (!is_tall) {
      if (body.height > avatar.height - up) continue;
    } else {
      const double needed = body.height + up + kRounding;
      while (headroom <= bins.height.size() && bins.height_of(headroom) < needed) ++headroom;
      if (headroom > bins.height.size()) continue;
      // What is promised begins above what any class steps over.
      if (greatest_bottom_ + 2 * up > avatar.height) continue;
    }
    if (free_distance(region(avatar_class, headroom), s, t) >= radius) return true;
  }
  return false;
}

}  // namespace throng::graph

namespace throng {

NodeClearance Nodes::clearance(int32_t avatar_class, const NodePlace& place) const {
  THRONG_ASSERT(state_);
  const size_t classes = data_of(state_->world)->summary.classes.size();
  if (!place || place.node1 > node_count()) return {};
  if (avatar_class < 0 || static_cast<size_t>(avatar_class) >= classes) return {};
  return graph::NodeClearances(*state_).along(avatar_class, place.node1 - 1,
                                              {place.s, place.t, place.s, place.t});
}

std::optional<NodeCylinder> Nodes::cylinder(uint32_t node) const {
  const NodeInfo info = this->node(node);
  const NodeBins& bins = state_->summary.bins;
  NodeCylinder cylinder{.feet = middle(node),
                        .radius = bins.width_of(info.width),
                        .height = bins.height_of(info.height)};
  const auto [zone, local] = state_->find(node);
  if (zone == nullptr || !(cylinder.radius > 0 && cylinder.height > 0)) return {};
  const double side = 1.0 / (1 << info.block_level);
  cylinder.axis = graph::surface_of(*state_, *zone, zone->patch_of(local))
                      .normal((info.s + 0.5) * side, (info.t + 0.5) * side);
  return cylinder;
}

// A node's area less that of the nodes inside it that hold the class, too.
NodeDistribution Nodes::distribution(int32_t avatar_class) const {
  THRONG_ASSERT(state_);
  NodeDistribution found;
  const auto& classes = data_of(state_->world)->summary.classes;
  if (avatar_class < 0 || static_cast<size_t>(avatar_class) >= classes.size()) return found;
  const AvatarClass& avatar = classes[static_cast<size_t>(avatar_class)];
  for (size_t s = 0; s < state_->slots.size(); ++s) {
    const graph::NodeZone* zone = state_->zone(s);
    if (zone == nullptr) continue;
    const auto nodes = zone->nodes();
    std::vector<double> own(nodes.size(), 0);
    for (uint32_t n = 0; n < nodes.size(); ++n) {
      if ((nodes[n].classes() >> avatar_class & 1) == 0) continue;
      const double area = state_->area_of(*zone, n, avatar_class);
      own[n] += area;
      const uint32_t parent = nodes[n].parent();
      if (parent == UINT32_MAX || (nodes[parent].classes() >> avatar_class & 1) == 0) continue;
      own[parent] -= area;
    }
    for (uint32_t n = 0; n < nodes.size(); ++n) {
      if (own[n] == 0) continue;
      const bool is_curved = zone->patch_of(n).kind() == static_cast<uint8_t>(PatchKind::kBezier);
      const bool climbs = is_curved && avatar.climb_slope > 0;
      const uint8_t limit =
          state_->summary.bins.inclination_code(climbs ? avatar.climb_slope : avatar.max_slope);
      const auto code = static_cast<uint8_t>(nodes[n].surface() >> 4);
      found.inclination[std::min(code, limit)] += own[n];
      // The class's own body is free along its axis.
      const uint8_t own_code = state_->summary.bins.height_code(avatar.height);
      const auto height = static_cast<uint8_t>(nodes[n].surface() & 15);
      const auto headroom = static_cast<uint8_t>(nodes[n].room() >> 4);
      found.height[climbs || !is_curved ? std::max(height, own_code) : height] += own[n];
      found.headroom[climbs ? headroom : std::max(headroom, own_code)] += own[n];
      found.width[nodes[n].room() & 15] += own[n];
    }
  }
  return found;
}

bool Nodes::fits(const NodePlace& place, const AvatarClass& body) const {
  THRONG_ASSERT(state_);
  if (!place || place.node1 > node_count()) return false;
  return graph::NodeClearances(*state_).fits(place.node1 - 1, place.s, place.t, body);
}

}  // namespace throng
