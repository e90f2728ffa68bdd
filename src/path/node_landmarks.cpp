// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "path/node_landmarks.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/disjoint_sets.h"
#include "core/parallel.h"

// A portal is one place for this, though it has two ends: what lies between them is left out, and
// so is that a piece within a block is longer than the straight line, or costs more than its
// length. So these lengths are a metric, and none is longer than what a way costs.
namespace throng {
namespace {

constexpr double kUnknown = std::numeric_limits<double>::infinity();

// The middles of a portal's ends.
struct Ends {
  Vec3d on_a, on_b;
};

Vec3d middle_of(const NodeMesh& mesh, uint32_t block, const std::array<double, 4>& line) {
  return mesh.surface(block).at((line[0] + line[2]) / 2, (line[1] + line[3]) / 2);
}

Ends ends_of(const NodeMesh& mesh, const NodePortal& portal) {
  return {middle_of(mesh, portal.a, portal.on_a), middle_of(mesh, portal.b, portal.on_b)};
}

// Dijkstra's algorithm.
class FromOne {
 public:
  FromOne(const NodeMesh& mesh, const std::vector<Ends>& ends)
      : mesh_(mesh), ends_(ends), far_(ends.size(), kUnknown) {}

  const std::vector<double>& run(uint32_t portal) {
    reach(portal, 0);
    while (!open_.empty()) {
      std::pop_heap(open_.begin(), open_.end(), later);
      const Open top = open_.back();
      open_.pop_back();
      if (top.far > far_[top.portal]) continue;
      const NodePortal& at = mesh_.portals()[top.portal];
      go_on(at.a, ends_[top.portal].on_a, top);
      go_on(at.b, ends_[top.portal].on_b, top);
    }
    return far_;
  }

 private:
  struct Open {
    double far;
    uint32_t portal;
  };
  static bool later(const Open& a, const Open& b) { return a.far > b.far; }

  void go_on(uint32_t block, Vec3d from, const Open& at) {
    for (const uint32_t next : mesh_.portals_of(block)) {
      if (next == at.portal) continue;
      // A leap may end in the block in which it begins.
      const NodePortal& portal = mesh_.portals()[next];
      if (portal.a == block) reach(next, at.far + length(ends_[next].on_a - from));
      if (portal.b == block) reach(next, at.far + length(ends_[next].on_b - from));
    }
  }

  void reach(uint32_t portal, double far) {
    if (far >= far_[portal]) return;
    far_[portal] = far;
    open_.push_back({far, portal});
    std::push_heap(open_.begin(), open_.end(), later);
  }

  const NodeMesh& mesh_;
  const std::vector<Ends>& ends_;
  std::vector<double> far_;
  std::vector<Open> open_;
};

// Portals of the largest part, by how many it has.
std::vector<uint32_t> largest_part(const NodeMesh& mesh) {
  DisjointSets parts(mesh.blocks().size());
  for (const NodePortal& portal : mesh.portals()) parts.join(portal.a, portal.b);
  std::vector<uint32_t> count(mesh.blocks().size(), 0);
  for (const NodePortal& portal : mesh.portals()) ++count[parts.find(portal.a)];
  const auto largest =
      static_cast<uint32_t>(std::max_element(count.begin(), count.end()) - count.begin());
  std::vector<uint32_t> found;
  for (uint32_t p = 0; p < mesh.portals().size(); ++p) {
    if (parts.find(mesh.portals()[p].a) == largest) found.push_back(p);
  }
  return found;
}

}  // namespace

NodeLandmarks::NodeLandmarks(const NodeMesh& mesh, int32_t workers) {
  if (mesh.portals().empty()) return;
  std::vector<Ends> ends(mesh.portals().size());
  parallel_for(ends.size(), workers, [&](size_t p) { ends[p] = ends_of(mesh, mesh.portals()[p]); });
  const std::vector<uint32_t> part = largest_part(mesh);
  far_.resize(ends.size());
  constexpr std::array<std::array<double, 2>, kCount> kWays{
      {{1, 0}, {0.7, 0.7}, {0, 1}, {-0.7, 0.7}, {-1, 0}, {-0.7, -0.7}, {0, -1}, {0.7, -0.7}}};
  parallel_for(kCount, workers, [&](size_t k) {
    const auto along = [&](uint32_t p) {
      return ends[p].on_a.x * kWays[k][0] + ends[p].on_a.z * kWays[k][1];
    };
    const uint32_t landmark = *std::max_element(
        part.begin(), part.end(), [&](uint32_t a, uint32_t b) { return along(a) < along(b); });
    FromOne search(mesh, ends);
    const std::vector<double>& far = search.run(landmark);
    for (size_t p = 0; p < far.size(); ++p) far_[p][k] = static_cast<float>(far[p]);
  });
}

NodeLandmarks::Distances NodeLandmarks::of(const NodeMesh& mesh, uint32_t block, Vec3d at) const {
  std::array<double, kCount> least;
  least.fill(kUnknown);
  if (!far_.empty()) {
    for (const uint32_t p : mesh.portals_of(block)) {
      const NodePortal& portal = mesh.portals()[p];
      const auto to = [&](const std::array<double, 4>& line) {
        return length(middle_of(mesh, block, line) - at);
      };
      const double rest = std::min(portal.a == block ? to(portal.on_a) : kUnknown,
                                   portal.b == block ? to(portal.on_b) : kUnknown);
      for (size_t k = 0; k < kCount; ++k) {
        least[k] = std::min(least[k], static_cast<double>(far_[p][k]) + rest);
      }
    }
  }
  Distances far;
  for (size_t k = 0; k < kCount; ++k) far[k] = static_cast<float>(least[k]);
  return far;
}

double NodeLandmarks::least(uint32_t portal, const Distances& goal) const {
  if (far_.empty()) return 0;
  constexpr float kRounded = 1e-6F;  // of what is subtracted
  float most = 0;
  for (size_t k = 0; k < kCount; ++k) {
    // Infinite less infinite is no number, and counts as little as too small a one.
    const float a = far_[portal][k], b = goal[k];
    const float apart = std::fabs(a - b) - kRounded * (a + b);
    most = apart > most ? apart : most;
  }
  return static_cast<double>(most);
}

}  // namespace throng
