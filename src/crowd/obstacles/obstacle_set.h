// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <unordered_map>
#include <utility>
#include <vector>

#include "crowd/ground/body.h"
#include "crowd/ground/crowd_ground.h"
#include "path/edits/solid.h"
#include "throng/crowd.h"
#include "throng/path.h"
#include "throng/world.h"

/// The obstacles of a crowd, and what each blocks of the grounds of the classes.
namespace throng::crowd {

/// Cells of a level.
struct LevelCells {
  uint32_t level = 0;
  world::CellRows rows{};
};

struct CrowdObstacle {
  EditId edit = 0;  // whose it is
  bool exists = false;
  ObstacleKind kind = ObstacleKind::kStatic;
  ObstaclePolicy policy = ObstaclePolicy::kRefuseEntry;
  bool is_up = false, wanted_up = false;
  bool is_elsewhere = false;  // it is active, but requested to be at `wanted`
  Prism place, wanted;
  bool has_cells = false;     // they are blocked in the grounds: it is active, or closes
  bool is_exit_only = false;  // walkers stand on these cells, and may only leave
  uint32_t version = 0;       // of `place`
  uint64_t requested_step = kNever, up_step = kNever;  // steps made before the request, and before
                                                       // it became active
  uint32_t occupants = 0;                              // that blocked it at the last check

  static constexpr uint64_t kNever = UINT64_MAX;

  // By class, empty for those that are not in use.
  struct OfClass {
    std::vector<uint32_t> levels;   // on which it blocks cells, while it is active
    std::vector<LevelCells> swept;  // that must be clear before it may become active or move on
    // Its ids in the class's live grounds and in its finders through the air and over nodes; synced
    // to `synced_version` of its place.
    path::ChangeId change = 0, air_change = 0, node_change = 0;
    bool is_synced = false;
    uint32_t synced_version = 0;
  };
  std::vector<OfClass> of_class;

  [[nodiscard]] bool waits() const { return exists && ((wanted_up && !is_up) || is_elsewhere); }
  /// Not active, but no avatar may enter it.
  [[nodiscard]] bool closes() const { return exists && has_cells && !is_up; }
};

/// The smallest convex prism around two prisms.
Prism hull_of(const Prism& a, const Prism& b);

class ObstacleSet {
 public:
  ObstacleSet(World world, size_t classes);

  /// Takes a class into use: what is active is blocked in its ground at once. `body`: the class of
  /// the world that it is.
  void open_class(size_t number, CrowdGround& ground, size_t body);

  /// Reverts open_class. The cells of the ground stay blocked.
  void close_class(size_t number);

  /// [check_prism] It waits until it is settled.
  uint32_t add(const Prism& prism, ObstacleKind kind, bool wanted_up,
               ObstaclePolicy policy = ObstaclePolicy::kRefuseEntry);
  [[nodiscard]] std::span<const CrowdObstacle> all() const { return obstacles_; }
  [[nodiscard]] CrowdObstacle& at(uint32_t slot) { return obstacles_[slot]; }

  void request_move(uint32_t slot, const Prism& prism);
  void request_active(uint32_t slot, bool up);
  void remove(uint32_t slot);

  /// Those that wait, or are exit-only, in order of slot.
  [[nodiscard]] std::span<const uint32_t> waiting() const { return waiting_; }
  /// Is one that paths avoid active, or does one close?
  [[nodiscard]] bool cuts_paths() const { return path_cutters_ > 0; }
  /// Those of which the place or the cells may have changed since the last call, each once, in
  /// order of slot.
  [[nodiscard]] std::vector<uint32_t> take_changed();
  /// Bodies that stand where some of them would appear or pass: (obstacle, index of the body), in
  /// order.
  [[nodiscard]] std::vector<std::pair<uint32_t, uint32_t>> blockers(std::span<const uint32_t> slots,
                                                                    std::span<const Body> bodies,
                                                                    int32_t workers) const;
  /// Puts it where it waited to be. Call block_cells then.
  void settle(uint32_t slot);
  /// From now on it can only be left. Call block_cells then.
  void close(uint32_t slot);
  /// Lets bodies on its cells leave these, or ends that. Call block_cells then.
  void set_exit_only(uint32_t slot, bool lets);
  /// From now on a density map blocks these cells of a class in use, and no others; `may_leave`:
  /// bodies stand on some. Call block_cells then.
  void set_zero_cells(size_t number, std::span<const LevelCells> cells, bool may_leave);
  /// The same cells. Call block_cells then.
  void set_zero_leave(size_t number, bool may_leave);
  [[nodiscard]] bool may_leave_zero(size_t number) const { return classes_[number].may_leave_zero; }
  /// Does a body stand on such a cell of its class?
  [[nodiscard]] bool is_on_zero(const Body& body) const;
  /// Updates the grounds to all that was settled, deactivated or removed.
  void block_cells();

  /// In the order in which they are reused: the last first.
  [[nodiscard]] std::span<const uint32_t> free_slots() const { return free_slots_; }
  /// To be called before any class is opened. [not sound: false]
  bool restore(std::vector<CrowdObstacle> obstacles, std::vector<uint32_t> free_slots);
  [[nodiscard]] uint64_t bytes() const;

 private:
  struct CellBlocker {
    uint32_t slot;
    world::CellRows rows;
  };
  struct ClassGround {
    CrowdGround* ground = nullptr;                             // null: the class is not in use
    size_t body = 0;                                           // class of the world
    std::unordered_map<uint32_t, world::CellRows> zero_cells;  // by level; looked up only
    bool may_leave_zero = false;
    std::unordered_map<uint32_t, std::vector<CellBlocker>>
        cell_blockers;              // by level; looked up only
    std::vector<uint32_t> touched;  // levels, with doubles
  };
  void block_levels(ClassGround& of);
  [[nodiscard]] std::vector<LevelCells> cells_under(size_t number, const Prism& prism) const;
  void find_swept(uint32_t slot);
  void take(uint32_t slot);
  void unblock(uint32_t slot);
  void note(uint32_t slot);
  void put_up(uint32_t slot, size_t number);
  void unblock_class(uint32_t slot, size_t number);

  World world_;
  std::vector<ClassGround> classes_;
  std::vector<CrowdObstacle> obstacles_;
  std::vector<uint32_t> free_slots_;
  // Of these, so that no call needs to look at all of them:
  std::vector<uint32_t> waiting_;  // slots, rising
  std::vector<uint32_t> changed_;  // slots, in no order
  std::vector<bool> is_changed_;   // by slot: it is one of these
  size_t path_cutters_ = 0;        // kStatic ones with cells
};

}  // namespace throng::crowd
