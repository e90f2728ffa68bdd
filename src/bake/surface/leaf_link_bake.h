// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "bake/surface/node_folder.h"
#include "throng/surface.h"
#include "throng/world.h"

/// The second pass over nodes and air: links between leaves of the air and the nodes under them.
namespace throng::bake {

/// Makes these links zone by zone, for one process as for several.
class LeafLinkBake {
 public:
  /// Zones that are made together: rows of them, [begin, end) of all that may have links.
  struct Rows {
    uint64_t begin = 0, end = 0;
  };

  /// Of the nodes whose index lies in the folder (NodeFolder::list) and whose world has air. All is
  /// kept by reference. Fails with kBadFile, kIo or kCancelled.
  static Result<LeafLinkBake> begin(const World& world, const NodeConfig& config,
                                    const NodeFolder& folder, const Context& context);
  LeafLinkBake(LeafLinkBake&&) noexcept;
  LeafLinkBake& operator=(LeafLinkBake&&) = delete;
  ~LeafLinkBake();

  [[nodiscard]] size_t zones() const;
  /// All of them, in at most so many parts of about as many zones. What rows beside a part elect is
  /// elected for it again.
  [[nodiscard]] std::vector<Rows> parts(size_t most) const;
  /// Writes the files of some rows, or takes them over from an earlier bake; those of zones that
  /// have any, in order. The same for any number of workers and in any parts. Linear in the cells
  /// of the nodes and in the voxels times the widths of bodies. Fails with kBadFile, kIo or
  /// kCancelled.
  Result<std::vector<format::LeafLinkEntry>> make(const Rows& rows, const Context& context);
  /// The index of all that was made, by z, then x.
  [[nodiscard]] graph::LeafLinkIndex index(std::vector<format::LeafLinkEntry> made) const;

 private:
  class Baker;
  explicit LeafLinkBake(std::unique_ptr<Baker> baker);
  std::unique_ptr<Baker> baker_;
};

/// Adds to a folder that holds all nodes of a world, before it is finished, their links to the
/// world's air; none, if the world has no air. Zones of earlier bakes whose input is the same are
/// reused, unless the config says otherwise. Fails with kBadFile, kIo or kCancelled. [the world was
/// opened from the folder's]
[[nodiscard]] Result<void> link_to_air(const World& world, const graph::NodeData& nodes,
                                       const NodeConfig& config, NodeFolder& folder,
                                       Context& context);

}  // namespace throng::bake
