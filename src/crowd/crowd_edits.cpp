// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <span>

#include "crowd/crowd_state.h"
#include "path/edits/edit_list.h"

// How a crowd follows its edits. Between two steps all avatars stand, so what has been called since
// the last step can be called now, with the same result. The crowd has an obstacle of its own for
// each edit, because finders lead around an obstacle at once, while in the crowd it waits for
// bodies to leave, which only the crowd knows; and crowds that share edits have their own bodies.
namespace throng {

void Crowd::State::follow_edits() {
  using Kind = path::EditList::Kind;
  const path::EditList& list = shared.edits();
  if (edits_version == list.version()) return;
  slot1_of_edit.resize(std::max(slot1_of_edit.size(), list.edits.size()), 0);
  // What was called before the first avatar came would change nothing that is there now.
  const bool is_first = edits_version == 0 && count() == 0;
  const bool by_calls = list.knows_calls_since(edits_version) && !is_first;
  bool areas_changed = false, links_changed = false;
  list.for_changed(edits_version, [&](const path::EditList::Changed& what) {
    const Kind kind = what.edit == 0 ? Kind::kArea : list.edits[what.edit - 1].kind;
    areas_changed = areas_changed || kind == Kind::kArea;
    links_changed = links_changed || kind == Kind::kOffMeshLink;
    if (by_calls && kind == Kind::kObstacle) follow_call(what);
  });
  for (EditId id = 1; !by_calls && id <= list.edits.size(); ++id) follow_state(id);
  edits_version = list.version();
  if (!areas_changed && !links_changed) return;
  // Links change no path of a crowd in which none takes them.
  const std::span<crowd::Body> all = walk.bodies();
  const bool some_change =
      areas_changed || any(std::any_of(all.begin(), all.end(), [&](const crowd::Body& body) {
        return &mode_of(body) == &link;
      }));
  for (crowd::Mode* mode : modes) {
    mode->areas_changed(some_change ? all : std::span<crowd::Body>());
  }
}

void Crowd::State::follow_call(const path::EditList::Changed& call) {
  using Call = path::EditList::Call;
  uint32_t& slot1 = slot1_of_edit[call.edit - 1];
  if (slot1 == 0) {
    // One that was switched off when the crowd first saw it has none, so that it costs nothing.
    const bool comes = call.call == Call::kAdd || call.call == Call::kSwitchOn;
    if (comes && call.place != nullptr) slot1 = add_obstacle(call.edit, *call.place) + 1;
    return;
  }
  if (call.call == Call::kMove && call.place != nullptr) move_obstacle(slot1 - 1, *call.place);
  if (call.call == Call::kSwitchOn) set_obstacle_active(slot1 - 1, true);
  if (call.call == Call::kSwitchOff) set_obstacle_active(slot1 - 1, false);
  if (call.call != Call::kRemove) return;
  remove_obstacle(slot1 - 1);
  slot1 = 0;
}

void Crowd::State::follow_state(EditId id) {
  const path::EditList::Edit& edit = shared.edits().edits[id - 1];
  uint32_t& slot1 = slot1_of_edit[id - 1];
  if (!edit.is_obstacle()) return;
  if (slot1 == 0) {
    if (edit.active) slot1 = add_obstacle(id, *edit.place) + 1;
    return;
  }
  if (edit.removed) {
    remove_obstacle(slot1 - 1);
    slot1 = 0;
    return;
  }
  const crowd::CrowdObstacle& own = shared.obstacles.at(slot1 - 1);
  if (!edit.active && own.wanted_up) set_obstacle_active(slot1 - 1, false);
  const Prism &was = own.wanted, &is = *edit.place;
  if (was.corners != is.corners || was.low != is.low || was.high != is.high) {
    move_obstacle(slot1 - 1, is);
  }
  if (edit.active && !own.wanted_up) set_obstacle_active(slot1 - 1, true);
}

}  // namespace throng
