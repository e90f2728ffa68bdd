// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "throng/crowd.h"

/// What avatars are called, and where their rows are.
namespace throng::crowd {

/// A name is a number that an avatar of the whole crowd has, a slot is where its rows are. They are
/// the same, unless ranks share the crowd: then each rank knows all names, and has slots for the
/// avatars that it moves, and those that it sees in a step. What avatars do may depend on names,
/// never on slots.
class AvatarNames {
 public:
  static constexpr uint32_t kNowhere = UINT32_MAX;
  static constexpr uint32_t kNone = UINT32_MAX - 1;

  /// From now on ranks share the crowd, and all avatars are elsewhere: no slot is taken.
  void share() {
    is_shared_ = true;
    slot_of_.assign(generation_.size(), kNowhere);
    for (const uint32_t name : free_) slot_of_[name] = kNone;
  }
  [[nodiscard]] bool is_shared() const { return is_shared_; }

  /// Names an avatar that is added; on all ranks.
  uint32_t add() {
    if (free_.empty()) {
      generation_.push_back(1);
      if (is_shared_) slot_of_.push_back(kNowhere);
      return static_cast<uint32_t>(generation_.size() - 1);
    }
    const uint32_t name = free_.back();
    free_.pop_back();
    if (is_shared_) slot_of_[name] = kNowhere;
    return name;
  }
  /// It is no more; on all ranks. Its slot was given back.
  void remove(uint32_t name) {
    ++generation_[name];
    free_.push_back(name);
    if (is_shared_) slot_of_[name] = kNone;
  }
  void reserve(size_t names) { generation_.reserve(names); }

  /// A slot for an avatar of this rank.
  uint32_t take_slot(uint32_t name) {
    if (!is_shared_) return name;
    const uint32_t slot = take_passing_slot(name);
    slot_of_[name] = slot;
    return slot;
  }
  /// A slot for one that this rank only sees: slot_of does not find it.
  uint32_t take_passing_slot(uint32_t name) {
    if (free_slots_.empty()) {
      name_of_.push_back(name);
      return static_cast<uint32_t>(name_of_.size() - 1);
    }
    const uint32_t slot = free_slots_.back();
    free_slots_.pop_back();
    name_of_[slot] = name;
    return slot;
  }
  void give_slot_back(uint32_t slot) {
    if (!is_shared_) return;
    if (slot_of_[name_of_[slot]] == slot) slot_of_[name_of_[slot]] = kNowhere;
    free_slots_.push_back(slot);
  }

  [[nodiscard]] uint32_t name_of(uint32_t slot) const { return is_shared_ ? name_of_[slot] : slot; }
  /// By slot. None: they are the slots.
  [[nodiscard]] std::span<const uint32_t> by_slot() const { return name_of_; }
  /// kNowhere: another rank moves it. kNone: none has the name. Unless ranks share the crowd, any
  /// name has a slot.
  [[nodiscard]] uint32_t slot_of(uint32_t name) const { return is_shared_ ? slot_of_[name] : name; }
  [[nodiscard]] uint32_t generation(uint32_t name) const { return generation_[name]; }
  /// Was an id given to the avatar that has its name now, or to the last one that had?
  [[nodiscard]] bool is_known(AvatarId id) const {
    return id && id.slot1 <= generation_.size() && generation_[id.slot1 - 1] == id.generation;
  }
  /// Does this rank or another move it? Of a crowd that ranks share.
  [[nodiscard]] bool is_alive(AvatarId id) const {
    return is_known(id) && slot_of_[id.slot1 - 1] != kNone;
  }
  [[nodiscard]] AvatarId id_of(uint32_t slot) const { return id_of_name(name_of(slot)); }
  [[nodiscard]] AvatarId id_of_name(uint32_t name) const { return {name + 1, generation_[name]}; }

  /// So many names there ever were, and rows of slots.
  [[nodiscard]] size_t names() const { return generation_.size(); }
  [[nodiscard]] size_t slots() const { return is_shared_ ? name_of_.size() : generation_.size(); }
  /// Names that are alive.
  [[nodiscard]] size_t alive() const { return generation_.size() - free_.size(); }
  [[nodiscard]] uint64_t bytes() const {
    return 4 * (generation_.capacity() + free_.capacity() + slot_of_.capacity() +
                name_of_.capacity() + free_slots_.capacity());
  }

  // Of a saved crowd.
  [[nodiscard]] std::vector<uint32_t>& generations() { return generation_; }
  [[nodiscard]] const std::vector<uint32_t>& generations() const { return generation_; }
  [[nodiscard]] std::vector<uint32_t>& free_names() { return free_; }
  [[nodiscard]] const std::vector<uint32_t>& free_names() const { return free_; }

 private:
  bool is_shared_ = false;
  std::vector<uint32_t> generation_;  // by name
  std::vector<uint32_t> free_;        // names
  std::vector<uint32_t> slot_of_;     // by name
  std::vector<uint32_t> name_of_;     // by slot
  std::vector<uint32_t> free_slots_;
};

}  // namespace throng::crowd
