// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "graph/node_data.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <tuple>

#include "core/access.h"
#include "core/hash.h"
#include "world/ground.h"
#include "world/region_data.h"

// Reads and checks files of nodes, and looks up nodes, arcs and hole links in them.
namespace throng::graph {
namespace {

constexpr const char* kNodeZoneIdentifier = "THNZ";
constexpr const char* kNodeIndexIdentifier = "THNI";
constexpr double kMaxLength = 1e9;  // [m]

constexpr const char* kRemedy = "bake the world again with --nodes";

Error bad_nodes(const std::string& name, const std::string& what) {
  return world::bad_file(name, what, kRemedy);
}

bool ascending(const flatbuffers::Vector<double>& edges, double low, double high) {
  if (edges.size() > 15) return false;
  double last = low;
  for (const double edge : edges) {
    if (!(edge >= last && edge <= high)) return false;
    last = edge;
  }
  return true;
}

}  // namespace

// As for zones: what is checked here need not be checked by any look-up.
Result<void> NodeZone::attach(const std::string& name) {
  flatbuffers::Verifier verifier(bytes().data(), bytes().size());
  if (bytes().size() < 8 || !verifier.VerifyBuffer<format::NodeZone>(kNodeZoneIdentifier)) {
    return bad_nodes(name, "not a file of nodes, or truncated");
  }
  root_ = flatbuffers::GetRoot<format::NodeZone>(bytes().data());
  if (root_->version() != kNodeVersion) {
    return bad_nodes(name, "node version " + std::to_string(root_->version()) +
                               ", this program reads " + std::to_string(kNodeVersion));
  }
  if (!root_->patches() || !root_->nodes() || !root_->arcs() || !root_->far() ||
      !root_->hole_links() || !root_->doors() || !root_->points() || !root_->partial() ||
      !world::is_aligned(*root_->points())) {
    return bad_nodes(name, "an array is missing");
  }
  patches_ = world::structs(*root_->patches());
  nodes_ = world::structs(*root_->nodes());
  arcs_ = world::structs(*root_->arcs());
  hole_links_ = world::structs(*root_->hole_links());
  partial_ = world::structs(*root_->partial());
  far_ = world::structs(*root_->far());
  doors_ = world::structs(*root_->doors());
  points_ = {root_->points()->data(), root_->points()->size()};
  if (const char* what = fault()) return bad_nodes(name, what);
  return {};
}

const char* NodeZone::fault() const {
  for (const double p : points_) {
    if (!(std::fabs(p) <= kMaxLength)) return "a control point makes no sense";
  }
  uint64_t next = 0, partial = 0;
  for (const format::NodePatch& patch : patches_) {
    const bool bezier = patch.kind() == static_cast<uint8_t>(PatchKind::kBezier);
    if (patch.kind() > static_cast<uint8_t>(PatchKind::kLevelTile) ||
        patch.depth() > kDeepestPatch || patch.first_node() != next ||
        (bezier && uint64_t{patch.points()} + 48 > points_.size())) {
      return "its patches make no sense";
    }
    next += patch.nodes();
    if (next > nodes_.size()) return "its patches have more nodes than there are";
    for (uint64_t n = patch.first_node(); n < next; ++n) {
      const format::Node& node = nodes_[n];
      const uint32_t blocks = uint32_t{1} << std::min<uint32_t>(node.level(), 31);
      if (node.level() > patch.depth() || node.s() >= blocks || node.t() >= blocks ||
          !(node.area() >= 0 && node.area() <= 1e12F)) {
        return "a node makes no sense";
      }
      const bool is_partial = (node.flags() & kPartialFlag) != 0;
      if (is_partial) {
        if (bezier || node.level() != kPartialLevel || patch.depth() != kDeepestPatch ||
            partial >= partial_.size() || partial_[partial].node() != n ||
            (partial_[partial].low() | partial_[partial].high()) == 0) {
          return "the cells of a partial node make no sense";
        }
        ++partial;
      }
      if (node.parent() == UINT32_MAX) continue;
      if (node.parent() < patch.first_node() || node.parent() >= n) {
        return "a node's parent is not before it";
      }
      const format::Node& parent = nodes_[node.parent()];
      const int32_t up = node.level() - parent.level();
      if (up <= 0 || (parent.flags() & kPartialFlag) != 0 || node.s() >> up != parent.s() ||
          node.t() >> up != parent.t()) {
        return "a node does not lie in its parent";
      }
    }
  }
  if (next != nodes_.size()) return "nodes without a patch";
  if (partial != partial_.size()) return "cells of nodes that are not partial";
  uint32_t last = 0;
  for (const format::Node& node : nodes_) {
    if (node.first_arc() < last || node.first_arc() > arcs_.size()) {
      return "its arcs are out of order";
    }
    last = node.first_arc();
  }
  for (const format::Arc& arc : arcs_) {
    const bool is_far = (arc.to() & kFarNode) != 0;
    const uint32_t index = arc.to() & ~kFarNode;
    if (index >= (is_far ? far_.size() : nodes_.size())) return "an arc leads nowhere";
    if (arc.kind() >= kLinkKinds) return "an arc is of no known kind";
  }
  uint64_t next_arc = 0;
  for (const format::HoleLink& hole_link : hole_links_) {
    if (hole_link.arc() < next_arc || hole_link.arc() >= arcs_.size())
      return "its hole links are out of order";
    next_arc = uint64_t{hole_link.arc()} + 1;
  }
  for (const format::Door& door : doors_) {
    const bool is_far = (door.to() & kFarNode) != 0;
    const uint32_t index = door.to() & ~kFarNode;
    if (index >= (is_far ? far_.size() : nodes_.size()) || door.patch() >= patches_.size() ||
        patches_[door.patch()].kind() != static_cast<uint8_t>(PatchKind::kBezier) ||
        door.edge() > 3 || door.to_edge() > 3 || door.first() >= door.last() ||
        door.last() > kEdgeUnits || door.to_last() >= door.to_first() ||
        door.to_first() > kEdgeUnits) {
      return "a door leads nowhere";
    }
  }
  return nullptr;
}

uint64_t NodeZone::cells_of(uint32_t node) const {
  if ((nodes_[node].flags() & kPartialFlag) == 0) return 0;
  const auto found = std::lower_bound(
      partial_.begin(), partial_.end(), node,
      [](const format::PartialCells& cells, uint32_t n) { return cells.node() < n; });
  return uint64_t{found->high()} << 32 | found->low();
}

const format::HoleLink* NodeZone::hole_link_of(uint32_t arc) const {
  const auto found = std::lower_bound(
      hole_links_.begin(), hole_links_.end(), arc,
      [](const format::HoleLink& hole_link, uint32_t a) { return hole_link.arc() < a; });
  return found != hole_links_.end() && found->arc() == arc ? &*found : nullptr;
}

std::span<const format::Arc> NodeZone::arcs(uint32_t node) const {
  const uint32_t begin = nodes_[node].first_arc();
  const size_t end = node + 1 < nodes_.size() ? nodes_[node + 1].first_arc() : arcs_.size();
  return arcs_.subspan(begin, end - begin);
}

const format::NodePatch& NodeZone::patch_of(uint32_t node) const {
  // The last that begins at or before it: patches without nodes begin where the next one does.
  const auto after =
      std::upper_bound(patches_.begin(), patches_.end(), node,
                       [](uint32_t n, const format::NodePatch& p) { return n < p.first_node(); });
  return *(after - 1);
}

const NodeZone* NodeData::zone(size_t slot) const {
  const Slot& entry = *slots[slot];
  std::call_once(entry.once, [&] {
    if (entry.zone || path.empty()) return;
    const format::NodeZoneEntry& listed = entry.entry;
    entry.open(
        {.name = path + "/" + node_file_name(listed.x(), listed.z()),
         .bytes = listed.bytes(),
         .hash = listed.hash(),
         .whose = "the index's",
         .remedy = kRemedy},
        [&](const NodeZone& found) {
          bool belongs = found.x() == listed.x() && found.z() == listed.z() &&
                         found.nodes().size() == listed.nodes();
          for (const format::FarNode& far : found.far()) {
            const size_t other = slot_at(far.x(), far.z());
            belongs = belongs && other < slots.size() && far.node() < slots[other]->entry.nodes();
          }
          const int32_t ground = world::slot_at(*data_of(world), found.x(), found.z());
          const uint32_t levels =
              ground < 0 ? 0 : data_of(world)->slots[static_cast<size_t>(ground)]->entry.levels();
          for (const format::NodePatch& patch : found.patches()) {
            belongs = belongs && (patch.kind() == static_cast<uint8_t>(PatchKind::kBezier) ||
                                  (patch.source() < levels && patch.depth() == 6));
          }
          return belongs;
        });
  });
  return entry.zone.get();
}

size_t NodeData::slot_of(uint32_t node) const {
  const auto after = std::upper_bound(slots.begin(), slots.end(), node,
                                      [](uint32_t n, const auto& s) { return n < s->first_node; });
  return static_cast<size_t>(after - slots.begin()) - 1;
}

size_t NodeData::slot_at(int32_t x, int32_t z) const {
  const auto found = std::lower_bound(slots.begin(), slots.end(), std::pair{z, x},
                                      [](const auto& s, std::pair<int32_t, int32_t> at) {
                                        return std::pair{s->entry.z(), s->entry.x()} < at;
                                      });
  const bool hit = found != slots.end() && (*found)->entry.x() == x && (*found)->entry.z() == z;
  return hit ? static_cast<size_t>(found - slots.begin()) : slots.size();
}

uint32_t NodeData::source_of(const NodeZone& from, const format::NodePatch& patch) const {
  if (patch.kind() == static_cast<uint8_t>(PatchKind::kBezier)) return patch.source();
  const world::WorldData& ground = *data_of(world);
  const auto slot = static_cast<size_t>(world::slot_at(ground, from.x(), from.z()));
  return ground.slots[slot]->first_level + patch.source();
}

std::pair<const NodeZone*, uint32_t> NodeData::find(uint32_t node) const {
  const size_t slot = slot_of(node);
  return {zone(slot), node - slots[slot]->first_node};
}

const NodeData::AreaList& NodeData::areas_before(int32_t avatar_class) const {
  static const AreaList kNone;
  if (avatar_class < 0 || avatar_class >= kMaxAvatarClasses) return kNone;
  ClassAreas& areas = class_areas[static_cast<size_t>(avatar_class)];
  std::call_once(areas.once, [&] {
    double sum = 0;
    for (size_t s = 0; s < slots.size(); ++s) {
      const NodeZone* found = zone(s);
      if (found == nullptr) continue;
      const auto nodes = found->nodes();
      const auto stands = [&](uint32_t n) { return (nodes[n].classes() >> avatar_class & 1) != 0; };
      for (uint32_t n = 0; n < nodes.size(); ++n) {
        const uint32_t parent = nodes[n].parent();
        if (!stands(n) || (parent != UINT32_MAX && stands(parent))) continue;
        sum += area_of(*found, n, avatar_class);
        areas.list.push_back({slots[s]->first_node + n, sum});
      }
    }
  });
  return areas.list;
}

uint64_t NodeData::cells_of(const NodeZone& from, uint32_t node, int32_t avatar_class) const {
  const uint64_t cells = from.cells_of(node);
  const format::Node& found = from.nodes()[node];
  if (cells == 0 || (found.classes() >> avatar_class & 1) == 0) return 0;
  const world::GroundLevel ground =
      world::ground_level(*data_of(world), source_of(from, from.patch_of(node)), avatar_class);
  return cells & ground.legal_in(world::block_of(found.s() * 8, found.t() * 8));
}

double NodeData::area_of(const NodeZone& from, uint32_t node, int32_t avatar_class) const {
  const format::Node& found = from.nodes()[node];
  if ((found.flags() & kPartialFlag) == 0) return static_cast<double>(found.area());
  const double cell = data_of(world)->summary.cell;
  return std::popcount(cells_of(from, node, avatar_class)) * cell * cell;
}

uint32_t NodeData::target(size_t slot, const NodeZone& from, uint32_t to) const {
  if ((to & kFarNode) == 0) return slots[slot]->first_node + to;
  const format::FarNode& far = from.far()[to & ~kFarNode];
  return slots[slot_at(far.x(), far.z())]->first_node + far.node();
}

std::string node_file_name(int32_t x, int32_t z) {
  return "zone_" + std::to_string(x) + "_" + std::to_string(z) + ".thn";
}

std::vector<uint8_t> write_node_index(const NodeData& nodes) {
  flatbuffers::FlatBufferBuilder builder;
  std::vector<format::NodeZoneEntry> entries;
  for (const auto& slot : nodes.slots) entries.push_back(slot->entry);
  const NodeBins& bins = nodes.summary.bins;
  const auto inclination = builder.CreateVector(bins.inclination);
  const auto height = builder.CreateVector(bins.height);
  const auto width = builder.CreateVector(bins.width);
  const auto zones = builder.CreateVectorOfStructs(entries);
  const auto inputs = builder.CreateVectorOfStructs(nodes.inputs);
  builder.Finish(
      format::CreateNodeIndex(builder, kNodeVersion, nodes.world_hash, nodes.size, inclination,
                              height, width, nodes.summary.bezier_patches, zones, inputs),
      kNodeIndexIdentifier);
  return {builder.GetBufferPointer(), builder.GetBufferPointer() + builder.GetSize()};
}

Result<std::shared_ptr<NodeData>> read_node_index(std::span<const uint8_t> bytes,
                                                  const std::string& name) {
  flatbuffers::Verifier verifier(bytes.data(), bytes.size());
  if (bytes.size() < 8 || !verifier.VerifyBuffer<format::NodeIndex>(kNodeIndexIdentifier)) {
    return bad_nodes(name, "not an index of nodes, or truncated");
  }
  const auto& root = *flatbuffers::GetRoot<format::NodeIndex>(bytes.data());
  if (root.version() != kNodeVersion) {
    return bad_nodes(name, "node version " + std::to_string(root.version()) +
                               ", this program reads " + std::to_string(kNodeVersion));
  }
  if (!root.inclination() || !root.height() || !root.width() || !root.zones() || !root.inputs() ||
      !world::is_aligned(*root.inputs()) || !world::is_aligned(*root.inclination()) ||
      !world::is_aligned(*root.height()) || !world::is_aligned(*root.width()) ||
      !world::is_aligned(*root.zones()) || !ascending(*root.inclination(), 0, 180) ||
      !ascending(*root.height(), 0, kMaxLength) || !ascending(*root.width(), 0, kMaxLength) ||
      !(root.size() > 0 && root.size() <= kMaxLength)) {
    return bad_nodes(name, "its numbers make no sense");
  }
  auto nodes = std::make_shared<NodeData>();
  nodes->world_hash = root.world();
  nodes->size = root.size();
  NodeSummary& summary = nodes->summary;
  summary.bins = {{root.inclination()->begin(), root.inclination()->end()},
                  {root.height()->begin(), root.height()->end()},
                  {root.width()->begin(), root.width()->end()}};
  summary.bezier_patches = root.bezier_patches();
  uint64_t count = 0;
  for (const format::NodeZoneEntry& entry : world::structs(*root.zones())) {
    if (!nodes->slots.empty()) {
      const format::NodeZoneEntry& last = nodes->slots.back()->entry;
      if (std::pair{last.z(), last.x()} >= std::pair{entry.z(), entry.x()}) {
        return bad_nodes(name, "its zones are out of order");
      }
    }
    if (entry.nodes() * sizeof(format::Node) > entry.bytes()) {
      return bad_nodes(name, "a zone has more nodes than bytes");
    }
    auto slot = std::make_unique<NodeData::Slot>();
    slot->entry = entry;
    slot->first_node = static_cast<uint32_t>(count);
    count += entry.nodes();
    summary.bytes += entry.bytes();
    summary.patches += entry.patches();
    nodes->slots.push_back(std::move(slot));
  }
  for (const format::NodeInput& input : world::structs(*root.inputs())) {
    if (!nodes->inputs.empty()) {
      const format::NodeInput& last = nodes->inputs.back();
      if (std::pair{last.z(), last.x()} >= std::pair{input.z(), input.x()}) {
        return bad_nodes(name, "its zones are out of order");
      }
    }
    nodes->inputs.push_back(input);
  }
  if (count >= UINT32_MAX) return bad_nodes(name, "more than 2^32 nodes");
  nodes->node_count = static_cast<uint32_t>(count);
  summary.nodes = count;
  summary.zones = nodes->slots.size();
  return nodes;
}

}  // namespace throng::graph
