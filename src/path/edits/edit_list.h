// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "path/edits/ground_finder.h"
#include "path/edits/solid.h"
#include "throng/path.h"

/// What handles of Edits share, and how finders follow it.
namespace throng::path {

struct EditList {
  enum class Kind : uint8_t { kObstacle, kArea, kOffMeshLink };
  struct Edit {
    Kind kind = Kind::kObstacle;
    uint8_t area = 0;
    bool active = true, removed = false;
    ObstacleKind obstacle_kind = ObstacleKind::kStatic;
    ObstaclePolicy policy = ObstaclePolicy::kRefuseEntry;
    uint32_t moves = 0;  // so far
    // Of an obstacle or an area; of triangles the box around them, never flat. Null once removed.
    std::shared_ptr<const Prism> place;
    std::vector<std::array<Vec3d, 3>> triangles;
    OffMeshLink link;

    [[nodiscard]] bool is_obstacle() const { return kind == Kind::kObstacle; }
    /// Do finders know it?
    [[nodiscard]] bool bears_on_paths() const {
      return !is_obstacle() || obstacle_kind == ObstacleKind::kStatic;
    }
    [[nodiscard]] Solid solid() const;
  };
  enum class Call : uint8_t { kAdd, kSwitchOn, kSwitchOff, kMove, kRemove, kSetCost };
  struct Changed {
    EditId edit = 0;  // 0: an area's cost
    uint8_t area = 0;
    Call call = Call::kSetCost;
    std::shared_ptr<const Prism> place = {};  // of an obstacle after the call; null once removed
  };

  EditList() { area_costs.fill(1); }

  [[nodiscard]] uint64_t version() const { return first_version + changed.size(); }
  // `baked_kinds`: the area kinds that a bake gave to the ground of the paths, bit by kind.
  /// May paths on the ground differ from those of the baked ground?
  [[nodiscard]] bool bears_on_ground(uint64_t baked_kinds) const {
    return active_solids + active_links > 0 || has_costs(baked_kinds);
  }
  /// May a path on the ground be shorter, or cost less, than that of the baked ground?
  [[nodiscard]] bool may_shorten_paths(uint64_t baked_kinds) const {
    return active_links > 0 || has_costs(baked_kinds);
  }
  /// May places be connected that are not on the baked ground?
  [[nodiscard]] bool may_connect() const { return active_links > 0; }
  /// May a metre of ground cost something else than 1?
  [[nodiscard]] bool has_costs(uint64_t baked_kinds) const {
    return (active_areas > 0 && costly_kinds != 0) || (costly_kinds & baked_kinds) != 0;
  }
  static constexpr uint64_t kNoKinds = 0;  // bakes give none to nodes
  /// Is it known in which order calls have changed the list since a version?
  [[nodiscard]] bool knows_calls_since(uint64_t version) const { return version >= first_version; }
  /// Calls visit(Changed) for what has changed since a version, or may have; in the order of the
  /// calls if that is known, else only `edit` and `area` count.
  template <class Visit>
  void for_changed(uint64_t since, Visit visit) const {
    if (knows_calls_since(since)) {
      for (size_t i = since - first_version; i < changed.size(); ++i) visit(changed[i]);
      return;
    }
    for (EditId id = 1; id <= edits.size(); ++id) visit(Changed{.edit = id});
    for (uint8_t kind = 1; kind < area_costs.size(); ++kind) visit(Changed{.area = kind});
  }
  /// Null: there is none of this id, or it was removed.
  [[nodiscard]] const Edit* find(EditId id) const {
    const bool exists = id >= 1 && id <= edits.size() && !edits[id - 1].removed;
    return exists ? &edits[id - 1] : nullptr;
  }
  EditId add(Edit edit);
  Result<EditId> add_obstacle(Result<Solid> solid, ObstacleKind kind, ObstaclePolicy policy);
  Result<void> move_obstacle(EditId id, const Prism& prism);
  bool set_active(EditId id, bool active, bool remove);
  void set_area_cost(uint8_t kind, double cost);
  /// Counts what is active again, of edits and costs that were written one by one.
  void count_all();

  std::vector<Edit> edits;  // by id - 1
  std::array<double, 64> area_costs{};
  size_t active_solids = 0, active_areas = 0;
  size_t active_links = 0, active_node_links = 0;  // on the ground, too; only over nodes
  uint64_t costly_kinds = 0;                       // bit by kind: its cost is not 1

  /// What has changed from `first_version` on, in order. What is older was forgotten.
  std::vector<Changed> changed;
  uint64_t first_version = 0;

 private:
  void note(EditId id, Call call);
  void note(Changed what);
  void count(const Edit& edit, int by);
  void find_costly_kinds();
};

/// The edits that one finder has applied.
class AppliedEdits {
 public:
  enum class Which : uint8_t { kAll, kAreas, kAreasAndLinks };
  explicit AppliedEdits(Which which = Which::kAll) : which_(which) {}

  /// Applies what has changed since the last call, to the same finder or a copy of it.
  template <class Finder>
  void follow(const EditList& list, Finder& finder) {
    if (version_ == list.version()) return;
    while (own_.size() < list.edits.size()) own_.push_back(add(list.edits[own_.size()], finder));
    list.for_changed(version_, [&](const EditList::Changed& what) {
      if (what.edit != 0) apply(list.edits[what.edit - 1], own_[what.edit - 1], finder);
      if (what.edit == 0) set_cost(finder, what.area, list.area_costs[what.area]);
    });
    version_ = list.version();
  }

  /// What an edit is to the finder; 0: none, or not applied yet.
  [[nodiscard]] ChangeId own(EditId edit) const {
    return edit - 1 < own_.size() ? own_[edit - 1].id : 0;
  }

  /// The edit that a change of the finder is; 0: none. Time: linear in the edits.
  [[nodiscard]] EditId edit_of(ChangeId change) const {
    EditId edit = change == 0 ? 0 : static_cast<EditId>(own_.size());
    while (edit > 0 && own_[edit - 1].id != change) --edit;
    return edit;
  }

 private:
  struct Own {
    ChangeId id = 0;     // of the finder; 0: none
    uint32_t moves = 0;  // that it has made
  };

  // Also one that is not active: of areas that overlap the last one counts.
  template <class Finder>
  [[nodiscard]] Own add(const EditList::Edit& edit, Finder& finder) const {
    const ChangeId id = edit.removed || !is_wanted(edit) ? 0 : id_of_new(edit, finder);
    if (id != 0 && !edit.active) finder.set_active(id, false);
    return {id, edit.moves};
  }

  template <class Finder>
  void apply(const EditList::Edit& edit, Own& own, Finder& finder) const {
    if (own.id == 0) return;
    if (edit.removed || own.moves != edit.moves) {
      finder.remove(own.id);
      own = add(edit, finder);
    }
    if (own.id != 0) finder.set_active(own.id, edit.active);
  }

  [[nodiscard]] bool is_wanted(const EditList::Edit& edit) const {
    if (!edit.bears_on_paths()) return false;
    return which_ == Which::kAll || edit.kind == EditList::Kind::kArea ||
           (which_ == Which::kAreasAndLinks && edit.kind == EditList::Kind::kOffMeshLink);
  }

  // 0: the finder does not know edits of this kind, or cannot use this one.
  template <class Finder>
  static ChangeId id_of_new(const EditList::Edit& edit, Finder& finder) {
    if (edit.is_obstacle()) return finder.add_obstacle(edit.solid());
    if constexpr (requires { finder.set_area_cost(uint8_t{1}, 1.0); }) {
      const auto added = edit.kind == EditList::Kind::kArea
                             ? finder.add_area(*edit.place, edit.area)
                             : finder.add_off_mesh_link(edit.link);
      return added ? *added : 0;
    }
    return 0;
  }
  template <class Finder>
  static void set_cost(Finder& finder, uint8_t kind, double cost) {
    if constexpr (requires { finder.set_area_cost(kind, cost); }) {
      const auto set = finder.set_area_cost(kind, cost);
      THRONG_ASSERT(set);  // Edits has checked it.
    }
  }

  Which which_;
  std::vector<Own> own_;  // by id of the edit - 1
  uint64_t version_ = 0;
};

}  // namespace throng::path
