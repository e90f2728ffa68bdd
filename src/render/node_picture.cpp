// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <optional>
#include <vector>

#include "core/access.h"
#include "core/math/float_origin.h"
#include "render/air_lines.h"
#include "render/canvas.h"
#include "render/text.h"
#include "render/tile_slopes.h"
#include "throng/path.h"
#include "throng/picture.h"
#include "throng/surface.h"

// Nodes as surfaces seen at a slant from the south, as in the last figures of [PACS00]: every
// sub-patch in the colour of its inclination, smaller nodes over the larger ones that hold them,
// links and a path above. Everything goes through one depth buffer, three times too large in both
// directions and averaged at the end.
namespace throng {
namespace {

constexpr int32_t kPatchSamples = 3;
constexpr double kTurn = 0.45;      // of the view around the vertical [radians]
constexpr double kTilt = 0.82;      // of the view above the horizon [radians]
constexpr double kCell = 1.0 / 64;  // of a tile
constexpr double kInset = 1e-5;     // into a tile's cell: its far border is the next cell's
constexpr double kHeader = 64, kFooter = 58, kMargin = 24;  // [px]

struct InclinationColour {
  double degrees;
  render::Rgb colour;
};
// Green flat, yellow steep, red overhanging, as in [PACS00]; light enough for lines above.
constexpr std::array<InclinationColour, 6> kRamp{{{0, {62, 158, 84}},
                                                  {30, {142, 194, 84}},
                                                  {45, {206, 210, 78}},
                                                  {90, {246, 190, 52}},
                                                  {91, {232, 106, 66}},
                                                  {180, {176, 34, 46}}}};
constexpr render::Rgb kWalkLink{24, 92, 52}, kStepLink{196, 74, 8}, kSteepLink{150, 104, 8},
    kOverLink{140, 20, 32};
constexpr render::Rgb kAirLink{146, 84, 206}, kGroundAirLink{32, 120, 236};
constexpr render::Rgb kHoleLink{20, 20, 26}, kDropLink{214, 40, 40}, kUnderlay{226, 228, 232};

render::Rgb inclination_colour(double degrees) {
  for (size_t i = 1; i < kRamp.size(); ++i) {
    if (degrees > kRamp[i].degrees) continue;
    const InclinationColour &a = kRamp[i - 1], &b = kRamp[i];
    return render::mix(a.colour, b.colour, (degrees - a.degrees) / (b.degrees - a.degrees));
  }
  return kRamp.back().colour;
}

struct Seen {
  double x = 0, y = 0, depth = 0;  // [m], y down; smaller depth is nearer
};

class View {
 public:
  View() : cos_turn_(std::cos(kTurn)), sin_turn_(std::sin(kTurn)) {}
  [[nodiscard]] Seen operator()(Vec3d p) const {
    const double right = p.x * cos_turn_ - p.z * sin_turn_;
    const double away = -p.x * sin_turn_ - p.z * cos_turn_;
    return {right, -(away * std::sin(kTilt) + p.y * std::cos(kTilt)),
            away * std::cos(kTilt) - p.y * std::sin(kTilt)};
  }

 private:
  double cos_turn_, sin_turn_;
};

// A picture with depth.
class DepthCanvas {
 public:
  DepthCanvas(int32_t width, int32_t height)
      : canvas_(width, height, render::kPaper),
        depth_(static_cast<size_t>(width) * static_cast<size_t>(height),
               std::numeric_limits<float>::infinity()) {}

  // Corners in pixels and metres of depth.
  void triangle(const std::array<Seen, 3>& c, render::Rgb colour) {
    const double area =
        (c[1].x - c[0].x) * (c[2].y - c[0].y) - (c[2].x - c[0].x) * (c[1].y - c[0].y);
    if (!(std::fabs(area) > 1e-9)) return;
    const auto clamp = [](double v, int32_t limit) {
      return static_cast<int32_t>(std::clamp(v, 0.0, static_cast<double>(limit)));
    };
    const int32_t x0 = clamp(std::floor(std::min({c[0].x, c[1].x, c[2].x})), canvas_.width());
    const int32_t x1 = clamp(std::ceil(std::max({c[0].x, c[1].x, c[2].x})), canvas_.width());
    const int32_t y0 = clamp(std::floor(std::min({c[0].y, c[1].y, c[2].y})), canvas_.height());
    const int32_t y1 = clamp(std::ceil(std::max({c[0].y, c[1].y, c[2].y})), canvas_.height());
    for (int32_t y = y0; y < y1; ++y) {
      for (int32_t x = x0; x < x1; ++x) {
        const double px = x + 0.5, py = y + 0.5;
        const auto weight = [&](const Seen& a, const Seen& b) {
          return ((b.x - a.x) * (py - a.y) - (px - a.x) * (b.y - a.y)) / area;
        };
        const double w0 = weight(c[1], c[2]), w1 = weight(c[2], c[0]), w2 = weight(c[0], c[1]);
        if (w0 < -1e-9 || w1 < -1e-9 || w2 < -1e-9) continue;
        put(x, y, w0 * c[0].depth + w1 * c[1].depth + w2 * c[2].depth, colour);
      }
    }
  }

  void line(Seen a, Seen b, double thick, render::Rgb colour) {
    if (!clip(a, b, thick)) return;
    const double length = std::hypot(b.x - a.x, b.y - a.y);
    const int32_t steps = static_cast<int32_t>(std::min(20000.0, std::ceil(length / 0.7))) + 1;
    const auto half = static_cast<int32_t>(std::max(0.0, thick / 2 - 0.25));
    for (int32_t k = 0; k <= steps; ++k) {
      const double t = static_cast<double>(k) / steps;
      const auto x = static_cast<int32_t>(std::floor(a.x + (b.x - a.x) * t));
      const auto y = static_cast<int32_t>(std::floor(a.y + (b.y - a.y) * t));
      for (int32_t j = -half; j <= half; ++j) {
        for (int32_t i = -half; i <= half; ++i) {
          put(x + i, y + j, a.depth + (b.depth - a.depth) * t, colour);
        }
      }
    }
  }

  [[nodiscard]] const render::Canvas& canvas() const { return canvas_; }
  /// The depth of what is drawn so far. Set again, it lets later strokes cover all drawn since.
  using Depths = std::vector<float>;
  [[nodiscard]] const Depths& depths() const { return depth_; }
  void set_depths(const Depths& depths) { depth_ = depths; }

 private:
  // Cuts a line to the picture and a rim around it; false if nothing is left. Ends far outside
  // would overflow whole pixels.
  [[nodiscard]] bool clip(Seen& a, Seen& b, double rim) const {
    double first = 0, last = 1;
    const auto keep_within = [&](double from, double to, double size) {
      const double low = -rim - 1 - from, high = size + rim + 1 - from, delta = to - from;
      if (delta == 0) {
        if (low > 0 || high < 0) last = -1;
        return;
      }
      first = std::max(first, (delta > 0 ? low : high) / delta);
      last = std::min(last, (delta > 0 ? high : low) / delta);
    };
    keep_within(a.x, b.x, canvas_.width());
    keep_within(a.y, b.y, canvas_.height());
    const bool finite = std::isfinite(a.x + a.y + b.x + b.y);
    if (!finite || !(first <= last)) return false;
    const Seen from = a, delta{b.x - a.x, b.y - a.y, b.depth - a.depth};
    const auto at = [&](double t) {
      return Seen{from.x + t * delta.x, from.y + t * delta.y, from.depth + t * delta.depth};
    };
    if (first > 0) a = at(first);
    if (last < 1) b = at(last);
    return true;
  }
  void put(int32_t x, int32_t y, double depth, render::Rgb colour) {
    if (x < 0 || y < 0 || x >= canvas_.width() || y >= canvas_.height()) return;
    float& there = depth_[static_cast<size_t>(y) * static_cast<size_t>(canvas_.width()) +
                          static_cast<size_t>(x)];
    if (static_cast<float>(depth) >= there) return;
    there = static_cast<float>(depth);
    canvas_.set(x, y, colour);
  }

  render::Canvas canvas_;
  Depths depth_;
};

class NodePicture {
 public:
  NodePicture(const Nodes& nodes, const NodePictureConfig& config)
      : nodes_(nodes),
        config_(config),
        summary_(nodes.summary()),
        slopes_(*data_of(nodes.world())) {
    if (config.storey >= 0) storeys_ = nodes.world().storeys();
  }

  Result<Image> draw() {
    choose();
    if (shown_.empty()) {
      return Error{Errc::kNotFound, "picture: no node of the area, storey and class asked for"};
    }
    if (config_.air) {
      auto lines = render::air_lines(nodes_.world(), config_.area);
      if (!lines) return lines.error();
      air_ = *std::move(lines);
      for (const render::AirLine& line : air_) {
        include(view_(line.a));
        include(view_(line.b));
      }
    }
    if (config_.boxes) {
      auto boxes = air_boxes(nodes_.world(), config_.area);
      if (!boxes) {
        return Error{boxes.error().code,
                     "picture: " + boxes.error().message + "; bake it with --fly"};
      }
      boxes_ = *std::move(boxes);
      for (const Box3d& box : boxes_) {
        for (int32_t k = 0; k < 8; ++k) include(view_(corner_of(box, k)));
      }
    }
    if (config_.cylinders) list_cylinders();
    fit();
    find_links();
    DepthCanvas large(static_cast<int32_t>(width_) * kPatchSamples,
                      static_cast<int32_t>(height_) * kPatchSamples);
    for (const auto& [patch, node] : first_of_patch_) underlay(large, node);
    for (const uint32_t n : shown_) surface(large, n);
    const auto ground = config_.path.empty() ? DepthCanvas::Depths{} : large.depths();
    for (const Link& link : links_) draw(large, link);
    for (const render::AirLine& line : air_) {
      large.line(at(line.a), at(line.b, line.to_ground ? 0.3 : 0), line.to_ground ? 4 : 2,
                 line.to_ground ? kGroundAirLink : kAirLink);
    }
    for (const Shown& one : cylinders_) cylinder(large, one);
    for (const Box3d& box : boxes_) outline(large, box);
    if (!config_.path.empty()) path(large, ground);
    render::Canvas sheet(config_.width, static_cast<int32_t>(kHeader + height_ + kFooter),
                         render::kPaper);
    sheet.draw_reduced(large.canvas(), kPatchSamples, static_cast<int32_t>(kMargin),
                       static_cast<int32_t>(kHeader));
    letter(sheet);
    return std::move(sheet).take();
  }

 private:
  // Do the classes of a node or a link include the selected one?
  [[nodiscard]] bool is_for(uint16_t classes) const {
    return config_.avatar_class < 0 || (classes >> config_.avatar_class & 1) != 0;
  }

  // Is a node on the selected storey and for the selected class?
  [[nodiscard]] bool is_asked(const NodeInfo& info) const {
    const bool on_storey = config_.storey < 0 || (info.kind == PatchKind::kLevelTile &&
                                                  storeys_[info.source] == config_.storey);
    return on_storey && is_for(info.classes);
  }

  // Cells of a partial node on which the selected class stands, or any class if none is selected.
  [[nodiscard]] uint64_t cells_of(uint32_t node, const NodeInfo& info) const {
    return config_.avatar_class < 0 ? info.cells : nodes_.partial_cells(config_.avatar_class, node);
  }

  // Calls visit(corner) for corners around a node. The block of a partial node may have no floor
  // there.
  template <class Visit>
  void for_corners(uint32_t node, const NodeInfo& info, Visit visit) const {
    if (info.cells == 0) {
      for (const Vec3d& c : nodes_.corners(node)) visit(c);
      return;
    }
    for_partial_runs(cells_of(node, info), [&](int32_t first, int32_t row, int32_t count) {
      const double s = (info.s * 8 + first) * kCell, t = (info.t * 8 + row) * kCell;
      for (const double u : {0.0, count * kCell - kInset}) {
        for (const double v : {0.0, kCell - kInset}) visit(nodes_.point(node, s + u, t + v));
      }
    });
  }

  // Nodes to draw, in order; the widest view of them.
  void choose() {
    const bool whole = config_.area.max.x <= config_.area.min.x;
    for (uint32_t n = 0; n < nodes_.node_count(); ++n) {
      const NodeInfo info = nodes_.node(n);
      if (!is_asked(info)) continue;
      Box3d box;
      for_corners(n, info, [&](Vec3d c) { box.add(c); });
      const Vec3d middle = (box.min + box.max) * 0.5;
      if (!whole && !(middle.x >= config_.area.min.x && middle.x <= config_.area.max.x &&
                      middle.z >= config_.area.min.z && middle.z <= config_.area.max.z)) {
        continue;
      }
      shown_.push_back(n);
      for_corners(n, info, [&](Vec3d c) { include(view_(c)); });
      plan_.add(box.min);
      plan_.add(box.max);
      terminal_ += info.terminal ? 1 : 0;
      if (whole && info.kind == PatchKind::kBezier) first_of_patch_.try_emplace(info.source, n);
    }
  }

  // A cylinder and the code of its node's inclination.
  struct Shown {
    NodeCylinder cylinder;
    uint8_t inclination = 0;
  };

  static constexpr int32_t kSides = 24;

  // A point of a cylinder's rim, at the ground (0) or the top (1).
  static Vec3d rim_of(const NodeCylinder& c, int32_t side, double up) {
    const Vec3d other = std::fabs(c.axis.y) < 0.9 ? Vec3d{0, 1, 0} : Vec3d{1, 0, 0};
    Vec3d right = cross(other, c.axis);
    right = right * (1 / length(right));
    const double angle = 2 * std::numbers::pi * side / kSides;
    return c.feet + (right * std::cos(angle) + cross(right, c.axis) * std::sin(angle)) * c.radius +
           c.axis * (up * c.height);
  }

  static Vec3d corner_of(const Box3d& box, int32_t k) {
    return {(k & 1) != 0 ? box.max.x : box.min.x, (k & 2) != 0 ? box.max.y : box.min.y,
            (k & 4) != 0 ? box.max.z : box.min.z};
  }

  // Of the terminal nodes that are drawn.
  void list_cylinders() {
    for (const uint32_t n : shown_) {
      const NodeInfo info = nodes_.node(n);
      const auto found = info.terminal ? nodes_.cylinder(n) : std::nullopt;
      if (!found) continue;
      cylinders_.push_back({*found, inclination(n, info)});
      for (int32_t k = 0; k < kSides; ++k) include(view_(rim_of(*found, k, 1)));
    }
  }

  void cylinder(DepthCanvas& canvas, const Shown& one) const {
    const render::Rgb colour =
        render::shade(inclination_colour(summary_.bins.inclination_of(one.inclination)), 0.55);
    for (int32_t k = 0; k < kSides; ++k) {
      for (const double up : {0.0, 1.0}) {
        canvas.line(at(rim_of(one.cylinder, k, up), 0.05),
                    at(rim_of(one.cylinder, k + 1, up), 0.05), 2, colour);
      }
      if (k % 6 != 0) continue;
      canvas.line(at(rim_of(one.cylinder, k, 0), 0.05), at(rim_of(one.cylinder, k, 1), 0.05), 2,
                  colour);
    }
  }

  void outline(DepthCanvas& canvas, const Box3d& box) const {
    for (int32_t k = 0; k < 8; ++k) {
      for (const int32_t axis : {1, 2, 4}) {
        if ((k & axis) != 0) continue;
        canvas.line(at(corner_of(box, k)), at(corner_of(box, k | axis)), 1, kAirLink);
      }
    }
  }

  void include(const Seen& s) {
    low_x_ = std::min(low_x_, s.x);
    high_x_ = std::max(high_x_, s.x);
    low_y_ = std::min(low_y_, s.y);
    high_y_ = std::max(high_y_, s.y);
    low_depth_ = std::min(low_depth_, s.depth);
  }

  void fit() {
    width_ = config_.width - 2 * kMargin;
    const double across = std::max(high_x_ - low_x_, 1e-3), down = std::max(high_y_ - low_y_, 1e-3);
    scale_ = std::min(width_ / across, 1.1 * width_ / down);
    height_ = std::ceil(down * scale_) + 8;
    depth_origin_ = float_origin({0, 0, low_depth_}).z;
  }

  [[nodiscard]] Seen at(Vec3d p, double nearer = 0) const {
    const Seen s = view_(p);
    const double k = scale_ * kPatchSamples;
    const double left = (width_ - (high_x_ - low_x_) * scale_) / 2 * kPatchSamples;
    return {(s.x - low_x_) * k + left, (s.y - low_y_) * k + 4 * kPatchSamples,
            s.depth - depth_origin_ - nearer};
  }

  // Of the parameters of a patch.
  struct Block {
    double s = 0, t = 0, wide = 1, deep = 1;
  };

  // Calls quad(corners, normal) for pieces of a block of a patch, small enough to look curved.
  template <class Quad>
  void pieces(uint32_t node, const Block& block, int32_t parts, Quad quad) const {
    const double wide = block.wide / parts, deep = block.deep / parts;
    for (int32_t j = 0; j < parts; ++j) {
      for (int32_t i = 0; i < parts; ++i) {
        const double s = block.s + i * wide, t = block.t + j * deep;
        const std::array<Vec3d, 4> c = {nodes_.point(node, s, t), nodes_.point(node, s, t + deep),
                                        nodes_.point(node, s + wide, t + deep),
                                        nodes_.point(node, s + wide, t)};
        quad(c, cross(c[2] - c[0], c[3] - c[1]));
      }
    }
  }

  void fill(DepthCanvas& canvas, const std::array<Vec3d, 4>& c, Vec3d normal, render::Rgb colour,
            double nearer) const {
    // Light from the upper left, so that forms are seen where the colour is one.
    const double size = length(normal);
    const Vec3d light{-0.35, 0.85, 0.39};
    const double lit = size > 0 ? std::fabs(dot(normal, light)) / size : 1;
    const render::Rgb shaded = render::shade(colour, 0.72 + 0.30 * lit);
    const std::array<Seen, 4> p = {at(c[0], nearer), at(c[1], nearer), at(c[2], nearer),
                                   at(c[3], nearer)};
    canvas.triangle({p[0], p[1], p[2]}, shaded);
    canvas.triangle({p[0], p[2], p[3]}, shaded);
  }

  void underlay(DepthCanvas& canvas, uint32_t node) const {
    pieces(node, {}, 16, [&](const std::array<Vec3d, 4>& c, Vec3d normal) {
      fill(canvas, c, normal, kUnderlay, -0.15);
    });
  }

  // Inclination of the steepest ground in a node. In level tiles it is at most what the node
  // promises, which is a limit of the classes that fit there. [code]
  [[nodiscard]] uint8_t inclination(uint32_t node, const NodeInfo& info) {
    if (info.kind != PatchKind::kLevelTile) return info.inclination;
    uint8_t limit = info.inclination, code = 0;
    if (config_.avatar_class >= 0) {
      const auto c = static_cast<size_t>(config_.avatar_class);
      limit = std::min(limit, summary_.bins.inclination_code(summary_.classes[c].max_slope));
    }
    const int32_t size = kTileCells >> info.block_level;
    const uint64_t cells = info.cells != 0 ? cells_of(node, info) : 0;
    for (int32_t i = 0; i < size * size && code < limit; ++i) {
      if (info.cells != 0 && (cells >> i & 1) == 0) continue;
      const double degrees =
          slopes_.at(info.source, info.s * size + i % size, info.t * size + i / size);
      code = std::max(code, summary_.bins.inclination_code(degrees));
    }
    return std::min(code, limit);
  }

  void surface(DepthCanvas& canvas, uint32_t node) {
    const NodeInfo info = nodes_.node(node);
    // The far corners of a tile's cells lie in the next cells, which may have no floor.
    const double whole = 1.0 / (1 << info.block_level);
    const double side = whole - (info.kind == PatchKind::kLevelTile ? kInset : 0);
    const double s0 = info.s * whole, t0 = info.t * whole;
    const render::Rgb colour =
        inclination_colour(summary_.bins.inclination_of(inclination(node, info)));
    const int32_t parts = info.kind == PatchKind::kBezier ? std::max(1, 16 >> info.block_level) : 1;
    const double nearer = 0.01 * info.block_level;
    const auto paint = [&](const Block& block) {
      pieces(node, block, parts, [&](const std::array<Vec3d, 4>& c, Vec3d normal) {
        fill(canvas, c, normal, colour, nearer);
      });
    };
    const render::Rgb rim = render::shade(colour, 0.62);
    if (info.cells != 0) {
      const uint64_t cells = cells_of(node, info);
      for_partial_runs(cells, [&](int32_t first, int32_t row, int32_t count) {
        paint({(info.s * 8 + first) * kCell, (info.t * 8 + row) * kCell, count * kCell - kInset,
               kCell - kInset});
      });
      if (whole * kTileCells * nodes_.world().summary().cell * scale_ >= 5)
        rim_of_cells(canvas, info, node, cells, rim, nearer);
      return;
    }
    paint({s0, t0, side, side});
    // The rim, unless it would cover the whole block.
    const auto corners = nodes_.corners(node);
    const double pixels = length(corners[2] - corners[0]) * scale_;
    if (pixels < 5) return;
    const auto edge = [&](double sa, double ta, double sb, double tb) {
      const int32_t n = 2 * parts;
      for (int32_t k = 0; k < n; ++k) {
        const double a = static_cast<double>(k) / n, b = static_cast<double>(k + 1) / n;
        canvas.line(at(nodes_.point(node, sa + (sb - sa) * a, ta + (tb - ta) * a), nearer + 0.05),
                    at(nodes_.point(node, sa + (sb - sa) * b, ta + (tb - ta) * b), nearer + 0.05),
                    1, rim);
      }
    };
    edge(s0, t0, s0 + side, t0);
    edge(s0, t0, s0, t0 + side);
    edge(s0 + side, t0, s0 + side, t0 + side);
    edge(s0, t0 + side, s0 + side, t0 + side);
  }

  // Sides of cells that border no other cell of the node.
  void rim_of_cells(DepthCanvas& canvas, const NodeInfo& info, uint32_t node, uint64_t cells,
                    render::Rgb colour, double nearer) const {
    constexpr double kSide = kCell - kInset;
    const auto is_in = [&](int32_t s, int32_t t) {
      return s >= 0 && t >= 0 && s < 8 && t < 8 && (cells >> (8 * t + s) & 1) != 0;
    };
    for (uint64_t left = cells; left != 0; left &= left - 1) {
      const int32_t i = std::countr_zero(left) % 8, j = std::countr_zero(left) / 8;
      const double s = (info.s * 8 + i) * kCell, t = (info.t * 8 + j) * kCell;
      const auto edge = [&](double sa, double ta, double sb, double tb) {
        canvas.line(at(nodes_.point(node, sa, ta), nearer + 0.05),
                    at(nodes_.point(node, sb, tb), nearer + 0.05), 1, colour);
      };
      if (!is_in(i - 1, j)) edge(s, t, s, t + kSide);
      if (!is_in(i + 1, j)) edge(s + kSide, t, s + kSide, t + kSide);
      if (!is_in(i, j - 1)) edge(s, t, s + kSide, t);
      if (!is_in(i, j + 1)) edge(s, t + kSide, s + kSide, t + kSide);
    }
  }

  struct Link {
    uint32_t from = 0;
    NodeArc arc;
  };

  // Links of the selected class between nodes that are drawn: their number, and those to draw. Both
  // directions of a link are arcs: one of them is drawn, except for drop links.
  void find_links() {
    for (const uint32_t n : shown_) {
      const NodeInfo info = nodes_.node(n);
      for (const NodeArc& arc : nodes_.arcs(n)) {
        const bool drops = arc.kind == LinkKind::kDrop;
        if (!is_for(arc.classes) || (arc.to < n && !drops)) continue;
        if (!std::binary_search(shown_.begin(), shown_.end(), arc.to)) continue;
        ++link_count_;
        // Large nodes that hold smaller ones would only add lines across them.
        const bool seen = arc.over_hole || (info.terminal && nodes_.node(arc.to).terminal);
        if (config_.links && seen) links_.push_back({n, arc});
      }
    }
  }

  void draw(DepthCanvas& canvas, const Link& link) const {
    const NodeArc& arc = link.arc;
    const Vec3d a =
        arc.over_hole ? nodes_.point(link.from, arc.from_s, arc.from_t) : nodes_.middle(link.from);
    const Vec3d b =
        arc.over_hole ? nodes_.point(arc.to, arc.to_s, arc.to_t) : nodes_.middle(arc.to);
    if (arc.kind == LinkKind::kDrop) {
      const Vec3d over{b.x, a.y, b.z};
      canvas.line(at(a, 0.6), at(over, 0.6), 3, kDropLink);
      canvas.line(at(over, 0.6), at(b, 0.6), 3, kDropLink);
      return;
    }
    const double steepest = summary_.bins.inclination_of(
        std::max(nodes_.node(link.from).inclination, nodes_.node(arc.to).inclination));
    render::Rgb colour = steepest > 90 ? kOverLink : steepest > 45 ? kSteepLink : kWalkLink;
    if (arc.kind == LinkKind::kStep) colour = kStepLink;
    if (arc.over_hole) colour = kHoleLink;
    canvas.line(at(a, 0.6), at(b, 0.6), arc.over_hole ? 3 : 2, colour);
  }

  // Clips a segment of the path to the ground that is drawn; false if nothing is left.
  [[nodiscard]] bool clip_to_map(Vec3d& a, Vec3d& b) const {
    double first = 0, last = 1;
    const auto keep_within = [&](double from, double to, double low, double high) {
      if (from == to) {
        if (from < low || from > high) last = -1;
        return;
      }
      const double enters = ((from < to ? low : high) - from) / (to - from);
      const double leaves = ((from < to ? high : low) - from) / (to - from);
      first = std::max(first, enters);
      last = std::min(last, leaves);
    };
    keep_within(a.x, b.x, plan_.min.x, plan_.max.x);
    keep_within(a.z, b.z, plan_.min.z, plan_.max.z);
    if (!(first <= last)) return false;
    const Vec3d from = a, delta = b - a;
    if (first > 0) a = from + delta * first;
    if (last < 1) b = from + delta * last;
    return true;
  }

  // Above all links, with the rim behind the path; only ground hides it.
  void path(DepthCanvas& canvas, const DepthCanvas::Depths& ground) const {
    const auto stroke = [&](double thick, render::Rgb colour) {
      canvas.set_depths(ground);
      for (size_t i = 1; i < config_.path.size(); ++i) {
        Vec3d a = config_.path[i - 1], b = config_.path[i];
        if (clip_to_map(a, b)) canvas.line(at(a, 1.2), at(b, 1.2), thick, colour);
      }
    };
    stroke(9, render::kPaper);
    stroke(5, render::kPath);
  }

  void letter(render::Canvas& sheet) const {
    render::draw_text(sheet, {kMargin, 30}, config_.title, {.size = 15, .bold = true});
    const std::string in_all =
        shown_.size() < summary_.nodes ? fmt::format(", {} in all", summary_.nodes) : "";
    const std::string line = fmt::format("{} nodes ({} of them terminal){}; {} links",
                                         shown_.size(), terminal_, in_all, link_count_);
    render::draw_text(sheet, {kMargin, 52}, line, {.size = 9, .colour = render::kFaintInk});
    double y = kHeader + height_ + 20;
    const double right = config_.width - kMargin;
    double end = right - draw_scale(sheet, right, y) - 24;
    double x = kMargin;
    // What does not fit beside the scale goes into a second row.
    const auto make_room = [&](double width) {
      if (x + width <= end) return;
      x = kMargin;
      y += 20;
      end = right;
    };
    double last = 0;
    std::vector<double> edges = summary_.bins.inclination;
    if (edges.empty() || edges.back() < 180) edges.push_back(180);
    for (const double edge : edges) {
      const std::string label = fmt::format("{:.0f}-{:.0f}", last, edge);
      const double width = 38 + render::text_width(label, {.size = 8});
      make_room(width);
      sheet.fill({x, y, 22, 12}, inclination_colour(edge));
      render::draw_text(sheet, {x + 27, y + 10}, label, {.size = 8});
      x += width;
      last = edge;
    }
    make_room(70);
    render::draw_text(sheet, {x, y + 10}, "degrees", {.size = 8});
    x += 70;
    const auto key = [&](render::Rgb colour, const char* label) {
      const double width = 40 + render::text_width(label, {.size = 8});
      make_room(width);
      sheet.line({x, y + 6}, {x + 20, y + 6}, 2, colour);
      render::draw_text(sheet, {x + 26, y + 10}, label, {.size = 8});
      x += width;
    };
    if (config_.links) {
      key(kWalkLink, "link");
      key(kStepLink, "step");
      key(kSteepLink, "steep");
      key(kOverLink, "overhanging");
      key(kHoleLink, "over a hole");
      bool drop = false;
      for (size_t c = 0; c < summary_.classes.size(); ++c) {
        drop |= summary_.classes[c].max_drop > 0 && is_for(static_cast<uint16_t>(1u << c));
      }
      if (drop) key(kDropLink, "drop");
    }
    if (config_.air) {
      key(kAirLink, "air");
      key(kGroundAirLink, "air to ground");
    }
    if (config_.boxes) key(kAirLink, "boxes of the air");
  }

  // A length of 1, 2 or 5 times a power of ten, along the slanted x axis. Returns what it takes.
  double draw_scale(render::Canvas& sheet, double right, double y) const {
    double metres = 1;
    for (const double step : {2.0, 5.0, 10.0, 20.0, 50.0, 100.0, 200.0, 500.0, 1000.0}) {
      if (step * scale_ < 120) metres = step;
    }
    const std::string label = fmt::format("{:g} m", metres);
    sheet.line({right - metres * scale_, y + 6}, {right, y + 6}, 2, render::kInk);
    render::draw_text(sheet, {right - metres * scale_ - 8, y + 10}, label,
                      {.size = 8, .align = render::Align::kRight});
    return metres * scale_ + 8 + render::text_width(label, {.size = 8});
  }

  const Nodes& nodes_;
  const NodePictureConfig& config_;
  NodeSummary summary_;
  std::vector<int32_t> storeys_;
  View view_;
  std::vector<uint32_t> shown_;
  std::vector<Link> links_;  // to draw
  uint64_t link_count_ = 0;
  Box3d plan_;  // around what is drawn
  render::TileSlopes slopes_;
  std::vector<render::AirLine> air_;
  std::vector<Box3d> boxes_;  // of the air
  std::vector<Shown> cylinders_;
  std::map<uint32_t, uint32_t> first_of_patch_;  // a node of each Bezier patch
  uint64_t terminal_ = 0;
  double low_x_ = 1e30, high_x_ = -1e30, low_y_ = 1e30, high_y_ = -1e30;
  double low_depth_ = 1e30, depth_origin_ = 0;  // the latter for floats
  double scale_ = 1, width_ = 0, height_ = 0;
};

}  // namespace

Result<Image> draw_nodes(const Nodes& nodes, const NodePictureConfig& config) {
  if (config.width < 200 || config.width > 16000) {
    return Error{Errc::kBadConfig, "picture: the width must be 200 to 16000 pixels"};
  }
  if (nodes && config.avatar_class >= static_cast<int32_t>(nodes.summary().classes.size())) {
    return Error{Errc::kBadConfig, "picture: the world has no such avatar class"};
  }
  if (!nodes || nodes.node_count() == 0) {
    return Error{Errc::kNotFound, "picture: this world has no nodes to draw"};
  }
  if (auto ok = nodes.check_all(); !ok) return ok.error();
  return NodePicture(nodes, config).draw();
}

}  // namespace throng
