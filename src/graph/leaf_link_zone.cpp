// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "graph/leaf_link_zone.h"

#include <algorithm>
#include <tuple>
#include <utility>

#include "graph/node_data.h"

// Reads and checks files of links between leaves of the air and nodes. What is checked here need
// not be checked by any look-up.
namespace throng::graph {
namespace {

constexpr const char* kZoneIdentifier = "THGZ";
constexpr const char* kIndexIdentifier = "THGX";
constexpr uint32_t kCells = 1u << kDeepestPatch;

Error bad_links(const std::string& name, const std::string& what) {
  return world::bad_file(name, what, kLeafLinkRemedy);
}

std::string version_fault(uint32_t version) {
  return "version " + std::to_string(version) + " of links to the air, this program reads " +
         std::to_string(kLeafLinkVersion);
}

}  // namespace

Result<void> LeafLinkZone::attach(const std::string& name) {
  flatbuffers::Verifier verifier(bytes().data(), bytes().size());
  if (bytes().size() < 8 || !verifier.VerifyBuffer<format::LeafLinkZone>(kZoneIdentifier)) {
    return bad_links(name, "not a file of links to the air, or truncated");
  }
  root_ = flatbuffers::GetRoot<format::LeafLinkZone>(bytes().data());
  if (root_->version() != kLeafLinkVersion) {
    return bad_links(name, version_fault(root_->version()));
  }
  if (!root_->links() || !root_->by_node() || !root_->far() || !root_->far_leaves()) {
    return bad_links(name, "an array is missing");
  }
  links_ = world::structs(*root_->links());
  by_node_ = {reinterpret_cast<const uint32_t*>(root_->by_node()->Data()),
              root_->by_node()->size()};
  far_ = world::structs(*root_->far());
  far_leaves_ = world::structs(*root_->far_leaves());
  if (const char* what = fault()) return bad_links(name, what);
  return {};
}

const char* LeafLinkZone::fault() const {
  size_t own = 0;
  for (size_t i = 0; i < links_.size(); ++i) {
    const format::LeafLink& link = links_[i];
    const bool is_far = (link.node() & kFarNode) != 0;
    if (is_far && (link.node() & ~kFarNode) >= far_.size()) return "a link leads nowhere";
    if (link.classes() == 0 || link.piece() >= 64 || link.s() >= kCells || link.t() >= kCells) {
      return "a link makes no sense";
    }
    if (i > 0 && leaf_of(links_[i - 1]) > leaf_of(link)) return "its links are out of order";
    own += is_far ? 0 : 1;
  }
  if (by_node_.size() != own) return "a link does not lead back";
  for (size_t i = 0; i < by_node_.size(); ++i) {
    const uint32_t link = by_node_[i];
    if (link >= links_.size() || (links_[link].node() & kFarNode) != 0) {
      return "a node leads to no link";
    }
    if (i > 0 && std::pair(links_[by_node_[i - 1]].node(), by_node_[i - 1]) >=
                     std::pair(links_[link].node(), link)) {
      return "its links by node are out of order";
    }
  }
  const auto order = [](const format::NodeLeaf& leaf) {
    return std::tuple(leaf.node(), leaf.z(), leaf.x(), leaf.link());
  };
  for (size_t i = 1; i < far_leaves_.size(); ++i) {
    if (order(far_leaves_[i - 1]) >= order(far_leaves_[i])) {
      return "its leaves of other zones are out of order";
    }
  }
  return nullptr;
}

std::span<const format::LeafLink> LeafLinkZone::of_leaf(const world::AirLeaf& leaf) const {
  const auto first = std::lower_bound(
      links_.begin(), links_.end(), leaf,
      [](const format::LeafLink& link, const world::AirLeaf& at) { return leaf_of(link) < at; });
  auto last = first;
  while (last != links_.end() && leaf_of(*last) == leaf) ++last;
  return links_.subspan(static_cast<size_t>(first - links_.begin()),
                        static_cast<size_t>(last - first));
}

std::span<const uint32_t> LeafLinkZone::of_node(uint32_t node) const {
  const auto first =
      std::lower_bound(by_node_.begin(), by_node_.end(), node,
                       [&](uint32_t link, uint32_t at) { return links_[link].node() < at; });
  auto last = first;
  while (last != by_node_.end() && links_[*last].node() == node) ++last;
  return by_node_.subspan(static_cast<size_t>(first - by_node_.begin()),
                          static_cast<size_t>(last - first));
}

std::span<const format::NodeLeaf> LeafLinkZone::far_of_node(uint32_t node) const {
  const auto first =
      std::lower_bound(far_leaves_.begin(), far_leaves_.end(), node,
                       [](const format::NodeLeaf& leaf, uint32_t at) { return leaf.node() < at; });
  auto last = first;
  while (last != far_leaves_.end() && last->node() == node) ++last;
  return far_leaves_.subspan(static_cast<size_t>(first - far_leaves_.begin()),
                             static_cast<size_t>(last - first));
}

std::vector<uint8_t> write_leaf_link_index(const LeafLinkIndex& index) {
  flatbuffers::FlatBufferBuilder builder;
  const auto zones = builder.CreateVectorOfStructs(index.zones);
  builder.Finish(
      format::CreateLeafLinkIndex(builder, kLeafLinkVersion, index.air, index.nodes, zones),
      kIndexIdentifier);
  return {builder.GetBufferPointer(), builder.GetBufferPointer() + builder.GetSize()};
}

Result<LeafLinkIndex> read_leaf_link_index(std::span<const uint8_t> bytes,
                                           const std::string& name) {
  flatbuffers::Verifier verifier(bytes.data(), bytes.size());
  if (bytes.size() < 8 || !verifier.VerifyBuffer<format::LeafLinkIndex>(kIndexIdentifier)) {
    return bad_links(name, "not an index of links to the air, or truncated");
  }
  const auto& root = *flatbuffers::GetRoot<format::LeafLinkIndex>(bytes.data());
  if (root.version() != kLeafLinkVersion) return bad_links(name, version_fault(root.version()));
  if (!root.zones() || !world::is_aligned(*root.zones())) {
    return bad_links(name, "its numbers make no sense");
  }
  LeafLinkIndex index{.air = root.air(), .nodes = root.nodes(), .zones = {}};
  for (const format::LeafLinkEntry& entry : world::structs(*root.zones())) {
    if (!index.zones.empty()) {
      const format::LeafLinkEntry& last = index.zones.back();
      if (std::pair{last.z(), last.x()} >= std::pair{entry.z(), entry.x()}) {
        return bad_links(name, "its zones are out of order");
      }
    }
    if (entry.leaves() > entry.met() || entry.leaves() > entry.links()) {
      return bad_links(name, "its numbers make no sense");
    }
    index.zones.push_back(entry);
  }
  return index;
}

std::string leaf_link_file_name(int32_t x, int32_t z) {
  return "zone_" + std::to_string(x) + "_" + std::to_string(z) + ".thg";
}

}  // namespace throng::graph
