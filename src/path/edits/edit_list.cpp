// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "path/edits/edit_list.h"

#include <algorithm>
#include <memory>
#include <string>
#include <utility>

// The list of edits. It keeps the calls that changed it in order, so that a finder applies only
// what it has not seen, and a crowd makes the same calls. Once these are more than the edits
// themselves the older half is forgotten; what is further behind compares the whole list.
namespace throng {
namespace path {

Solid EditList::Edit::solid() const {
  if (!triangles.empty()) return solid_of(triangles);
  return {*place};
}

void EditList::note(EditId id, Call call) {
  const Edit& edit = edits[id - 1];
  Changed what{.edit = id, .call = call};
  if (edit.is_obstacle()) what.place = edit.place;
  note(std::move(what));
}

void EditList::note(Changed what) {
  constexpr size_t kMinKept = 4096;
  if (changed.size() > 2 * edits.size() + kMinKept) {
    const size_t forgotten = changed.size() / 2;
    changed.erase(changed.begin(), changed.begin() + static_cast<ptrdiff_t>(forgotten));
    first_version += forgotten;
  }
  changed.push_back(std::move(what));
}

void EditList::count(const Edit& edit, int by) {
  if (!edit.bears_on_paths()) return;
  size_t& active = edit.is_obstacle()         ? active_solids
                   : edit.kind == Kind::kArea ? active_areas
                   : is_over_nodes(edit.link) ? active_node_links
                                              : active_links;
  active += static_cast<size_t>(by);
}

EditId EditList::add(Edit edit) {
  count(edit, 1);
  edits.push_back(std::move(edit));
  const auto id = static_cast<EditId>(edits.size());
  note(id, Call::kAdd);
  return id;
}

Result<EditId> EditList::add_obstacle(Result<Solid> solid, ObstacleKind kind,
                                      ObstaclePolicy policy) {
  if (!solid) return solid.error();
  Edit edit;
  edit.obstacle_kind = kind;
  edit.policy = policy;
  edit.place = std::make_shared<const Prism>(prism_around(*solid));
  edit.triangles = std::move(solid->triangles);
  return add(std::move(edit));
}

Result<void> EditList::move_obstacle(EditId id, const Prism& prism) {
  if (auto ok = check_prism(prism); !ok) return ok;
  const Edit* found = find(id);
  if (found == nullptr || !found->is_obstacle()) {
    return Error{Errc::kNotFound, "obstacle: no obstacle has the id " + std::to_string(id)};
  }
  if (!found->triangles.empty()) {
    return Error{Errc::kBadInput, "obstacle: " + std::to_string(id) +
                                      " is of triangles, which cannot be moved; remove it and add "
                                      "it where it is to be"};
  }
  Edit& edit = edits[id - 1];
  edit.place = std::make_shared<const Prism>(prism);
  ++edit.moves;
  note(id, Call::kMove);
  return {};
}

bool EditList::set_active(EditId id, bool active, bool remove) {
  if (find(id) == nullptr) return false;
  Edit& edit = edits[id - 1];
  if (edit.active == active && !remove) return true;
  if (edit.active != active) count(edit, active ? 1 : -1);
  edit.active = active;
  edit.removed = remove;
  if (remove) {
    edit.place = nullptr;
    edit.triangles = {};
  }
  note(id, remove ? Call::kRemove : active ? Call::kSwitchOn : Call::kSwitchOff);
  return true;
}

void EditList::set_area_cost(uint8_t kind, double cost) {
  area_costs[kind] = cost;
  find_costly_kinds();
  note({.area = kind});
}

void EditList::count_all() {
  active_solids = active_areas = active_links = active_node_links = 0;
  for (const Edit& edit : edits) {
    if (edit.active) count(edit, 1);
  }
  find_costly_kinds();
}

void EditList::find_costly_kinds() {
  costly_kinds = 0;
  for (size_t kind = 0; kind < area_costs.size(); ++kind) {
    if (area_costs[kind] != 1) costly_kinds |= uint64_t{1} << kind;
  }
}

}  // namespace path

Edits::Edits() : state_(std::make_shared<path::EditList>()) {}

Result<EditId> Edits::add_obstacle(const Prism& prism, ObstacleKind kind, ObstaclePolicy policy) {
  return state_->add_obstacle(path::make_solid(prism), kind, policy);
}

Result<EditId> Edits::add_obstacle(std::span<const Vec3d> corners,
                                   std::span<const std::array<uint32_t, 3>> triangles,
                                   ObstacleKind kind, ObstaclePolicy policy) {
  return state_->add_obstacle(path::make_solid(corners, triangles), kind, policy);
}

Result<void> Edits::move_obstacle(EditId obstacle, const Prism& prism) {
  return state_->move_obstacle(obstacle, prism);
}

Result<EditId> Edits::add_area(const Prism& prism, uint8_t kind) {
  if (auto ok = path::check_area(kind); !ok) return ok.error();
  if (auto ok = check_prism(prism); !ok) return ok.error();
  path::EditList::Edit edit;
  edit.kind = path::EditList::Kind::kArea;
  edit.area = kind;
  edit.place = std::make_shared<const Prism>(prism);
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
