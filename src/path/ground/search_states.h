// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>

#include "core/arrays/paged.h"

/// What a search knows of the items that it has reached (corners, boxes, portals, entrances).
namespace throng::path {

/// A state for each item. `State::search` is the number of the search that set it, so a search
/// begins in constant time and finds the states of earlier ones stale. `Array`: a std::vector,
/// which only grows, or a Paged, which holds only the pages that were touched.
template <class State, class Array = Paged<State>>
class SearchStates {
 public:
  /// Begins a search over the items below `count`, none of which is reached.
  void begin(size_t count) {
    grow(count);
    if (++search_ != 0) return;
    states_.clear();  // After 2^32 searches the numbers start over.
    grow(count);
    search_ = 1;
  }
  /// Items are added during a search.
  void grow(size_t count) {
    if constexpr (requires { states_.size(); }) {
      if (count <= states_.size()) return;
    }
    states_.resize(count);
  }
  /// The number of this search, for State::search.
  [[nodiscard]] uint32_t search() const { return search_; }
  /// Was a state set by this search?
  [[nodiscard]] bool is_reached(const State& state) const { return state.search == search_; }

  State& operator[](size_t item) { return states_[item]; }
  const State& operator[](size_t item) const { return states_[item]; }

  /// Of a Paged. [bytes]
  [[nodiscard]] uint64_t allocated_bytes() const { return states_.allocated_bytes(); }
  /// Forgets all states, and frees the pages of a Paged.
  void give_back() { states_.clear(); }

 private:
  uint32_t search_ = 0;
  Array states_;
};

}  // namespace throng::path
