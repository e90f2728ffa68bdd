// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <type_traits>

#include "crowd/ground/body.h"
#include "throng/path.h"

/// What an avatar that uses an off-mesh link has beside its Body, by slot.
namespace throng::crowd {

struct LinkUse {
  enum State : uint8_t {
    kNone,
    kWaits,      // near the start, until it is its turn
    kEnters,     // it is its turn: it walks to the start
    kRides,      // it is on the link: Body::on_link
    kGivesRoom,  // it rests at an end of a link and stands aside while others use that
  };

  /// The ends of its line: where it left the ground, before that the link's start; and the far end.
  /// While it gives room: the end at which it does, and the other.
  Stand from, to;
  double along = 0;    // of the line [m]
  uint64_t since = 0;  // it waits, or it is its turn [SharedState::time]
  float factor = 1;    // of its speed, on the link
  EditId link = 0;
  uint8_t state = kNone;
  uint8_t back = 0;     // it goes from the link's `to` to its `from`
  uint8_t stands = 0;   // while it waits or gives room: it has been given a place to stand at
  uint8_t arrived = 0;  // it had Body::kArrived before that
  uint8_t reserved[4] = {};
};
static_assert(sizeof(LinkUse) == 64 && std::is_trivially_copyable_v<LinkUse>);

}  // namespace throng::crowd
