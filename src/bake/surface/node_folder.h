// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/files/folder_lock.h"
#include "graph/leaf_link_zone.h"
#include "graph/node_data.h"

/// Nodes in a world's folder: those of earlier bakes, whole or killed, and those that are made.
namespace throng::bake {

class OldNodes {
 public:
  /// Of the world itself, those that its bake has reused from the world before it, and those
  /// that a killed bake had made. What cannot be read is left out. [world_path may be empty: none]
  explicit OldNodes(const std::string& world_path);

  /// A zone's nodes that need not be made: `slot` is null if it has none, else mapped, from `file`.
  struct Reused {
    std::unique_ptr<graph::NodeData::Slot> slot;
    std::string file;
  };
  /// If they were made from this input and their file is whole.
  [[nodiscard]] std::optional<Reused> reuse(int32_t x, int32_t z, uint64_t input) const;

  /// The same for a zone's links to the air: null if they must be made.
  struct ReusedLinks {
    std::unique_ptr<graph::LeafLinkZone> zone;
    format::LeafLinkEntry entry;
    std::string file;
  };
  [[nodiscard]] ReusedLinks reuse_links(int32_t x, int32_t z, uint64_t input) const;

 private:
  struct OldLinks {
    std::string path;
    graph::LeafLinkIndex index;
  };
  std::vector<std::shared_ptr<const graph::NodeData>> folders_;  // their indexes
  std::vector<OldLinks> links_;
};

/// The folder that replaces a world's nodes at once, when all are in it. Until then it lies beside
/// them, and its index names what is there for the next bake. Every call may fail with kIo.
class NodeFolder {
 public:
  /// Of a world in its folder, held against other bakes. What a killed bake has left there stays
  /// for now.
  static Result<NodeFolder> begin(const std::string& world_path);
  /// One that another process has begun and will finish.
  static NodeFolder join(const std::string& world_path);
  NodeFolder(NodeFolder&& other) noexcept;
  NodeFolder& operator=(NodeFolder&&) = delete;
  /// Removes what was begun and not finished.
  ~NodeFolder();

  /// Adds a zone's nodes. From several threads, of different zones.
  Result<void> write(const graph::NodeZone& zone) const;
  /// Adds those of an earlier bake, mapped from `file`.
  Result<void> take_over(const graph::NodeZone& zone, const std::string& file) const;
  /// The same for a zone's links to the air.
  Result<void> write(const graph::LeafLinkZone& zone) const;
  Result<void> take_over(const graph::LeafLinkZone& zone, const std::string& file) const;
  /// Writes the index of what is there so far.
  Result<void> list(const graph::NodeData& nodes) const;
  [[nodiscard]] std::string part() const { return part_.string(); }
  /// Leaves what was begun to the next bake.
  void leave() { part_.clear(); }
  /// Links to the air, whose zones are in the folder: finish() writes their index, too.
  void set_links(graph::LeafLinkIndex links) { links_ = std::move(links); }
  /// Writes the index of all; then they are the world's nodes.
  Result<void> finish(const graph::NodeData& nodes);

 private:
  explicit NodeFolder(std::string world_path);

  std::string world_path_;
  std::filesystem::path part_;  // empty: finished, left or moved from
  bool is_own_ = true;
  std::optional<graph::LeafLinkIndex> links_;  // none: of a world without air
  FolderLock world_lock_, part_lock_;
};

/// Reuses the nodes of the world in `from` for `to`, which takes its place, as far as possible: as
/// its own if it is the same world; without links to the air if that is another.
void carry_nodes(const std::string& from, const std::string& to, bool is_same_world,
                 bool is_same_air);

}  // namespace throng::bake
