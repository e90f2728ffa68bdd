// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "path/overlay/node_finder.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>
#include <utility>

#include "core/access.h"
#include "path/edits/blocked_cells.h"
#include "path/edits/ground_finder.h"
#include "path/edits/solid.h"
#include "path/ground/blocker.h"
#include "path/ground/reset_path.h"
#include "path/overlay/overlay_search.h"
#include "path/surface/block_squares.h"
#include "path/surface/node_changes.h"
#include "path/surface/node_island.h"
#include "path/surface/node_parts.h"
#include "path/surface/node_search.h"
#include "path/surface/node_string.h"
#include "path/surface/node_view.h"
#include "world/place.h"

// Finds paths over nodes: places the ends, searches (blocks when near, the overlay when far), pulls
// the path taut, and reports what blocks it. Time: n log n in the crossings that the search expands
// or, over the overlay, in the boundary nodes of overlay cells; then the corridor's length.
namespace throng::path {
namespace {

constexpr double kEdgeStep = 1e-4;  // of a patch's parameters, for derivatives
constexpr size_t kMaxPieces = 4096;
// A search of fewer crossings takes no noticeable time.
constexpr size_t kMinOverlayCrossings = size_t{1} << 15;
// Places no farther apart than so many sides of an overlay cell may be joined by a path that
// expands so few crossings that it need not be led over entrances.
constexpr double kNearSides = 3;
constexpr uint64_t kNearCrossings = 2048;

}  // namespace

struct NodeFinder::Shared {
  Shared(graph::NodeMesh made, const PathConfig& config)
      : mesh(std::move(made)),
        slope_cost(config.slope_cost),
        added(added_costs(mesh, config.narrow_cost, config.low_cost)),
        squares(mesh),
        parts(mesh, config.workers) {
    for (size_t p = 0; p < mesh.portals().size(); ++p) {
      const graph::NodePortal portal = mesh.portals()[p];
      if (!portal.over_hole) continue;
      const Vec3d a = mesh.surface(portal.a).at(portal.on_a[0], portal.on_a[1]);
      const Vec3d b = mesh.surface(portal.b).at(portal.on_b[0], portal.on_b[1]);
      longest_hole_link = std::max(longest_hole_link, length(b - a));
    }
    if (config.overlay && mesh.portals().size() >= kMinOverlayCrossings) {
      const NodeView baked(mesh);
      overlay = Overlay(mesh, PieceCost(baked, slope_cost, added), config.workers);
    }
  }
  Shared(const Shared&) = delete;  // `squares` may point to `mesh`
  Shared& operator=(const Shared&) = delete;
  graph::NodeMesh mesh;
  double slope_cost;
  std::vector<double> added;  // to what a metre costs, by block
  BlockSquares squares;
  NodeParts parts;
  Overlay overlay;
  double longest_hole_link = 0;  // [m]
  double seconds = 0;

  /// The block of a place, as it was baked.
  [[nodiscard]] BlockPoint block_of(const NodePlace& place) const;
  [[nodiscard]] BlockPoint block_of(const Place& place) const;
};

struct NodeFinder::Scratch {
  Scratch(const Shared& of, NodeChanges made)
      : shared(of),
        changes(std::move(made)),
        view(of.mesh, &changes),
        cost(view, of.slope_cost, of.added),
        search(view, cost),
        far_search(view, cost, of.overlay),
        pull(view, cost) {}
  explicit Scratch(const Shared& of)
      : Scratch(of, NodeChanges(of.mesh, of.squares, of.longest_hole_link)) {}
  Scratch(const Scratch&) = delete;  // its parts point to each other
  Scratch& operator=(const Scratch&) = delete;

  const Shared& shared;
  NodeChanges changes;
  uint64_t version = 0;  // of the changes that searches know
  NodeView view;
  PieceCost cost;
  NodeSearch search;
  OverlaySearch far_search;
  NodeParts::Reached reached;
  NodeIsland islands;
  NodeString pull;
  std::vector<Crossing> crossings;
  std::vector<PulledCrossing> pulled;

  void update() {
    if (version == changes.version()) return;
    version = changes.version();
    changes.update();
    far_search.update();
  }
  // The search that goes on, or comes next.
  enum class Step : uint8_t {
    kNear,   // over crossings near the ends
    kFar,    // over the overlay
    kAll,    // over all crossings
    kFlood,  // the same to the goal itself: to what comes nearest to it
    kEnded,
  };
  void begin_search();
  void begin_step(Step to);
  [[nodiscard]] Step next_step(PathEnd end) const;
  bool advance(Slice& slice);
  void head_to_nearest();

  // The query.
  BlockPoint start, goal;
  std::optional<BlockPoint> nearest;  // the place that the search leads to, if it is not the goal
  bool heads_to_nearest = false;      // which obstacles may have cut off, too
  Vec3d goal_at;
  double spacing = 0;
  SearchBudget budget;
  bool reachable = false;  // the goal, as far as is known
  Step step = Step::kEnded;
  SearchBudget step_budget;
  PathEnd end = PathEnd::kNoPlace;
  uint64_t nodes = 0;  // of the steps before
  uint64_t taken = 0;  // from the slices before
  double searched_cost = 0;

  [[nodiscard]] BlockPoint locate(const NodePlace& place) const;
  [[nodiscard]] BlockPoint target() const { return nearest.value_or(goal); }
};

// Over crossings nearby if the ends are near, else over the overlay; if that finds none, over all.
void NodeFinder::Scratch::begin_search() {
  if (shared.overlay.empty()) return begin_step(Step::kAll);
  const double far = length(position(view, target()) - position(view, start));
  const bool near = far <= kNearSides * shared.overlay.overlay_levels().front().side;
  begin_step(near ? Step::kNear : Step::kFar);
}

void NodeFinder::Scratch::begin_step(Step to) {
  step = to;
  step_budget = budget.after(nodes);
  if (to == Step::kFlood) nearest.reset();
  if (to == Step::kNear) step_budget.max_nodes = std::min(step_budget.max_nodes, kNearCrossings);
  if (to == Step::kFar) return far_search.begin(start, target());
  if (to != Step::kEnded) search.begin(start, target());
}

NodeFinder::Scratch::Step NodeFinder::Scratch::next_step(PathEnd ended) const {
  const bool stopped = budget.cancel != nullptr && *budget.cancel;
  if (step == Step::kNear && ended == PathEnd::kBudgetExhausted && !stopped) return Step::kFar;
  if (ended != PathEnd::kUnreachable) return Step::kEnded;
  if (step == Step::kFar) return Step::kAll;
  // The place that seemed the nearest cannot be reached either.
  return step != Step::kFlood && heads_to_nearest ? Step::kFlood : Step::kEnded;
}

// False: the slice is spent.
bool NodeFinder::Scratch::advance(Slice& slice) {
  while (step != Step::kEnded) {
    const bool far = step == Step::kFar;
    const auto ended = far ? far_search.advance(step_budget, slice, search, crossings)
                           : search.advance(step_budget, slice, crossings);
    if (!ended) return false;
    nodes += far ? far_search.expanded() : search.expanded();
    searched_cost = far ? far_search.cost() : search.cost();
    end = *ended;
    begin_step(next_step(end));
  }
  return true;
}

// At the reachable place that comes nearest to a goal that obstacles have cut off. A place that
// seems near may itself be cut off.
void NodeFinder::Scratch::head_to_nearest() {
  constexpr int kMaxIslands = 16;
  if (islands.close(view, start.block, goal.block, NodeIsland::Direction::kOut)) {
    return begin_step(Step::kAll);
  }
  for (int i = 0; i < kMaxIslands; ++i) {
    const auto is_cut_off = [&](uint32_t block) { return islands.holds(block); };
    const BlockPoint last =
        shared.parts.nearest(view, start, position(view, goal), reached, is_cut_off);
    if (islands.close(view, last.block, start.block, NodeIsland::Direction::kIn)) continue;
    nearest = last;
    heads_to_nearest = true;
    return begin_search();
  }
  begin_step(Step::kAll);
}

namespace {

// Builds the path that is returned: points along the surface, links, corridor.
class PathBuilder {
 public:
  PathBuilder(const NodeView& view, const PieceCost& cost, double spacing, Path& path)
      : view_(view), cost_(cost), spacing_(spacing), path_(path) {}

  void begin(const BlockPoint& at) {
    add(at, SegmentKind::kWalk);
    last_ = at;
    path_.corridor.push_back(node_of(at));
  }

  void go_on(const BlockPoint& to) {
    // Where a path leads through the corner of a block it covers no distance, and adds no point.
    if (to.s == last_.s && to.t == last_.t) {
      last_ = to;
      return;
    }
    const Vec3d from_at = path_.points.back().position;
    const graph::NodeSurface& surface = view_.surface(to.block);
    const Vec3d to_at = surface.at(to.s, to.t);
    const auto piece = cost_(last_.block, last_.s, last_.t, from_at, to.s, to.t, to_at);
    path_.cost += piece.cost;
    const auto parts = static_cast<size_t>(
        std::clamp(std::ceil(piece.length / spacing_), 1.0, static_cast<double>(kMaxPieces)));
    for (size_t k = 1; k <= parts; ++k) {
      const double f = static_cast<double>(k) / static_cast<double>(parts);
      const auto along = [&](double a, double b) { return k == parts ? b : a + (b - a) * f; };
      add({to.block, along(last_.s, to.s), along(last_.t, to.t)}, SegmentKind::kWalk);
    }
    last_ = to;
  }

  // A path of length 0 has two ends, too.
  void end() {
    if (path_.points.size() != 1) return;
    path_.points.push_back(path_.points.front());
    path_.node_places.push_back(path_.node_places.front());
    path_.segments.push_back(SegmentKind::kWalk);
  }

  void cross(const PulledCrossing& crossing) {
    const graph::NodePortal portal = view_.portal(crossing.crossing.portal);
    path_.cost +=
        view_.cost_through(crossing.crossing.portal, portal, crossing.out_at, crossing.in_at);
    const bool is_link = view_.is_link(crossing.crossing.portal);
    const bool same_patch =
        view_.block(crossing.out.block).patch == view_.block(crossing.in.block).patch;
    if (same_patch && !portal.over_hole) {
      // One point of both blocks: it becomes the next one's.
      path_.node_places.back().node1 = node_of(crossing.in) + 1;
    } else {
      if (portal.kind == LinkKind::kDrop) add_over(crossing.in_at);
      add(crossing.in, is_link ? SegmentKind::kOffMesh : SegmentKind::kCross);
    }
    last_ = crossing.in;
    if (portal.inside) return;
    path_.links.push_back(
        {static_cast<uint32_t>(path_.points.size() - 1), portal.kind, portal.over_hole});
    path_.corridor.push_back(node_of(crossing.in));
  }

 private:
  [[nodiscard]] uint32_t node_of(const BlockPoint& at) const { return view_.block(at.block).node; }

  // Level with the last point, above where the body drops to.
  void add_over(Vec3d to) {
    const Vec3d last = path_.points.back().position, feet{to.x, last.y, to.z}, up{0, 1, 0};
    path_.length += length(feet - last);
    put({.feet = feet, .axis = up, .normal = up}, SegmentKind::kCross);
  }

  void add(const BlockPoint& at, SegmentKind kind) {
    const graph::NodeSurface& surface = view_.surface(at.block);
    const auto& classes = data_of(data_of(view_.mesh().nodes())->world)->summary.classes;
    const bool climbs = classes[static_cast<size_t>(view_.mesh().avatar_class())].climb_slope > 0;
    const Vec3d normal = surface.normal(at.s, at.t), feet = surface.at(at.s, at.t);
    if (!path_.points.empty()) path_.length += length(feet - path_.points.back().position);
    put({node_of(at) + 1, feet, climbs ? normal : Vec3d{0, 1, 0}, normal, at.s, at.t}, kind);
  }

  void put(const NodePlace& place, SegmentKind kind) {
    if (!path_.points.empty()) path_.segments.push_back(kind);
    path_.points.push_back({place.feet});
    path_.node_places.push_back(place);
  }

  const NodeView& view_;
  const PieceCost& cost_;
  double spacing_;
  Path& path_;
  BlockPoint last_;
};

// A block of a node in or on whose border a point lies, and that is accepted; or kNoNode.
template <class Accept>
uint32_t block_around(const graph::NodeMesh& mesh, uint32_t node, double s, double t,
                      Accept accept) {
  constexpr double kEdgeOffset = 1e-9;
  const uint32_t patch = mesh.patch_of_node(node);
  for (const double j : {kEdgeOffset, -kEdgeOffset}) {
    for (const double i : {kEdgeOffset, -kEdgeOffset}) {
      const uint32_t block = mesh.block_at(patch, s + i, t + j);
      if (block == graph::kNoNode || mesh.blocks()[block].node != node) continue;
      if (accept(mesh.blocks()[block])) return block;
    }
  }
  return graph::kNoNode;
}

// What blocks the class from a block towards a position.
FoundBlocker blocker_towards(const NodeView& view, const BlockPoint& from, Vec3d goal) {
  const graph::NodeMesh& mesh = view.mesh();
  const graph::NodeBlock& block = view.block(from.block);
  const graph::NodeSurface& surface = view.surface(from.block);
  const auto& classes = data_of(data_of(mesh.nodes())->world)->summary.classes;
  const AvatarClass& avatar = classes[static_cast<size_t>(mesh.avatar_class())];
  // Just beyond the side of the block that lies nearest to the goal.
  const double side = block.side(), s0 = block.s * side, t0 = block.t * side;
  const double beyond = 0.5 / (1 << std::max(surface.depth, block.level));
  const double s1 = s0 + side / 2, t1 = t0 + side / 2;
  double s = s1, t = t1, nearest = std::numeric_limits<double>::infinity();
  bool outside = true;
  for (const auto& [i, j] : {std::pair{-1, 0}, {1, 0}, {0, -1}, {0, 1}}) {
    const double edge_s = s1 + i * side / 2, edge_t = t1 + j * side / 2;
    const Vec3d at = surface.at(edge_s - i * kEdgeStep, edge_t - j * kEdgeStep);
    const double far = length(goal - at);
    if (far >= nearest) continue;
    nearest = far;
    s = edge_s + i * beyond;
    t = edge_t + j * beyond;
    outside = s < 0 || t < 0 || s > 1 || t > 1;
  }
  if (!view.is_as_baked() && !outside) {
    // A body could stand there, were it not for an edit.
    const uint32_t next = mesh.block_at(block.patch, s, t);
    if (next != graph::kNoNode && view.changes()->part_at(next, s, t) == graph::kNoNode) {
      const FoundBlocker found = view.changes()->blocker_at(next, s, t);
      return found.blocker != Blocker::kNone ? found : FoundBlocker{Blocker::kNarrow, 0};
    }
  }
  if (surface.points == nullptr) {
    // What blocks a straight walk, as over level tiles without nodes.
    const world::WorldData& world = *surface.world;
    const world::WorldGround ground{world, mesh.avatar_class()};
    world::GroundLevel level = world::ground_level(world, surface.source, mesh.avatar_class());
    const Vec3d feet = surface.at(std::clamp(from.s, s0 + kEdgeStep, s0 + side - kEdgeStep),
                                  std::clamp(from.t, t0 + kEdgeStep, t0 + side - kEdgeStep));
    const world::WalkStop stop =
        world::walk_far(ground, level, world::to_ground(world, feet.x, feet.z),
                        world::to_ground(world, goal.x, goal.z), world::step_mm(avatar));
    return {stop.arrived ? Blocker::kGap : blocker_beyond(ground, level, stop), 0};
  }
  if (outside) return {Blocker::kGap, 0};
  const double limit = avatar.climb_slope > 0 ? avatar.climb_slope : avatar.max_slope;
  const double slope =
      std::acos(std::clamp(surface.normal(s, t).y, -1.0, 1.0)) * 180 / std::numbers::pi;
  if (slope > limit) return {Blocker::kSteep, 0};
  // Classes that can stand there show which measure of this one is too large.
  const Nodes& nodes = mesh.nodes();
  Blocker found = Blocker::kNarrow;
  for (uint32_t node = block.node; node < nodes.node_count(); ++node) {
    const NodeInfo info = nodes.node(node);
    if (info.kind != PatchKind::kBezier || info.source != surface.source) break;
    const double blocks = 1 << info.block_level;
    if (s * blocks < info.s || s * blocks > info.s + 1 || t * blocks < info.t ||
        t * blocks > info.t + 1) {
      continue;
    }
    for (size_t c = 0; c < classes.size(); ++c) {
      if ((info.classes >> c & 1) == 0) continue;
      if (classes[c].radius >= avatar.radius && classes[c].height < avatar.height) {
        found = Blocker::kLow;
      }
    }
  }
  return {found, 0};
}

// The parameters of a point in the patch of its tile.
std::pair<double, double> in_tile(world::GroundPoint at) {
  const auto along = [](int64_t unit) {
    return (static_cast<double>(unit & (64 * world::kUnitsPerCell - 1)) + 0.5) /
           (64 * world::kUnitsPerCell);
  };
  return {along(at.x), along(at.z)};
}

// Calls visit(block, s, t) for the parts and blocks of level tiles that may have a point no farther
// than `radius`, which the calls may reduce: with the point that lies nearest in the plane.
template <class Visit>
void for_each_level_part(const NodeView& view, Vec3d position, const double& radius, Visit visit) {
  const graph::NodeMesh& mesh = view.mesh();
  const world::WorldData& world = *data_of(data_of(mesh.nodes())->world);
  const std::array<double, 2> plan{position.x, position.z};
  const SquareRange tiles = tiles_near(world, std::span(&plan, 1), std::min(radius, 1e6));
  const double tile = world.summary.cell * kTileCells;
  const auto consider = [&](uint32_t block, double s, double t) {
    const double side = view.block(block).side(), low_s = view.block(block).s * side,
                 low_t = view.block(block).t * side;
    const auto inside = [&](double at, double low) {
      return std::clamp(at, low + graph::kTileInset, low + side - graph::kTileInset);
    };
    const double at_s = inside(s, low_s), at_t = inside(t, low_t);
    constexpr double kRounding = 1e-6;  // [m]
    if (std::hypot(at_s - s, at_t - t) * tile <= radius + kRounding) visit(block, at_s, at_t);
  };
  for (int32_t z = tiles.first_z; z <= tiles.last_z; ++z) {
    for (int32_t x = tiles.first_x; x <= tiles.last_x; ++x) {
      const double s = (position.x - world.summary.origin.x) / tile - x;
      const double t = (position.z - world.summary.origin.z) / tile - z;
      const auto levels = world.tile_levels(x, z);
      for (uint32_t level = levels.first; level < levels.last; ++level) {
        const uint32_t patch = mesh.patch_of_level(level);
        if (patch == graph::kNoNode) continue;
        const auto count = static_cast<uint32_t>(mesh.blocks_of(patch).size());
        for (uint32_t b = mesh.first_block(patch); b < mesh.first_block(patch) + count; ++b) {
          const auto parts = view.changes()->parts_of(b);
          if (!parts) consider(b, s, t);
          for (uint32_t p = parts ? parts->first : 0; parts && p < parts->second; ++p) {
            consider(p, s, t);
          }
        }
      }
    }
  }
}

// The nearest place to a goal, of a crossing into a block and all places of that block; and if that
// is near, of all blocks that are reached.
template <class IsReached>
BlockPoint nearest_place(const NodeView& view, const BlockSquares& squares,
                         const BlockPoint& crossing, Vec3d goal, IsReached is_reached) {
  // There are too many blocks around a farther goal. [m]
  constexpr double kMaxNearestDistance = 25;
  BlockPoint best = crossing;
  double least = length(goal - position(view, best));
  const auto consider = [&](uint32_t block, double s, double t) {
    const BlockPoint at{block, s, t};
    const double far = length(goal - position(view, at));
    if (far < least) {
      least = far;
      best = at;
    }
  };
  const auto consider_nearest = [&](uint32_t block) {
    const auto [s, t] = nearest_in(view.surface(block), view.block(block), goal);
    consider(block, s, t);
  };
  consider_nearest(crossing.block);
  if (least > kMaxNearestDistance) return best;
  for_each_level_part(view, goal, least, [&](uint32_t block, double s, double t) {
    if (is_reached(block)) consider(block, s, t);
  });
  squares.for_each_near(goal, least, [&](uint32_t block) {
    if (is_reached(block)) consider_nearest(block);
  });
  return best;
}

}  // namespace

NodeFinder::NodeFinder(std::shared_ptr<const Shared> shared)
    : state_(std::move(shared)), scratch_(std::make_unique<Scratch>(*state_)) {}
NodeFinder::NodeFinder(const NodeFinder& other)
    : state_(other.state_), scratch_(std::make_unique<Scratch>(*state_, other.scratch_->changes)) {}
NodeFinder& NodeFinder::operator=(const NodeFinder& other) {
  if (this != &other) *this = NodeFinder(other);
  return *this;
}
NodeFinder::NodeFinder(NodeFinder&&) noexcept = default;
NodeFinder& NodeFinder::operator=(NodeFinder&&) noexcept = default;
NodeFinder::~NodeFinder() = default;

Result<NodeFinder> NodeFinder::create(const Nodes& nodes, const PathConfig& config,
                                      Context& context) {
  const auto start = std::chrono::steady_clock::now();
  if (data_of(nodes) == nullptr) return Error{Errc::kBadInput, "path: there are no nodes"};
  const size_t classes = data_of(data_of(nodes)->world)->summary.classes.size();
  if (config.avatar_class < 0 || static_cast<size_t>(config.avatar_class) >= classes) {
    return Error{Errc::kBadConfig, "path: the world has no avatar class " +
                                       std::to_string(config.avatar_class) + "; it has " +
                                       std::to_string(classes)};
  }
  if (!(config.slope_cost >= 0 && config.slope_cost <= 1000)) {
    return Error{Errc::kBadConfig, "path: slope_cost must be 0 to 1000"};
  }
  if (!(config.narrow_cost >= 0 && config.narrow_cost <= 1000 && config.low_cost >= 0 &&
        config.low_cost <= 1000)) {
    return Error{Errc::kBadConfig, "path: narrow_cost and low_cost must be 0 to 1000"};
  }
  if (config.workers < 0) return Error{Errc::kBadConfig, "path: workers must be 0 or more"};
  if (auto ok = refuse_settings(config, "path", true); !ok) return ok.error();
  auto mesh = graph::NodeMesh::create(nodes, config.avatar_class, config.workers, context);
  if (!mesh) return mesh.error();
  auto shared = std::make_shared<Shared>(std::move(*mesh), config);
  shared->seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return NodeFinder(std::move(shared));
}

PathSummary NodeFinder::summary() const {
  const graph::NodeMesh& mesh = state_->mesh;
  return {.blocks = mesh.blocks().size(),
          .crossings = mesh.portals().size(),
          .bytes = mesh.bytes() + state_->squares.bytes() + state_->parts.bytes() +
                   state_->overlay.bytes() + state_->added.size() * sizeof(double),
          .seconds = state_->seconds};
}

std::optional<NodeSquare> NodeFinder::square(uint32_t node, double from_s, double from_t,
                                             double to_s, double to_t) const {
  const graph::NodeMesh& mesh = state_->mesh;
  THRONG_ASSERT(node < mesh.nodes().node_count());
  const auto square_of = [&](const graph::NodeBlock& b) {
    const double side = b.side();
    return NodeSquare{b.s * side, b.t * side, (b.s + 1) * side, (b.t + 1) * side};
  };
  const uint32_t found =
      block_around(mesh, node, from_s, from_t, [&](const graph::NodeBlock& block) {
        constexpr double kRounded = 1e-12;
        const NodeSquare square = square_of(block);
        const auto holds = [&](double s, double t) {
          return s >= square.s0 - kRounded && s <= square.s1 + kRounded &&
                 t >= square.t0 - kRounded && t <= square.t1 + kRounded;
        };
        return holds(from_s, from_t) && holds(to_s, to_t);
      });
  if (found == graph::kNoNode) return std::nullopt;
  return square_of(mesh.blocks()[found]);
}

NodePlace NodeFinder::find_place(Vec3d position, double search_radius) const {
  const graph::NodeMesh& mesh = state_->mesh;
  if (!std::isfinite(position.x + position.y + position.z) || !(search_radius >= 0)) return {};
  scratch_->update();
  const NodeChanges& changes = scratch_->changes;
  const NodeView& view = scratch_->view;
  double nearest = search_radius;
  uint64_t best_rank = 0;  // Of places as near as each other it is the first: level ground, then
                           // blocks in their order.
  NodePlace best;
  const auto consider = [&](uint32_t block, double s, double t, uint64_t rank) {
    const NodePlace place = mesh.nodes().place(mesh.avatar_class(), view.block(block).node, s, t);
    if (!place) return;
    const double far = length(place.feet - position);
    if (far > nearest || (best && far == nearest && rank > best_rank)) return;
    nearest = far;
    best_rank = rank;
    best = place;
  };
  const auto consider_curved = [&](uint32_t block) {
    const auto [s, t] = nearest_in(mesh.surface(block), view.block(block), position);
    consider(block, s, t, uint64_t{block} + 1);
  };
  const World& world = data_of(mesh.nodes())->world;
  uint32_t under = graph::kNoNode;  // What was found straight above or below.
  if (const Place place = world.find_place(mesh.avatar_class(), position, search_radius)) {
    if (const uint32_t patch = mesh.patch_of_level(place.level1 - 1); patch != graph::kNoNode) {
      const world::GroundPoint at =
          world::to_ground(*data_of(world), place.position.x, place.position.z);
      const auto [s, t] = in_tile(at);
      const uint32_t block = mesh.block_at(patch, s, t);
      under = block == graph::kNoNode ? graph::kNoNode : changes.part_at(block, s, t);
      if (under != graph::kNoNode) consider(under, s, t, 0);
    }
  }
  // Beside it: what lies under a wall or an obstacle, or over the edge of the floor.
  for_each_level_part(view, position, nearest, [&](uint32_t other, double u, double v) {
    if (other != under) consider(other, u, v, uint64_t{other} + 1);
  });
  state_->squares.for_each_near(position, nearest, [&](uint32_t block) {
    const auto parts = changes.parts_of(block);
    if (!parts) return consider_curved(block);
    for (uint32_t p = parts->first; p < parts->second; ++p) {
      const auto [s, t] = nearest_in(view.surface(p), view.block(p), position);
      consider(p, s, t, uint64_t{p} + 1);
    }
  });
  return best;
}

ChangeId NodeFinder::add_obstacle(Solid solid) { return scratch_->changes.add(std::move(solid)); }

Result<ChangeId> NodeFinder::add_area(const Prism& prism, uint8_t kind) {
  if (auto ok = check_area(kind); !ok) return ok.error();
  if (auto ok = check_prism(prism); !ok) return ok.error();
  return scratch_->changes.add_area(prism, kind);
}

Result<void> NodeFinder::set_area_cost(uint8_t kind, double cost) {
  if (auto ok = check_area_cost(kind, cost); !ok) return ok;
  scratch_->changes.set_area_cost(kind, cost);
  return {};
}

Result<ChangeId> NodeFinder::add_off_mesh_link(const OffMeshLink& link) {
  if (auto ok = check_link(link); !ok) return ok.error();
  const auto end_of = [&](const Place& place, const NodePlace& on_nodes) {
    const BlockPoint at = on_nodes ? state_->block_of(on_nodes) : state_->block_of(place);
    return NodeChanges::LinkEnd{at.block, at.s, at.t};
  };
  const NodeChanges::Link added{.from = end_of(link.from, link.from_on_nodes),
                                .to = end_of(link.to, link.to_on_nodes),
                                .cost = link.cost,
                                .two_way = link.two_way};
  if (added.from.block == graph::kNoNode || added.to.block == graph::kNoNode) {
    return Error{Errc::kBadInput, "off-mesh link: an end is no place of the class"};
  }
  return scratch_->changes.add_link(added);
}

bool NodeFinder::remove(ChangeId change) {
  return scratch_->changes.set_active(change, false, true);
}
bool NodeFinder::set_active(ChangeId change, bool active) {
  return scratch_->changes.set_active(change, active, false);
}

uint64_t NodeFinder::version() const { return scratch_->changes.version(); }

BlockPoint NodeFinder::Shared::block_of(const NodePlace& place) const {
  BlockPoint at{graph::kNoNode, place.s, place.t};
  if (!place || place.node1 > mesh.nodes().node_count()) return at;
  if (!(place.s >= 0 && place.s <= 1 && place.t >= 0 && place.t <= 1)) return at;
  at.block = mesh.block_at(mesh.patch_of_node(place.node1 - 1), place.s, place.t);
  // On the border of a cell the other cell may be meant.
  if (at.block == graph::kNoNode || mesh.blocks()[at.block].node != place.node1 - 1) {
    const uint32_t own = block_around(mesh, place.node1 - 1, place.s, place.t,
                                      [](const graph::NodeBlock&) { return true; });
    if (own != graph::kNoNode) {
      at.block = own;
      return at;
    }
    const NodeInfo info = mesh.nodes().node(place.node1 - 1);
    const double side = 1.0 / (1 << info.block_level), in = 1e-9;
    const double s = std::clamp(place.s, info.s * side + in, (info.s + 1) * side - in);
    const double t = std::clamp(place.t, info.t * side + in, (info.t + 1) * side - in);
    const uint32_t other = mesh.block_at(mesh.patch_of_node(place.node1 - 1), s, t);
    if (other != graph::kNoNode && std::fabs(s - place.s) + std::fabs(t - place.t) < 1e-6) {
      at.block = other;
    }
  }
  return at;
}

BlockPoint NodeFinder::Shared::block_of(const Place& place) const {
  const auto at = world::ground_point(*data_of(data_of(mesh.nodes())->world), place);
  const uint32_t patch = at ? mesh.patch_of_level(place.level1 - 1) : graph::kNoNode;
  if (patch == graph::kNoNode) return {};
  const auto [s, t] = in_tile(*at);
  return {mesh.block_at(patch, s, t), s, t};
}

BlockPoint NodeFinder::Scratch::locate(const NodePlace& place) const {
  BlockPoint at = shared.block_of(place);
  if (at.block != graph::kNoNode) at.block = changes.part_at(at.block, at.s, at.t);
  return at;
}

bool NodeFinder::is_free(const NodePlace& place) const {
  scratch_->update();
  return scratch_->locate(place).block != graph::kNoNode;
}

void NodeFinder::find(const NodePlace& from, const NodePlace& to, Path& path, double spacing,
                      const SearchBudget& budget) {
  begin(from, to, spacing, budget);
  Slice all;
  advance(all, path);
}

void NodeFinder::begin(const NodePlace& from, const NodePlace& to, double spacing,
                       const SearchBudget& budget) {
  THRONG_ASSERT(spacing > 0);
  Scratch& scratch = *scratch_;
  scratch.update();
  const NodeView& view = scratch.view;
  const BlockPoint start = scratch.locate(from), goal = scratch.locate(to);
  scratch.start = start;
  scratch.goal = goal;
  scratch.nearest.reset();
  scratch.goal_at = to.feet;
  scratch.spacing = spacing;
  scratch.budget = budget;
  scratch.heads_to_nearest = false;
  scratch.step = Scratch::Step::kEnded;
  scratch.end = PathEnd::kNoPlace;
  scratch.nodes = scratch.taken = 0;
  scratch.searched_cost = 0;
  scratch.crossings.clear();
  if (start.block == graph::kNoNode || goal.block == graph::kNoNode) return;
  // Parts and the overlay do not know links.
  if (view.has_links()) {
    scratch.reachable = true;
    return scratch.begin_step(Scratch::Step::kAll);
  }
  const NodeParts& parts = state_->parts;
  parts.reach(view.base_of(start.block), scratch.reached);
  scratch.reachable = scratch.reached.holds(parts.of_block(view.base_of(goal.block)));
  if (view.is_as_baked()) {
    if (!scratch.reachable) {
      const BlockPoint crossing =
          parts.nearest(view, start, to.feet, scratch.reached, [](uint32_t) { return false; });
      scratch.nearest = nearest_place(
          view, state_->squares, crossing, to.feet,
          [&](uint32_t block) { return scratch.reached.holds(parts.of_block(block)); });
    }
    return scratch.begin_search();
  }
  // If no obstacle blocks, parts decide what is reachable.
  scratch.islands.clear(view);
  scratch.reachable = scratch.reachable && !scratch.islands.close(view, goal.block, start.block,
                                                                  NodeIsland::Direction::kIn);
  if (scratch.reachable) return scratch.begin_search();
  scratch.head_to_nearest();
}

bool NodeFinder::advance(Slice& slice, Path& path) {
  Scratch& scratch = *scratch_;
  const uint64_t before = slice.left;
  reset(path);
  if (!scratch.advance(slice)) {
    scratch.taken += before - slice.left;
    path.nodes = scratch.taken;
    path.end = PathEnd::kBudgetExhausted;
    path.spent = SpentBudget::kNodes;
    return false;
  }
  give(path);
  return true;
}

void NodeFinder::give(Path& path) {
  Scratch& scratch = *scratch_;
  const NodeView& view = scratch.view;
  path.end = scratch.end;
  path.nodes = scratch.nodes;
  path.searched_cost = scratch.searched_cost;
  if (path.end == PathEnd::kNoPlace) return;
  if (path.end == PathEnd::kBudgetExhausted) {
    path.spent = scratch.budget.spent(path.nodes);
    return;
  }
  BlockPoint last = scratch.goal;
  if (!scratch.reachable || path.end != PathEnd::kReached) {
    last = scratch.crossings.empty() ? scratch.start : ends_of(view, scratch.crossings.back()).in;
    last = scratch.nearest.value_or(nearest_place(view, state_->squares, last, scratch.goal_at,
                                                  [](uint32_t) { return false; }));
    path.end = PathEnd::kUnreachable;
    set_blocker(blocker_towards(view, last, scratch.goal_at), path);
  }
  scratch.pull.pull(scratch.start, last, scratch.crossings, scratch.pulled);
  PathBuilder path_builder(view, scratch.cost, scratch.spacing, path);
  path_builder.begin(scratch.start);
  for (const PulledCrossing& crossing : scratch.pulled) {
    path_builder.go_on(crossing.out);
    path_builder.cross(crossing);
  }
  path_builder.go_on(last);
  path_builder.end();
}

}  // namespace throng::path
