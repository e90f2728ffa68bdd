// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "graph/node_mesh.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <tuple>

#include "core/access.h"
#include "core/parallel.h"
#include "graph/ground_parts.h"
#include "graph/patch_pairs.h"
#include "graph/tile_cells.h"
#include "world/place.h"
#include "world/tile_grid.h"

// The class's largest nodes tile all that it can stand on: of the nodes around a cell that hold its
// bit, the outermost. Inside one nothing blocks the class, so what is left to find is where two of
// them touch. Within a patch that follows from the squares (and the tile's steps), over the edges
// of Bezier patches from the doors that the bake proved, over tiles from the moves' own rule, and
// over holes from the hole links. The arcs between nodes are not read for that; a test proves that
// both agree.
namespace throng::graph {
namespace {

// Each list is given back once it is copied: of a large world all of them take gigabytes.
template <class T>
void append_all(std::vector<std::vector<T>>& lists, std::vector<T>& all) {
  size_t count = all.size();
  for (const auto& list : lists) count += list.size();
  all.reserve(count);
  for (auto& list : lists) {
    all.insert(all.end(), list.begin(), list.end());
    std::vector<T>().swap(list);
  }
}

}  // namespace

double portal_length(const NodePortal& portal, Vec3d out, Vec3d in) {
  const Vec3d hop = in - out;
  if (portal.kind != LinkKind::kDrop) return length(hop);
  return std::sqrt(hop.x * hop.x + hop.z * hop.z) + std::fabs(hop.y);
}

Result<NodeMesh> NodeMesh::create(const Nodes& nodes, int32_t avatar_class, int32_t workers,
                                  Context& context) {
  if (auto ok = nodes.check_all(); !ok) return ok.error();
  NodeMesh mesh(nodes, avatar_class);
  const NodeData& data = *data_of(nodes);
  double steepest = 0;
  for (const AvatarClass& avatar : data_of(data.world)->summary.classes) {
    steepest = std::max(steepest, avatar.max_slope);
  }
  mesh.walking_ = data.summary.bins.inclination_code(steepest);
  mesh.list_blocks(workers);
  std::vector<PortalList> lists(mesh.patches_.size());
  parallel_for(lists.size(), workers, [&](size_t p) {
    if (!context.cancel) lists[p] = mesh.inside_patch(static_cast<uint32_t>(p));
  });
  mesh.portals_.add_all(lists);
  mesh.open_doors();
  const world::WorldData& world = *data_of(data.world);
  const bool tiles = std::any_of(mesh.patches_.begin(), mesh.patches_.end(),
                                 [](const NodeSurface& p) { return p.points == nullptr; });
  const int32_t tiles_x = world.summary.tiles_x, tiles_z = world.summary.tiles_z;
  lists.assign(tiles ? static_cast<size_t>(tiles_x) * static_cast<size_t>(tiles_z) : 0, {});
  parallel_for(lists.size(), workers, [&](size_t i) {
    const auto tile = static_cast<int32_t>(i);
    if (!context.cancel) lists[i] = mesh.over_tile(tile % tiles_x, tile / tiles_x);
  });
  mesh.portals_.add_all(lists);
  mesh.add_hole_links();
  if (context.cancel) return Error{Errc::kCancelled, "path: cancelled"};
  mesh.index_portals();
  return mesh;
}

namespace {

// The squares of one patch for a class, in the order of its quadtree.
class BlockCutter {
 public:
  BlockCutter(const NodeData& data, const NodeZone& zone, const format::NodePatch& patch,
              const NodeSurface& surface, uint32_t first_node, uint32_t place, int32_t avatar_class)
      : data_(data),
        zone_(zone),
        patch_(patch),
        surface_(surface),
        first_node_(first_node),
        place_(place),
        class_(avatar_class) {}

  std::vector<NodeBlock> cut() {
    const uint32_t end = patch_.first_node() + patch_.nodes();
    for (uint32_t n = patch_.first_node(); n < end; ++n) {
      const format::Node& node = zone_.nodes()[n];
      if (is_partial(node)) {
        n = cut_partial(n, end) - 1;
        continue;
      }
      const bool inside = node.parent() != UINT32_MAX && stands(zone_.nodes()[node.parent()]);
      if (stands(node) && !inside) cut_block(block_of_node(n));
    }
    return std::move(blocks_);
  }

 private:
  static bool is_partial(const format::Node& node) { return (node.flags() & kPartialFlag) != 0; }

  [[nodiscard]] bool stands(const format::Node& node) const {
    return (node.classes() >> class_ & 1) != 0;
  }

  [[nodiscard]] NodeBlock block_of_node(uint32_t n) const {
    const format::Node& node = zone_.nodes()[n];
    return {.patch = place_,
            .node = first_node_ + n,
            .level = node.level(),
            .s = node.s(),
            .t = node.t(),
            .inclination = static_cast<uint8_t>(node.surface() >> 4)};
  }

  // Quarters, quarters of quarters ... until a block is small enough. Its diagonals measure it,
  // flat or curved: a patch that comes back to where it began is cut by its depth.
  void cut_block(NodeBlock block) {
    if (block.level >= surface_.depth) {
      blocks_.push_back(block);
      return;
    }
    const double side = block.side(), s = block.s * side, t = block.t * side;
    const Vec3d middle = surface_.at(s + side / 2, t + side / 2);
    double longest = 0;
    for (const auto& [i, j] : {std::pair{0, 0}, {1, 0}, {0, 1}, {1, 1}}) {
      const double inset = surface_.points == nullptr ? kTileInset : 0;
      longest = std::max(
          longest, length(surface_.at(s + i * (side - inset), t + j * (side - inset)) - middle));
    }
    if (longest <= kLargestBlock * 0.7072) {
      blocks_.push_back(block);
      return;
    }
    for (uint8_t q = 0; q < 4; ++q) cut_block(quarter(block, q));
  }

  static NodeBlock quarter(NodeBlock block, uint8_t q) {
    ++block.level;
    block.s = static_cast<uint8_t>(2 * block.s + q % 2);
    block.t = static_cast<uint8_t>(2 * block.t + q / 2);
    return block;
  }

  // All partial nodes of one block, which follow each other from `first` on. Returns where they
  // end.
  uint32_t cut_partial(uint32_t first, uint32_t end) {
    const format::Node& node = zone_.nodes()[first];
    pieces_.clear();
    uint32_t n = first;
    for (; n < end; ++n) {
      const format::Node& other = zone_.nodes()[n];
      if (!is_partial(other) || other.s() != node.s() || other.t() != node.t()) break;
      if (!stands(other)) continue;
      const uint64_t cells = zone_.cells_of(n) & legal_in(node.s(), node.t());
      if (cells != 0) pieces_.push_back({cells, n});
    }
    if (!pieces_.empty()) cut_square(block_of_node(first));
    return n;
  }

  // A square of cells, if all of them are of one piece and no step in it is too high; or quarters.
  void cut_square(const NodeBlock& square) {
    const int32_t side = kTileCells >> square.level;
    const int32_t s = square.s * side & 7, t = square.t * side & 7;
    const uint64_t row = (uint64_t{1} << side) - 1;
    uint64_t all = 0, inner_s = 0, inner_t = 0;
    for (int32_t j = 0; j < side; ++j) {
      all |= row << (8 * (t + j) + s);
      inner_s |= (row >> 1) << (8 * (t + j) + s);
      if (j + 1 < side) inner_t |= row << (8 * (t + j) + s);
    }
    uint64_t some = 0;
    for (const Piece& piece : pieces_) {
      some |= piece.cells & all;
      if ((all & ~piece.cells) != 0) continue;
      if ((cuts_in(square, true) & inner_s) != 0 || (cuts_in(square, false) & inner_t) != 0) break;
      NodeBlock block = block_of_node(piece.node);
      block.level = square.level;
      block.s = square.s;
      block.t = square.t;
      cut_block(block);
      return;
    }
    if (some == 0) return;
    for (uint8_t q = 0; q < 4; ++q) cut_square(quarter(square, q));
  }

  void read_ground() {
    if (ground_) return;
    ground_ = world::ground_level(*data_of(data_.world), surface_.source, class_);
    const auto& avatar = data_of(data_.world)->summary.classes[static_cast<size_t>(class_)];
    cuts_ = step_cuts(*ground_, legal_rows(*ground_), world::step_mm(avatar));
  }

  [[nodiscard]] uint64_t legal_in(uint32_t s, uint32_t t) {
    read_ground();
    return ground_->legal_in(t * 8 + s);
  }

  // Steps from cells of the 8 x 8 around a square that are too high, along s or along t.
  [[nodiscard]] uint64_t cuts_in(const NodeBlock& square, bool along_s) {
    if (!cuts_) return 0;
    const world::CellRows& rows = along_s ? cuts_->across : cuts_->along;
    const size_t s0 = size_t{square.s} * (kTileCells >> square.level) & ~size_t{7};
    const size_t t0 = size_t{square.t} * (kTileCells >> square.level) & ~size_t{7};
    uint64_t cells = 0;
    for (size_t j = 0; j < 8; ++j) cells |= (rows[t0 + j] >> s0 & 0xff) << (8 * j);
    return cells;
  }

  const NodeData& data_;
  const NodeZone& zone_;
  const format::NodePatch& patch_;
  const NodeSurface& surface_;
  uint32_t first_node_;  // of the zone, of all
  uint32_t place_;       // of the patch in the mesh
  int32_t class_;
  struct Piece {
    uint64_t cells = 0;
    uint32_t node = 0;
  };

  std::vector<Piece> pieces_;  // of the class, of the partial nodes of one block
  std::optional<world::GroundLevel> ground_;
  std::optional<StepCuts> cuts_;
  std::vector<NodeBlock> blocks_;
};

}  // namespace

void NodeMesh::list_blocks(int32_t workers) {
  const NodeData& data = *data_of(nodes_);
  of_level_.assign(data_of(data.world)->level_count, kNoNode);
  struct Source {
    const NodeZone* zone;
    const format::NodePatch* patch;
    uint32_t first;
  };
  std::vector<Source> sources;
  for (size_t s = 0; s < data.slots.size(); ++s) {
    const NodeZone& zone = *data.zone(s);
    const uint32_t first = data.slots[s]->first_node;
    for (const format::NodePatch& patch : zone.patches()) {
      const auto p = static_cast<uint32_t>(patches_.size());
      patches_.push_back(surface_of(data, zone, patch));
      first_node_.push_back(first + patch.first_node());
      if (patches_[p].points == nullptr) of_level_[patches_[p].source] = p;
      sources.push_back({&zone, &patch, first});
    }
  }
  std::vector<std::vector<NodeBlock>> lists(sources.size());
  parallel_for(lists.size(), workers, [&](size_t p) {
    const Source& source = sources[p];
    lists[p] = BlockCutter(data, *source.zone, *source.patch, patches_[p], source.first,
                           static_cast<uint32_t>(p), avatar_class_)
                   .cut();
  });
  first_block_ = {0};
  for (const auto& list : lists) {
    first_block_.push_back(first_block_.back() + static_cast<uint32_t>(list.size()));
  }
  append_all(lists, blocks_);
}

uint32_t NodeMesh::block_at(uint32_t patch, double s, double t) const {
  const uint8_t depth = patches_[patch].depth;
  const auto cell = [&](double at) {
    return static_cast<uint32_t>(std::clamp(at * (1 << depth), 0.0, (1 << depth) - 1.0));
  };
  const uint32_t cs = cell(s), ct = cell(t), order = quad_order(cs, ct, depth);
  const auto begin = blocks_.begin() + first_block_[patch];
  const auto end = blocks_.begin() + first_block_[patch + 1];
  const auto after = std::upper_bound(begin, end, order, [&](uint32_t at, const NodeBlock& b) {
    return at < quad_order(b.s, b.t, b.level) << (2 * (depth - b.level));
  });
  if (after == begin) return kNoNode;
  const NodeBlock& found = *(after - 1);
  const int32_t up = depth - found.level;
  if (cs >> up != found.s || ct >> up != found.t) return kNoNode;
  return static_cast<uint32_t>(after - 1 - blocks_.begin());
}

uint32_t NodeMesh::patch_of_level(uint32_t level) const {
  return level < of_level_.size() ? of_level_[level] : kNoNode;
}

uint32_t NodeMesh::patch_of_node(uint32_t node) const {
  // Patches without nodes begin where the next one does.
  const auto after = std::upper_bound(first_node_.begin(), first_node_.end(), node);
  return static_cast<uint32_t>(after - first_node_.begin()) - 1;
}

LinkKind NodeMesh::kind_between(uint32_t a, uint32_t b) const {
  return std::max(blocks_[a].inclination, blocks_[b].inclination) > walking_ ? LinkKind::kClimb
                                                                             : LinkKind::kWalk;
}

// Cells beside each other of different blocks, runs of them together.
PortalList NodeMesh::inside_patch(uint32_t patch) const {
  std::vector<NodePortal> found;
  const uint32_t first = first_block_[patch], last = first_block_[patch + 1];
  if (last - first < 2) return {};
  const NodeSurface& surface = patches_[patch];
  const int32_t side = 1 << surface.depth;
  const auto index = [&](int32_t s, int32_t t) {
    return (static_cast<size_t>(t) << surface.depth) + static_cast<size_t>(s);
  };
  std::vector<uint32_t> owner(static_cast<size_t>(side) * static_cast<size_t>(side), kNoNode);
  for (uint32_t b = first; b < last; ++b) {
    const int32_t size = side >> blocks_[b].level;
    for (int32_t t = blocks_[b].t * size; t < (blocks_[b].t + 1) * size; ++t) {
      for (int32_t s = blocks_[b].s * size; s < (blocks_[b].s + 1) * size; ++s) {
        owner[index(s, t)] = b;
      }
    }
  }
  PatchCells cells;  // only of tiles are cells cut
  const bool tile = surface.points == nullptr;
  if (tile) {
    cells = tile_cells(data_of(nodes_)->world, surface.source, UINT16_MAX,
                       data_of(nodes_)->summary.bins);
  }
  const double unit = 1.0 / side, inset = tile ? kTileInset : 0;
  // Along `t` if the cells lie beside each other along s.
  const auto visit = [&](bool by_s, const std::vector<uint16_t>& cuts) {
    for (int32_t i = 0; i + 1 < side; ++i) {
      uint32_t last_a = kNoNode, last_b = kNoNode;
      LinkKind last_kind = LinkKind::kWalk;
      for (int32_t k = 0; k < side; ++k) {
        const size_t here = by_s ? index(i, k) : index(k, i);
        const uint32_t a = owner[here], b = owner[by_s ? index(i + 1, k) : index(k, i + 1)];
        const uint16_t cut = cuts.empty() ? uint16_t{0} : cuts[here];
        if (a == b || a == kNoNode || b == kNoNode || (cut >> avatar_class_ & 1) != 0) {
          last_a = last_b = kNoNode;
          continue;
        }
        LinkKind kind = kind_between(a, b);
        if (kind == LinkKind::kWalk && cells.steps(here, by_s)) kind = LinkKind::kStep;
        const double to = (k + 1) * unit - inset;
        if (a == last_a && b == last_b && kind == last_kind) {
          NodePortal& portal = found.back();
          (by_s ? portal.on_a[3] : portal.on_a[2]) = to;
          (by_s ? portal.on_b[3] : portal.on_b[2]) = to;
          continue;
        }
        const double from = k * unit + inset, at = (i + 1) * unit;
        NodePortal portal{.a = a, .b = b, .on_a = {}, .on_b = {}, .kind = kind};
        // (The line itself is of the further cell; both blocks hold it.)
        if (by_s) {
          portal.on_a = portal.on_b = {at, from, at, to};
        } else {
          portal.on_a = portal.on_b = {from, at, to, at};
        }
        portal.inside = blocks_[a].node == blocks_[b].node;
        found.push_back(portal);
        last_a = a;
        last_b = b;
        last_kind = kind;
      }
    }
  };
  visit(true, cells.cut_s);
  visit(false, cells.cut_t);
  return PortalList(found);
}

// A door is cut where the blocks on either side end.
void NodeMesh::open_doors() {
  const NodeData& data = *data_of(nodes_);
  uint32_t first_patch = 0;
  for (size_t s = 0; s < data.slots.size(); ++s) {
    const NodeZone& zone = *data.zone(s);
    for (const format::Door& door : zone.doors()) {
      if ((door.classes() >> avatar_class_ & 1) == 0) continue;
      const uint32_t a_patch = first_patch + door.patch();
      const uint32_t b_patch = patch_of_node(data.target(s, zone, door.to()));
      if (patches_[b_patch].points == nullptr) continue;  // A file of another world may say so.
      const double scale =
          static_cast<double>(door.to_last() - door.to_first()) / (door.last() - door.first());
      const auto on_a = [&](double at) { return edge_parameters(door.edge(), at / kEdgeUnits); };
      const auto on_b = [&](double at) {
        return edge_parameters(door.to_edge(),
                               (door.to_first() + (at - door.first()) * scale) / kEdgeUnits);
      };
      NodePortal open{.a = kNoNode, .b = kNoNode, .on_a = {}, .on_b = {}};
      const auto close = [&] {
        if (open.a != kNoNode) portals_.add(open);
        open.a = open.b = kNoNode;
      };
      for (int32_t k = door.first(); k < door.last(); ++k) {
        const auto in_a = on_a(k + 0.5), in_b = on_b(k + 0.5);
        const uint32_t a = block_at(a_patch, in_a[0], in_a[1]);
        const uint32_t b = block_at(b_patch, in_b[0], in_b[1]);
        if (a == kNoNode || b == kNoNode) {
          close();
          continue;
        }
        const auto end_a = on_a(k + 1), end_b = on_b(k + 1);
        if (a != open.a || b != open.b) {
          close();
          const auto from_a = on_a(k), from_b = on_b(k);
          open.a = a;
          open.b = b;
          open.on_a = {from_a[0], from_a[1], 0, 0};
          open.on_b = {from_b[0], from_b[1], 0, 0};
          open.kind = kind_between(a, b);
        }
        open.on_a[2] = end_a[0];
        open.on_a[3] = end_a[1];
        open.on_b[2] = end_b[0];
        open.on_b[3] = end_b[1];
      }
      close();
    }
    first_patch += static_cast<uint32_t>(zone.patches().size());
  }
}

// Borders and seams of the levels of a tile, towards greater x and z.
PortalList NodeMesh::over_tile(int32_t tile_x, int32_t tile_z) const {
  struct Touch {
    uint32_t a, b;
    uint8_t side;   // 2: the cells lie beside each other along s, 1: along t
    int32_t at, k;  // the border on a's patch, and the cell along it, in cells
    LinkKind kind;
  };
  std::vector<Touch> touches;
  for (const CellPair& pair : tile_pairs(*data_of(data_of(nodes_)->world), tile_x, tile_z)) {
    if ((pair.classes >> avatar_class_ & 1) == 0) continue;
    const uint32_t pa = patch_of_level(pair.patch_a), pb = patch_of_level(pair.patch_b);
    if (pa == kNoNode || pb == kNoNode) continue;
    const auto middle = [](uint32_t cell) {
      return std::pair{(world::x_of_cell(cell) + 0.5) / kTileCells,
                       (world::z_of_cell(cell) + 0.5) / kTileCells};
    };
    const auto [as, at] = middle(pair.cell_a);
    const auto [bs, bt] = middle(pair.cell_b);
    const uint32_t a = block_at(pa, as, at), b = block_at(pb, bs, bt);
    if (a == kNoNode || b == kNoNode) continue;
    const auto s = world::x_of_cell(pair.cell_a), t = world::z_of_cell(pair.cell_a);
    const bool by_s = pair.side_a == 2;
    const LinkKind kind = std::max(kind_between(a, b), pair.kind);  // climbs before steps
    touches.push_back({a, b, pair.side_a, (by_s ? s : t) + 1, by_s ? t : s, kind});
  }
  std::sort(touches.begin(), touches.end(), [](const Touch& p, const Touch& q) {
    return std::tie(p.a, p.b, p.side, p.at, p.k) < std::tie(q.a, q.b, q.side, q.at, q.k);
  });
  PortalList found;
  for (size_t i = 0; i < touches.size();) {
    const Touch& t = touches[i];
    size_t j = i + 1;
    while (j < touches.size() && touches[j].a == t.a && touches[j].b == t.b &&
           touches[j].side == t.side && touches[j].at == t.at && touches[j].kind == t.kind &&
           touches[j].k == touches[j - 1].k + 1) {
      ++j;
    }
    constexpr double kSide = kTileCells;
    const double from = t.k / kSide + kTileInset, to = (touches[j - 1].k + 1) / kSide - kTileInset;
    const double on_a = t.at / kSide - kTileInset, on_b = t.at % kTileCells / kSide;
    NodePortal portal{.a = t.a, .b = t.b, .on_a = {}, .on_b = {}, .kind = t.kind};
    if (t.side == 2) {
      portal.on_a = {on_a, from, on_a, to};
      portal.on_b = {on_b, from, on_b, to};
    } else {
      portal.on_a = {from, on_a, to, on_a};
      portal.on_b = {from, on_b, to, on_b};
    }
    found.add(portal);
    i = j;
  }
  return found;
}

// Each direction has an arc of its own. A node around another may have the same hole link.
void NodeMesh::add_hole_links() {
  const NodeData& data = *data_of(nodes_);
  using Key = std::tuple<uint32_t, uint32_t, uint8_t, uint8_t, uint8_t, uint8_t>;
  std::map<Key, size_t> known;
  for (size_t s = 0; s < data.slots.size(); ++s) {
    const NodeZone& zone = *data.zone(s);
    const uint32_t first = data.slots[s]->first_node;
    for (uint32_t n = 0; n < zone.nodes().size(); ++n) {
      for (const format::Arc& arc : zone.arcs(n)) {
        if ((arc.classes() >> avatar_class_ & 1) == 0) continue;
        const auto* hole_link = zone.hole_link_of(static_cast<uint32_t>(&arc - zone.first_arc()));
        if (hole_link == nullptr) continue;
        const uint32_t pa = patch_of_node(first + n);
        const uint32_t pb = patch_of_node(data.target(s, zone, arc));
        const auto middle = [&](uint32_t patch, uint8_t cs, uint8_t ct) {
          const double side = 1 << patches_[patch].depth;
          return std::array{(cs + 0.5) / side, (ct + 0.5) / side};
        };
        const auto from = middle(pa, hole_link->from_s(), hole_link->from_t());
        const auto to = middle(pb, hole_link->to_s(), hole_link->to_t());
        const uint32_t a = block_at(pa, from[0], from[1]), b = block_at(pb, to[0], to[1]);
        if (a == kNoNode || b == kNoNode || a == b) continue;
        const Key key{
            a, b, hole_link->from_s(), hole_link->from_t(), hole_link->to_s(), hole_link->to_t()};
        if (!known.try_emplace(key, portals_.size()).second) continue;
        portals_.add({.a = a,
                      .b = b,
                      .on_a = {from[0], from[1], from[0], from[1]},
                      .on_b = {to[0], to[1], to[0], to[1]},
                      .kind = static_cast<LinkKind>(arc.kind()),
                      .over_hole = true,
                      .one_way = true});
      }
    }
  }
}

void NodeMesh::index_portals() {
  first_portal_.assign(blocks_.size() + 1, 0);
  for (size_t p = 0; p < portals_.size(); ++p) {
    const PortalSides sides = portals_.sides(p);
    ++first_portal_[sides.a + 1];
    ++first_portal_[sides.b + 1];
  }
  for (size_t b = 0; b < blocks_.size(); ++b) first_portal_[b + 1] += first_portal_[b];
  portal_of_.resize(first_portal_.back());
  std::vector<uint32_t> next(first_portal_.begin(), first_portal_.end() - 1);
  for (uint32_t i = 0; i < portals_.size(); ++i) {
    const PortalSides sides = portals_.sides(i);
    portal_of_[next[sides.a]++] = i;
    portal_of_[next[sides.b]++] = i;
  }
}

uint64_t NodeMesh::bytes() const {
  return patches_.size() * sizeof(NodeSurface) + blocks_.size() * sizeof(NodeBlock) +
         portals_.bytes() +
         (first_node_.size() + of_level_.size() + first_block_.size() + first_portal_.size() +
          portal_of_.size()) *
             sizeof(uint32_t);
}

}  // namespace throng::graph
