// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "path/crossing.h"

/// What of a mesh can be reached from where, without a search over its portals.
namespace throng {

/// Blocks of one part are reached from each other; one-way portals lead from part to part.
class NodeParts {
 public:
  explicit NodeParts(const NodeMesh& mesh, int32_t workers);

  /// A query's memory: which parts are reached.
  class Reached {
   public:
    [[nodiscard]] bool holds(uint32_t part) const { return marks_[part] == query_; }

   private:
    friend class NodeParts;
    std::vector<uint32_t> marks_;
    uint32_t query_ = 0;
    std::vector<uint32_t> open_;
    struct Near {
      double far;
      uint32_t patch;
      bool operator<(const Near& other) const {
        return far != other.far ? far > other.far : patch > other.patch;
      }
    };
    std::vector<Near> near_;
  };

  [[nodiscard]] uint32_t of_block(uint32_t block) const { return part_of_[block]; }
  /// Marks all parts that are reached from a block. Linear in the one-way portals that lead on from
  /// them.
  void reach(uint32_t block, Reached& reached) const;
  /// Of the ends of portals that are gone through on ways from a place whose parts were marked, and
  /// of that place itself, the nearest to a goal. Patches are looked at in the order of how near
  /// they may come.
  [[nodiscard]] BlockPoint nearest(const NodeMesh& mesh, const BlockPoint& from, Vec3d goal,
                                   Reached& reached) const;

  [[nodiscard]] uint64_t bytes() const;

 private:
  std::vector<uint32_t> part_of_;  // by block
  uint32_t count_ = 0;
  std::vector<uint32_t> first_, leads_to_;  // by part: parts that one-way portals lead to
  std::vector<Box3d> boxes_;                // by patch: all ends of portals in it
};

}  // namespace throng
