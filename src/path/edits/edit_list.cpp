// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "path/edits/edit_list.h"

#include <algorithm>
#include <memory>
#include <utility>

// The list of edits. It keeps what has changed in order, so that a finder applies only what it has
// not seen; once that is longer than the list itself it is forgotten, and finders that are behind
// apply all.
namespace throng {
namespace path {

void EditList::note(Changed what) {
  constexpr size_t kMinKept = 4096;
  if (changed.size() > 2 * edits.size() + kMinKept) {
    first_version = version();
    changed.clear();
  }
  changed.push_back(what);
}

void EditList::count(const Edit& edit, int by) {
  size_t& active = edit.kind == Kind::kObstacle ? active_solids
                   : edit.kind == Kind::kArea   ? active_areas
                   : is_over_nodes(edit.link)   ? active_node_links
                                                : active_links;
  active += static_cast<size_t>(by);
}

EditId EditList::add(Edit edit) {
  count(edit, 1);
  edits.push_back(std::move(edit));
  const auto id = static_cast<EditId>(edits.size());
  note({.edit = id});
  return id;
}

Result<EditId> EditList::add_obstacle(Result<Solid> solid) {
  if (!solid) return solid.error();
  Edit edit;
  edit.solid = *std::move(solid);
  return add(std::move(edit));
}

bool EditList::set_active(EditId id, bool active, bool remove) {
  if (id == 0 || id > edits.size() || edits[id - 1].removed) return false;
  Edit& edit = edits[id - 1];
  if (edit.active == active && !remove) return true;
  if (edit.active != active) count(edit, active ? 1 : -1);
  edit.active = active;
  edit.removed = remove;
  if (remove) edit.solid = {};
  note({.edit = id});
  return true;
}

void EditList::set_area_cost(uint8_t kind, double cost) {
  area_costs[kind] = cost;
  costs_differ = std::any_of(area_costs.begin(), area_costs.end(), [](double c) { return c != 1; });
  note({.area = kind});
}

}  // namespace path

Edits::Edits() : state_(std::make_shared<path::EditList>()) {}

Result<EditId> Edits::add_obstacle(const Prism& prism) {
  return state_->add_obstacle(path::make_solid(prism));
}

Result<EditId> Edits::add_obstacle(std::span<const Vec3d> corners,
                                   std::span<const std::array<uint32_t, 3>> triangles) {
  return state_->add_obstacle(path::make_solid(corners, triangles));
}

Result<EditId> Edits::add_area(const Prism& prism, uint8_t kind) {
  if (auto ok = path::check_area(kind); !ok) return ok.error();
  if (auto ok = check_prism(prism); !ok) return ok.error();
  path::EditList::Edit edit;
  edit.kind = path::EditList::Kind::kArea;
  edit.area = kind;
  edit.solid.prism = prism;
  return state_->add(std::move(edit));
}

Result<EditId> Edits::add_off_mesh_link(const OffMeshLink& link) {
  if (auto ok = path::check_link(link); !ok) return ok.error();
  path::EditList::Edit edit;
  edit.kind = path::EditList::Kind::kOffMeshLink;
  edit.link = link;
  return state_->add(std::move(edit));
}

bool Edits::remove(EditId edit) { return state_->set_active(edit, false, true); }
bool Edits::set_active(EditId edit, bool active) { return state_->set_active(edit, active, false); }

Result<void> Edits::set_area_cost(uint8_t kind, double cost) {
  if (auto ok = path::check_area_cost(kind, cost); !ok) return ok.error();
  state_->set_area_cost(kind, cost);
  return {};
}

uint64_t Edits::version() const { return state_->version(); }

}  // namespace throng
