// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "steer/models.h"
#include "throng/crowd.h"

/// [CAACD]'s Mass, MaxSpeed and MaxForce of single avatars, in place of the crowd's.
namespace throng::crowd {

/// The model of `all` with these values.
inline caacd::Model with_tuning(caacd::Model all, const CurvilinearTuning& tuning) {
  all.mass = tuning.mass;
  all.max_speed = tuning.max_speed;
  all.max_force = tuning.max_force;
  all.order = tuning.by_state ? caacd::Order::kState : caacd::Order::kTime;
  return all;
}

/// What a crowd accepts; written so that a NaN is refused as well.
inline bool is_tuning(const CurvilinearTuning& t) {
  return t.mass >= 0.01 && t.mass <= 1000 && t.max_speed >= 0.01 && t.max_speed <= 100 &&
         t.max_force >= 0.001 && t.max_force <= 1000;
}

class OwnCurves {
 public:
  /// As a crowd saves it.
  struct Saved {
    uint32_t slot = 0, by_state = 0;
    double mass = 0, max_speed = 0, max_force = 0;
  };

  void set(uint32_t slot, const CurvilinearTuning& tuning) {
    if (by_slot_.size() <= slot) by_slot_.resize(slot + size_t{1}, kNone);
    by_slot_[slot] = tuning;
  }
  /// The avatar is gone.
  void forget(uint32_t slot) {
    if (slot < by_slot_.size()) by_slot_[slot] = kNone;
  }
  /// Null: it has the crowd's.
  [[nodiscard]] const CurvilinearTuning* find(uint32_t slot) const {
    return slot < by_slot_.size() && by_slot_[slot].mass > 0 ? &by_slot_[slot] : nullptr;
  }
  [[nodiscard]] caacd::Model model_of(uint32_t slot, const caacd::Model& all) const {
    const CurvilinearTuning* own = find(slot);
    return own != nullptr ? with_tuning(all, *own) : all;
  }
  [[nodiscard]] uint64_t bytes() const { return by_slot_.capacity() * sizeof(CurvilinearTuning); }

  /// In order of slot.
  [[nodiscard]] std::vector<Saved> saved() const {
    std::vector<Saved> rows;
    for (uint32_t slot = 0; slot < by_slot_.size(); ++slot) {
      const CurvilinearTuning& t = by_slot_[slot];
      if (!(t.mass > 0)) continue;
      rows.push_back({slot, t.by_state ? 1U : 0U, t.mass, t.max_speed, t.max_force});
    }
    return rows;
  }
  /// False: a crowd of so many slots could not have saved them.
  bool restore(const std::vector<Saved>& rows, uint64_t slots) {
    by_slot_.clear();
    for (const Saved& row : rows) {
      const CurvilinearTuning tuning{.mass = row.mass,
                                     .max_speed = row.max_speed,
                                     .max_force = row.max_force,
                                     .by_state = row.by_state != 0};
      if (row.slot >= slots || row.slot < by_slot_.size() || row.by_state > 1) return false;
      if (!is_tuning(tuning)) return false;
      set(row.slot, tuning);
    }
    return true;
  }

 private:
  static constexpr CurvilinearTuning kNone = {
      .mass = 0, .max_speed = 0, .max_force = 0, .by_state = false};
  std::vector<CurvilinearTuning> by_slot_;  // mass 0: none
};

}  // namespace throng::crowd
