// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "bake/surface/leaf_election.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <tuple>
#include <utility>

#include "core/access.h"
#include "graph/node_surface.h"
#include "throng/surface.h"
#include "world/legal_air.h"
#include "world/take_off.h"

// From the middle of each cell of each node the classes of the node rise into the air, by the rule
// of all take-offs. The leaf in which they come into legal voxels has the node as a candidate. Of
// its candidates each leaf elects the most accessible, then the one nearest to its axis; classes
// that cannot use it elect among the others. Source: [PACS00] 1.2.3.7.
namespace throng::bake {
namespace {

constexpr uint32_t kNoNode = UINT32_MAX;

// A place from which some classes of a node rise into a leaf.
struct Candidate {
  ElectedLink link;
  uint8_t height = 0, width = 0;  // codes of the node
  double off_axis = 0;            // squared [voxels]

  [[nodiscard]] auto key() const { return std::tuple(link.leaf, link.classes); }
  // Lower is better, whatever the classes.
  [[nodiscard]] auto order() const {
    return std::tuple(-int32_t{height}, -int32_t{width}, off_axis, link.slot, link.node, link.t,
                      link.s);
  }
};

// Only the best of each leaf and set of classes is left, sorted by these.
void keep_best(std::vector<Candidate>& found, size_t from) {
  const auto first = found.begin() + static_cast<std::ptrdiff_t>(from);
  std::sort(first, found.end(), [](const Candidate& a, const Candidate& b) {
    return a.key() != b.key() ? a.key() < b.key() : a.order() < b.order();
  });
  found.erase(
      std::unique(first, found.end(),
                  [](const Candidate& a, const Candidate& b) { return a.key() == b.key(); }),
      found.end());
}

// The classes of one leaf, each to its best node. `found` is all of the leaf, and not empty.
void elect(std::span<const Candidate> found, std::vector<ElectedLink>& links) {
  for (uint32_t covered = 0;;) {
    const auto more = [&](const Candidate& candidate) {
      return std::popcount(candidate.link.classes & ~covered);
    };
    const auto best =
        std::min_element(found.begin(), found.end(), [&](const Candidate& a, const Candidate& b) {
          return more(a) != more(b) ? more(a) > more(b) : a.order() < b.order();
        });
    const auto classes = static_cast<uint16_t>(best->link.classes & ~covered);
    if (classes == 0) return;
    links.push_back(best->link);
    links.back().classes = classes;
    covered |= classes;
  }
}

class Election {
 public:
  Election(const graph::NodeData& nodes, int32_t zone_x, int32_t zone_z)
      : nodes_(nodes),
        world_(*data_of(nodes.world)),
        air_(*world_.air),
        cell_(air_.shape.cell * 1e-3),
        zone_x_(zone_x),
        zone_z_(zone_z) {}

  // False: the air cannot be used.
  bool find_air() {
    const world::AirData::ZoneAir zone = air_.zone(zone_x_, zone_z_);
    if (!zone.usable) return false;
    tree_ = zone.tree;
    for (uint32_t left = linked_classes(world_); left != 0; left &= left - 1) {
      const auto c = static_cast<uint32_t>(std::countr_zero(left));
      const AvatarClass& avatar = world_.summary.classes[c];
      auto legal =
          world::find_legal_air(air_, world::air_body(avatar, air_.shape), zone_x_, zone_z_);
      if (!legal) return false;
      classes_.push_back({c, avatar.height / cell_, avatar.climb_slope > 0, *std::move(legal)});
    }
    return true;
  }

  void add(uint32_t slot, const graph::NodeZone& zone) {
    for (const format::NodePatch& patch : zone.patches()) {
      if (patch.nodes() == 0 || !may_lie_here(zone, patch)) continue;
      const size_t from = found_.size();
      add_patch(slot, zone, patch);
      keep_best(found_, from);
    }
  }

  ElectedLinks finish() {
    keep_best(found_, 0);
    ElectedLinks out;
    for (size_t first = 0; first < found_.size();) {
      size_t last = first;
      while (last < found_.size() && found_[last].link.leaf == found_[first].link.leaf) ++last;
      const size_t before = out.links.size();
      elect(std::span(found_).subspan(first, last - first), out.links);
      ++out.met;
      out.leaves += out.links.size() > before ? 1 : 0;
      first = last;
    }
    return out;
  }

 private:
  struct Flyer {
    uint32_t number = 0;  // of the class
    double height = 0;    // [voxels]
    bool climbs = false;
    world::LegalAir legal;
  };
  struct Cell {
    int32_t s = 0, t = 0;
    size_t index = 0;
  };

  [[nodiscard]] bool may_lie_here(const graph::NodeZone& zone,
                                  const format::NodePatch& patch) const {
    if (patch.kind() != static_cast<uint8_t>(PatchKind::kBezier)) {
      return zone.x() == zone_x_ && zone.z() == zone_z_;
    }
    const double side = air_.zone_side * cell_;
    const double corner[2] = {world_.summary.origin.x + zone_x_ * side,
                              world_.summary.origin.z + zone_z_ * side};
    const double* points = zone.points(patch);
    for (int a = 0; a < 2; ++a) {
      double low = HUGE_VAL, high = -HUGE_VAL;
      for (int i = 0; i < 16; ++i) {
        low = std::min(low, points[3 * i + 2 * a]);
        high = std::max(high, points[3 * i + 2 * a]);
      }
      if (low > corner[a] + side || high < corner[a]) return false;
    }
    return true;
  }

  // For each class the innermost node around each cell that holds it: it promises the most.
  void paint(const graph::NodeZone& zone, const format::NodePatch& patch) {
    const int32_t side = 1 << patch.depth();
    const bool bezier = patch.kind() == static_cast<uint8_t>(PatchKind::kBezier);
    cells_ = static_cast<size_t>(side) * static_cast<size_t>(side);
    owner_.assign(classes_.size() * cells_, kNoNode);
    for (uint32_t n = patch.first_node(); n < patch.first_node() + patch.nodes(); ++n) {
      const format::Node& node = zone.nodes()[n];
      for (size_t k = 0; k < classes_.size(); ++k) {
        const auto number = static_cast<int32_t>(classes_[k].number);
        // A climber would have to straighten up from a patch's normal.
        if ((node.classes() >> number & 1) == 0 || (bezier && classes_[k].climbs)) continue;
        uint32_t* owner = owner_.data() + k * cells_;
        if ((node.flags() & graph::kPartialFlag) != 0) {
          for (uint64_t left = nodes_.cells_of(zone, n, number); left != 0; left &= left - 1) {
            const int32_t bit = std::countr_zero(left);
            owner[(node.t() * 8 + bit / 8) * side + node.s() * 8 + bit % 8] = n;
          }
          continue;
        }
        const int32_t across = side >> node.level();
        for (int32_t t = node.t() * across; t < (node.t() + 1) * across; ++t) {
          std::fill_n(owner + t * side + node.s() * across, across, n);
        }
      }
    }
  }

  void add_patch(uint32_t slot, const graph::NodeZone& zone, const format::NodePatch& patch) {
    paint(zone, patch);
    const graph::NodeSurface surface = graph::surface_of(nodes_, zone, patch);
    if (!surface.is_there()) return;
    const int32_t side = 1 << patch.depth();
    for (Cell cell; cell.index < cells_; ++cell.index) {
      bool any = false;
      for (size_t k = 0; k < classes_.size(); ++k) {
        any = any || owner_[k * cells_ + cell.index] != kNoNode;
      }
      if (!any) continue;
      cell.s = static_cast<int32_t>(cell.index) % side;
      cell.t = static_cast<int32_t>(cell.index) / side;
      add_cell(slot, zone, cell, surface.at((cell.s + 0.5) / side, (cell.t + 0.5) / side));
    }
  }

  void add_cell(uint32_t slot, const graph::NodeZone& zone, const Cell& cell, Vec3d at) {
    const double feet = (at.y * 1000 - air_.shape.origin_y) / air_.shape.cell;
    const double x = (at.x - world_.summary.origin.x) / cell_ - zone_x_ * air_.zone_side;
    const double z = (at.z - world_.summary.origin.z) / cell_ - zone_z_ * air_.zone_side;
    if (!(x >= 0 && z >= 0 && x < air_.zone_side && z < air_.zone_side)) return;
    const size_t from = found_.size();
    for (size_t k = 0; k < classes_.size(); ++k) {
      const uint32_t node = owner_[k * cells_ + cell.index];
      if (node == kNoNode) continue;
      const auto over =
          leaf_over(classes_[k], static_cast<int32_t>(x), static_cast<int32_t>(z), feet);
      if (!over) continue;
      const auto classes = static_cast<uint16_t>(1u << classes_[k].number);
      const auto same =
          std::find_if(found_.begin() + static_cast<std::ptrdiff_t>(from), found_.end(),
                       [&](const Candidate& other) {
                         return other.link.leaf == over->leaf && other.link.node == node;
                       });
      if (same != found_.end()) {
        same->link.classes |= classes;
        continue;
      }
      const format::Node& of = zone.nodes()[node];
      found_.push_back({.link = {.leaf = over->leaf,
                                 .slot = slot,
                                 .node = node,
                                 .classes = classes,
                                 .s = static_cast<uint8_t>(cell.s),
                                 .t = static_cast<uint8_t>(cell.t)},
                        .height = static_cast<uint8_t>(of.surface() & 15),
                        .width = static_cast<uint8_t>(of.room() & 15),
                        .off_axis = off_axis(x, z, over->cube)});
    }
  }

  // The leaf into which a class rises from feet in a voxel's column; none if it cannot.
  [[nodiscard]] std::optional<world::AirLeafPlace> leaf_over(const Flyer& flyer, int32_t x,
                                                             int32_t z, double feet) const {
    const world::LegalAir& legal = flyer.legal;
    const auto up = world::take_off_height(feet, feet + flyer.height, [&](double y) {
      const double row = y - legal.base;
      return row >= 0 && row < legal.rows.height &&
             legal.rows.is_free(x + legal.pad, static_cast<int32_t>(row), z + legal.pad);
    });
    if (!up) return std::nullopt;
    return world::air_leaf_at(tree_, x, static_cast<int32_t>(std::floor(*up)), z);
  }

  // Squared, from the vertical axis of a leaf's cube. [voxels]
  [[nodiscard]] double off_axis(double x, double z, const world::AirCube& cube) const {
    const int32_t side = cube.side == 0 ? air_.zone_side : cube.side;
    const double dx = x - (cube.x + side * 0.5), dz = z - (cube.z + side * 0.5);
    return dx * dx + dz * dz;
  }

  const graph::NodeData& nodes_;
  const world::WorldData& world_;
  const world::AirData& air_;
  double cell_;  // of the air [m]
  int32_t zone_x_, zone_z_;
  const world::AirTree* tree_ = nullptr;
  std::vector<Flyer> classes_;
  std::vector<uint32_t> owner_;  // by class, then cell of a patch
  size_t cells_ = 0;             // of the patch
  std::vector<Candidate> found_;
};

}  // namespace

uint16_t linked_classes(const world::WorldData& world) {
  const uint32_t all = (1u << world.summary.classes.size()) - 1;
  const uint32_t flying = world.air->shape.flies & all;
  return static_cast<uint16_t>(flying != 0 ? flying : all);
}

ZoneRect zones_under(const graph::NodeData& nodes, const graph::NodeZone& zone) {
  const world::WorldData& world = *data_of(nodes.world);
  const double side = world.summary.cell * kTileCells * world.tiles_per_zone;
  ZoneRect rect{zone.x(), zone.z(), zone.x(), zone.z()};
  const auto along = [&](double at, double origin, int32_t zones) {
    return static_cast<int32_t>(std::clamp(std::floor((at - origin) / side), 0.0, zones - 1.0));
  };
  for (const format::NodePatch& patch : zone.patches()) {
    if (patch.nodes() == 0 || patch.kind() != static_cast<uint8_t>(PatchKind::kBezier)) continue;
    const double* points = zone.points(patch);
    for (int i = 0; i < 16; ++i) {
      const int32_t x = along(points[3 * i], world.summary.origin.x, world.zones_x);
      const int32_t z = along(points[3 * i + 2], world.summary.origin.z, world.zones_z);
      rect.x0 = std::min(rect.x0, x);
      rect.x1 = std::max(rect.x1, x);
      rect.z0 = std::min(rect.z0, z);
      rect.z1 = std::max(rect.z1, z);
    }
  }
  return rect;
}

std::optional<ElectedLinks> elect_links(const graph::NodeData& nodes,
                                        std::span<const uint32_t> slots, int32_t zone_x,
                                        int32_t zone_z) {
  Election election(nodes, zone_x, zone_z);
  if (!election.find_air()) return std::nullopt;
  for (const uint32_t slot : slots) {
    const graph::NodeZone* zone = nodes.zone(slot);
    if (zone == nullptr) return std::nullopt;
    election.add(slot, *zone);
  }
  return election.finish();
}

}  // namespace throng::bake
