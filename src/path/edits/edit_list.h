// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
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
    Solid solid;  // of an area: its prism
    OffMeshLink link;
  };
  struct Changed {
    EditId edit = 0;  // 0: an area's cost
    uint8_t area = 0;
  };

  EditList() { area_costs.fill(1); }

  [[nodiscard]] uint64_t version() const { return first_version + changed.size(); }
  /// May paths on the ground differ from those of the baked ground?
  [[nodiscard]] bool bears_on_ground() const {
    return active_solids + active_links > 0 || has_costs();
  }
  /// May a path on the ground be shorter, or cost less, than that of the baked ground?
  [[nodiscard]] bool may_shorten_paths() const { return active_links > 0 || has_costs(); }
  /// May places be connected that are not on the baked ground?
  [[nodiscard]] bool may_connect() const { return active_links > 0; }
  /// Do areas have another cost than the ground around them?
  [[nodiscard]] bool has_costs() const { return active_areas > 0 && costs_differ; }
  /// Calls visit(Changed) for what has changed since a version, or may have.
  template <class Visit>
  void for_changed(uint64_t since, Visit visit) const {
    if (since >= first_version) {
      for (size_t i = since - first_version; i < changed.size(); ++i) visit(changed[i]);
      return;
    }
    for (EditId id = 1; id <= edits.size(); ++id) visit(Changed{.edit = id});
    for (uint8_t kind = 1; kind < area_costs.size(); ++kind) visit(Changed{.area = kind});
  }
  EditId add(Edit edit);
  Result<EditId> add_obstacle(Result<Solid> solid);
  bool set_active(EditId id, bool active, bool remove);
  void set_area_cost(uint8_t kind, double cost);

  std::vector<Edit> edits;  // by id - 1
  std::array<double, 64> area_costs{};
  size_t active_solids = 0, active_areas = 0;
  size_t active_links = 0, active_node_links = 0;  // on the ground, too; only over nodes
  bool costs_differ = false;                       // of areas, from 1

  /// What has changed from `first_version` on, in order. What is older was forgotten.
  std::vector<Changed> changed;
  uint64_t first_version = 0;

 private:
  void note(Changed what);
  void count(const Edit& edit, int by);
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
    while (ids_.size() < list.edits.size()) add(list.edits[ids_.size()], finder);
    list.for_changed(version_, [&](const EditList::Changed& what) {
      if (what.edit != 0) apply(list, what.edit, finder);
      if (what.edit == 0) set_cost(finder, what.area, list.area_costs[what.area]);
    });
    version_ = list.version();
  }

 private:
  // Also one that is not active: of areas that overlap the last one counts.
  template <class Finder>
  void add(const EditList::Edit& edit, Finder& finder) {
    const ChangeId id = edit.removed || !is_wanted(edit) ? 0 : id_of_new(edit, finder);
    if (id != 0 && !edit.active) finder.set_active(id, false);
    ids_.push_back(id);
  }

  template <class Finder>
  void apply(const EditList& list, EditId id, Finder& finder) {
    const EditList::Edit& edit = list.edits[id - 1];
    ChangeId& own = ids_[id - 1];
    if (own == 0) return;
    if (!edit.removed) {
      finder.set_active(own, edit.active);
      return;
    }
    finder.remove(own);
    own = 0;
  }

  [[nodiscard]] bool is_wanted(const EditList::Edit& edit) const {
    return which_ == Which::kAll || edit.kind == EditList::Kind::kArea ||
           (which_ == Which::kAreasAndLinks && edit.kind == EditList::Kind::kOffMeshLink);
  }

  // 0: the finder does not know edits of this kind, or cannot use this one.
  template <class Finder>
  static ChangeId id_of_new(const EditList::Edit& edit, Finder& finder) {
    if (edit.kind == EditList::Kind::kObstacle) return finder.add_obstacle(edit.solid);
    if constexpr (requires { finder.set_area_cost(uint8_t{1}, 1.0); }) {
      const auto added = edit.kind == EditList::Kind::kArea
                             ? finder.add_area(edit.solid.prism, edit.area)
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
  std::vector<ChangeId> ids_;  // of the finder, by id of the edit - 1; 0: none
  uint64_t version_ = 0;
};

}  // namespace throng::path
