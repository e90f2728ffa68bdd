// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "graph/node_mesh.h"
#include "throng/math.h"

/// How far it is at least from anywhere to a goal, around what lies between, told by how far both
/// are from a few landmarks. Source: [GH05].
namespace throng {

class NodeLandmarks {
 public:
  static constexpr size_t kCount = 8;

  /// None: nothing is known.
  NodeLandmarks() = default;
  /// At the ends of the largest part of the mesh, in eight directions. As long as eight searches
  /// over all portals. The same for any number of workers.
  NodeLandmarks(const NodeMesh& mesh, int32_t workers);

  /// How far a place is from each; where that is not known, anything but a number that counts. [m]
  using Distances = std::array<float, kCount>;
  [[nodiscard]] Distances of(const NodeMesh& mesh, uint32_t block, Vec3d at) const;
  /// A length that no way from a portal to such a place is shorter than; one-way portals are taken
  /// for open both ways. 0 if nothing is known. [m]
  [[nodiscard]] double least(uint32_t portal, const Distances& goal) const;

  [[nodiscard]] uint64_t bytes() const { return far_.size() * sizeof(Distances); }

 private:
  std::vector<Distances> far_;  // by portal
};

}  // namespace throng
