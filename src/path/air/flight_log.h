// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "path/air/flight_space.h"
#include "path/ground/search.h"
#include "path/ground/slice.h"
#include "throng/path.h"

/// Queries in parts through the air.
namespace throng::path {

/// What a query has found so far. A query in parts runs from its beginning in each part and takes
/// from the log what parts before have found, so each search and each look-up is done once. What a
/// query asks for, and in which order, depends only on what the log gave it. So the searches of a
/// query that flies, lands, walks and takes off again need no state beside their own. Owns its
/// memory; no allocation once it has grown.
class FlightLog {
 public:
  /// A search or a look-up; which fields are set depends on what it is.
  struct Entry {
    bool is_begun = false, is_done = false;
    Path walk;
    std::vector<AirPoint> flight;  // pulled taut
    SearchResult result = SearchResult::kNone;
    uint64_t nodes = 0;
    Place place;
    std::optional<AirPoint> point;
    bool budget_exhausted = false;
    std::vector<uint32_t> components;
  };

  /// A query begins.
  void begin() { used_ = 0; }
  /// A part of it begins; the slice outlives the part.
  void begin_part(Slice& slice) {
    slice_ = &slice;
    next_ = 0;
    is_pending_ = false;
  }
  /// Of what the part asks for next.
  Entry& next() {
    if (next_ == entries_.size()) entries_.emplace_back();
    Entry& entry = entries_[next_];
    if (next_++ == used_) {
      ++used_;
      entry.is_begun = entry.is_done = false;
    }
    return entry;
  }
  /// The same for what is done in one go: calls make(entry) if that is still to be done.
  template <class Make>
  Entry& next(Make make) {
    Entry& entry = next();
    if (!entry.is_done) make(entry);
    entry.is_done = true;
    return entry;
  }

  [[nodiscard]] Slice& slice() { return *slice_; }
  /// The slice was spent before a search had ended. What the part returns is of no use.
  void set_pending() { is_pending_ = true; }
  [[nodiscard]] bool is_pending() const { return is_pending_; }

 private:
  std::deque<Entry> entries_;  // references stay as it grows
  size_t used_ = 0;            // by the query
  size_t next_ = 0;            // in the part
  bool is_pending_ = false;
  Slice* slice_ = nullptr;
};

}  // namespace throng::path
