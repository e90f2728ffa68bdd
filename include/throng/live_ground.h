// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "throng/base.h"
#include "throng/path.h"
#include "throng/prism.h"
#include "throng/result.h"
#include "throng/search_budget.h"
#include "throng/world.h"

/// The ground of a baked world for one class as it is now: with obstacles, doors, areas and area
/// costs that have changed since the bake. Data is made when a query needs it, and a change
/// discards only the tiles that it touches. Use it for large worlds that change; for many paths
/// over a world that does not change, use a PathFinder.
namespace throng {

/// Settings for LiveGround::make.
struct LiveConfig {
  int32_t avatar_class = 0;
  /// Cost of a metre on a slope is 1 + slope_cost * rise. Rises are rounded up to 5, 10, 20, 35, 60
  /// or 120 %; the gentlest class counts as level ground, the steepest holds all steeper slopes,
  /// too. [>= 0]
  double slope_cost = 0;
};

/// An off-mesh link, see LiveGround::add_off_mesh_link.
struct OffMeshLink {
  Place from, to;
  double cost = 0;  ///< [m]
  bool two_way = true;
};

/// Names a change; 0 names none.
using ChangeId = uint32_t;

/// The ground of one class with changes. Obstacles only remove ground: an avatar can stand on a
/// crate only if it was baked. Changes and queries are for one thread at a time; copies are
/// independent. Results are the same on every machine.
class THRONG_API LiveGround {
 public:
  /// Makes the ground of a class; reads nothing yet. Fails with kBadConfig.
  [[nodiscard]] static Result<LiveGround> make(const World& world, const LiveConfig& config);
  LiveGround(const LiveGround&);
  LiveGround& operator=(const LiveGround&);
  LiveGround(LiveGround&&) noexcept;
  LiveGround& operator=(LiveGround&&) noexcept;
  ~LiveGround();

  /// Puts up an obstacle: the class is illegal where its body, from body_bottom() up, could touch
  /// the prism. Fails with kBadInput. Time: the tiles that it touches.
  [[nodiscard]] Result<ChangeId> add_obstacle(const Prism& prism);
  /// The same for triangles. Only these are solid: a closed shell is hollow.
  [[nodiscard]] Result<ChangeId> add_obstacle(std::span<const Vec3d> corners,
                                              std::span<const std::array<uint32_t, 3>> triangles);
  /// Gives floors inside a prism an area kind; where several overlap, the last one counts.
  [[nodiscard]] Result<ChangeId> add_area(const Prism& prism, uint8_t kind);
  /// Adds an off-mesh link, which no move finds: over a ditch, up a ladder, by a lift. It leads
  /// from one place of the class to another, and back if `two_way`; what lies between is not
  /// tested. Its cost counts as metres and is at least its length in the plane. Fails with
  /// kBadInput.
  [[nodiscard]] Result<ChangeId> add_off_mesh_link(const OffMeshLink& off_mesh_link);
  /// Removes a change, or switches it off and on, as a door. False if there is none of this id.
  bool remove(ChangeId change);
  bool set_active(ChangeId change, bool active);
  /// Sets the cost of a metre on ground of an area kind; infinity closes it. All kinds begin with
  /// 1. Fails with kBadConfig. [kind 1 to 63, 0.01 to 10000 or infinity]
  [[nodiscard]] Result<void> set_area_cost(uint8_t kind, double cost);

  /// Is the place legal for the class now?
  [[nodiscard]] bool is_free(const Place& place);
  /// Finds a path of low cost; each segment is a legal move. The search goes over points on the
  /// borders of rectangles, and the path is pulled taut afterwards: on average within 1 % of the
  /// best. If no path leads to the goal (kUnreachable), `path` leads to the reached place nearest
  /// to it, and Path::obstacle says what blocks it. Stops when the budget of points or memory is
  /// exhausted (Path::spent). No allocation once it is warm.
  void find(const Place& from, const Place& to, Path& path, const SearchBudget& budget = {});
  /// The same search in parts: call begin, then advance with some points per frame until it returns
  /// true. Stops where it would take more than SearchBudget::kDefaultBytes.
  void begin(const Place& from, const Place& to);
  bool advance(uint64_t max_nodes, Path& path);

 private:
  friend class FlowPoints;
  struct State;
  explicit LiveGround(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace throng
