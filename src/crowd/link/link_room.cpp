// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <cstddef>
#include <cstdint>

#include "crowd/link/link_mode.h"
#include "crowd/walk/step_units.h"

// Avatars that have arrived at an end of an off-mesh link. They would yield to one that passes, but
// not to one that wants to stand where they do: it would lose its turn, and so would the next. So
// they stand aside while others leave the ground or land there, as those that wait do, and go back
// to their goals then. Linear in the users of links and in those that rest near the ends.
namespace throng::crowd {
namespace {

constexpr uint64_t kPlaceChecks = 16;  // sub-steps

}  // namespace

// Only one that has a goal goes back; one that is externally controlled stays where it is.
bool LinkMode::may_give_room(const Body& body) const {
  constexpr uint8_t kAll =
      Body::kArrived | Body::kHasGoal | Body::kExternal | Body::kMovedElsewhere | Body::kNeedsPath;
  return (body.flags & kAll) == (Body::kArrived | Body::kHasGoal) && !body.leaves &&
         uses_[body.slot].state == LinkUse::kNone && !shared_.flies(body.avatar_class) &&
         !shared_.climbs(body.avatar_class);
}

// At one end of the line of another.
void LinkMode::give_room(Body& body, const LinkUse& to, const Stand& at) {
  LinkUse& use = uses_[body.slot];
  const bool is_start = &at == &to.from;
  use = {};
  use.from = at;
  use.to = is_start ? to.to : to.from;
  use.since = shared_.time;
  use.link = to.link;
  use.state = LinkUse::kGivesRoom;
  use.back = to.back;
  stand_aside(body, use);
  came_.push_back(body.slot);
}

// It stands aside, but nearer to an end than its user needs: a wider avatar has come since, or it
// found no place, or does not get there.
void LinkMode::ask_again(Body& body, const Body& user, const Stand& end) {
  LinkUse& use = uses_[body.slot];
  const bool is_due = (shared_.sub_step + body.slot) % kPlaceChecks == 0;
  if (!is_due || use.stands == 0) return;
  if (use.state == LinkUse::kGivesRoom) use.stands = 0;
  if (use.state != LinkUse::kWaits) return;
  // One that waits chose its place for the widest avatar of that time. It keeps it unless it blocks
  // the end (as in end_is_free) and the place, not only where it is now, is too near to a link.
  const Stand place{body.local_target_x, body.local_target_z, body.y, body.level};
  if (!blocks_end(body, user, end) || !is_beside_a_link(body, place)) return;
  stop_standing(body, use);
  stand_aside_again(body, use);
}

// The start is needed by one whose turn it is, the end before it can be its turn.
void LinkMode::ask_for_room(std::span<Body> bodies) {
  for (size_t n = 0; n < users_.size(); ++n) {
    const LinkUse& use = uses_[users_[n]];
    const bool enters = use.state == LinkUse::kEnters;
    if ((!enters && use.state != LinkUse::kWaits) || find_link(use.link) == nullptr) continue;
    const Body& body = bodies[bodies_[n]];
    const auto ask_at = [&](const Stand& at) {
      (void)near_.any_near(at.x, at.z, [&](uint32_t i) {
        Body& other = bodies[i];
        const bool stands_there =
            nearer_than(other.x - at.x, other.z - at.z, room_of(other.radius)) &&
            other.y < at.y + body.height && at.y < other.y + other.height;
        if (!stands_there) return false;
        if (may_give_room(other)) {
          give_room(other, use, at);
        } else {
          ask_again(other, body, at);
        }
        return false;
      });
    };
    if (enters) ask_at(use.from);
    ask_at(use.to);
  }
  for (size_t n = 0; n < users_.size(); ++n) {
    LinkUse& use = uses_[users_[n]];
    const bool is_asked = use.state == LinkUse::kGivesRoom && use.stands == 0;
    if (is_asked) stand_aside_again(bodies[bodies_[n]], use);
  }
}

void LinkMode::stop_giving_room(const Body& body) {
  if (uses_.empty() || uses_[body.slot].state != LinkUse::kGivesRoom) return;
  uses_[body.slot] = {};
}

// Those that gave room go back once none uses the link in that direction.
void LinkMode::end_giving_room(std::span<Body> bodies) {
  for (Link& link : links_) link.is_used = {};
  for (const uint32_t slot : users_) {
    const LinkUse& use = uses_[slot];
    const Link* link = find_link(use.link);
    if (use.state == LinkUse::kNone || use.state == LinkUse::kGivesRoom || link == nullptr)
      continue;
    links_[static_cast<size_t>(link - links_.data())].is_used[use.back != 0 ? 1 : 0] = true;
  }
  for (size_t n = 0; n < users_.size(); ++n) {
    LinkUse& use = uses_[users_[n]];
    if (use.state != LinkUse::kGivesRoom) continue;
    const Link* link = find_link(use.link);
    if (link != nullptr && link->is_used[use.back != 0 ? 1 : 0]) continue;
    use = {};
    Body& body = bodies[bodies_[n]];
    if (body.has(Body::kHasGoal)) body.flags |= Body::kNeedsPath;
    walk_.engine().wake(body);
    body.clear(Body::kContinues);
  }
}

}  // namespace throng::crowd
