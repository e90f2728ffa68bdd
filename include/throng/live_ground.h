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

/// A baked world as one class sees it now: with obstacles put up, doors shut, areas marked and
/// priced since the bake. Nothing is made before it is needed, and a change undoes only the tiles
/// that it touches: for large worlds that change. For many ways over a world that does not, take a
/// PathFinder.
namespace throng {

struct LiveConfig {
  int32_t avatar_class = 0;
  /// Cost of a metre on a slope: 1 + slope_cost * rise, by classes of rise that end at 5, 10, 20,
  /// 35, 60 and 120 %, each by its end; the gentlest is level ground, the last has all steeper
  /// ones, too. [>= 0]
  double slope_cost = 0;
};

/// See LiveGround::add_off_mesh_link.
struct OffMeshLink {
  Place from, to;
  double cost = 0;  ///< [m]
  bool two_way = true;
};

/// One change; 0 is none.
using ChangeId = uint32_t;

/// Obstacles only take away: who wants to stand on a crate bakes it. Changes and questions from one
/// thread at a time; copies are independent. Answers are the same on every machine.
class THRONG_API LiveGround {
 public:
  /// Reads nothing yet. Fails with kBadConfig.
  [[nodiscard]] static Result<LiveGround> make(const World& world, const LiveConfig& config);
  LiveGround(const LiveGround&);
  LiveGround& operator=(const LiveGround&);
  LiveGround(LiveGround&&) noexcept;
  LiveGround& operator=(LiveGround&&) noexcept;
  ~LiveGround();

  /// Nobody of the class stands where his body could touch the prism, its bottom above his step.
  /// Fails with kBadInput. Time: the tiles that it touches.
  [[nodiscard]] Result<ChangeId> add_obstacle(const Prism& prism);
  /// The same for triangles, and only for those: a closed shell is hollow.
  [[nodiscard]] Result<ChangeId> add_obstacle(std::span<const Vec3d> corners,
                                              std::span<const std::array<uint32_t, 3>> triangles);
  /// Floors inside the prism are of this kind from now on; of several, the last one added counts.
  [[nodiscard]] Result<ChangeId> add_area(const Prism& prism, uint8_t kind);
  /// A way that moves do not know, given by hand: a jump over a ditch, a ladder, a lift. It leads
  /// from one place of the class to another, and back if two_way; nobody checks what is between.
  /// It costs as many metres, at least as many as it is long in the plane. Fails with kBadInput.
  [[nodiscard]] Result<ChangeId> add_off_mesh_link(const OffMeshLink& off_mesh_link);
  /// Takes a change back, for good or, as a door, until it is set again. False if there is none.
  bool remove(ChangeId change);
  bool set_active(ChangeId change, bool active);
  /// Cost of a metre on ground of a kind; infinity closes it. 1 for all kinds at first. Fails with
  /// kBadConfig. [kind 1 to 63, 0.01 to 10000 or infinity]
  [[nodiscard]] Result<void> set_area_cost(uint8_t kind, double cost);

  /// May the class stand there now?
  [[nodiscard]] bool is_free(const Place& place);
  /// A way of little cost, every leg a legal move: over points of the borders of rectangles, drawn
  /// straight afterwards, in the mean within 1 % of the best. Where none leads there
  /// (kUnreachable), `path` leads to the place of least distance to the goal that was met, and says
  /// what is in the way. Gives up when the budget of points or of memory is spent (Path::spent). No
  /// allocation once it is warm.
  void find(const Place& from, const Place& to, Path& path, const SearchBudget& budget = {});
  /// The same in slices: begin, then advance by some points a frame until it says true. Gives up
  /// where it would take more than SearchBudget::kDefaultBytes.
  void begin(const Place& from, const Place& to);
  bool advance(uint64_t max_nodes, Path& path);

 private:
  friend class FlowPoints;
  struct State;
  explicit LiveGround(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace throng
