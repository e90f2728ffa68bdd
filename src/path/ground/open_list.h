// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

/// The open list of a best-first search (A*, Dijkstra, Theta*): what was reached and is not
/// expanded yet. All searches of src/path use it.
namespace throng::path {

/// Entries leave it in the order of `Later`, a strict weak order that is true if the first of two
/// entries leaves after the second. Order equal costs by a number, too: then the order of leaving
/// does not depend on the heap, and a path is the same on every machine. Push and pop take
/// logarithmic time. An entry whose node was reached at a lower cost since is not removed; the
/// search skips it.
template <class Entry, class Later = std::less<>>
class OpenList {
 public:
  void clear() { entries_.clear(); }
  [[nodiscard]] bool empty() const { return entries_.empty(); }
  [[nodiscard]] size_t size() const { return entries_.size(); }
  /// The entry that leaves next. [not empty]
  [[nodiscard]] const Entry& first() const { return entries_.front(); }

  void push(const Entry& entry) {
    entries_.push_back(entry);
    std::push_heap(entries_.begin(), entries_.end(), Later());
  }
  /// Takes the first entry out. [not empty]
  Entry pop() {
    std::pop_heap(entries_.begin(), entries_.end(), Later());
    const Entry entry = entries_.back();
    entries_.pop_back();
    return entry;
  }
  /// Removes the entries for which keep(entry) is false; calls it once for each. Linear.
  template <class Keep>
  void keep_if(Keep keep) {
    entries_.erase(std::remove_if(entries_.begin(), entries_.end(),
                                  [&](const Entry& entry) { return !keep(entry); }),
                   entries_.end());
    std::make_heap(entries_.begin(), entries_.end(), Later());
  }

  /// What its entries take: a vector holds up to twice what it needs, and the old array beside the
  /// new one as it grows. The same on every machine. [bytes]
  [[nodiscard]] uint64_t used_bytes() const { return 3 * entries_.size() * sizeof(Entry); }
  [[nodiscard]] uint64_t allocated_bytes() const { return entries_.capacity() * sizeof(Entry); }
  /// Frees what was allocated.
  void give_back() { std::vector<Entry>().swap(entries_); }

 private:
  std::vector<Entry> entries_;
};

}  // namespace throng::path
