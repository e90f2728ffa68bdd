// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <utility>
#include <vector>

/// What waits to enter a crowd, in a line for each origin (a source, a link).
namespace throng::scenario {

/// A step tries in rounds to let in what is due, in the order of the calls of push. An origin where
/// many were tried in a round and hardly one got in is full: its others are not tried until the
/// next step. So a step costs time by those that get in, not by those that wait.
template <class Entry>
class EntryQueue {
 public:
  /// An origin is full if in a round at least kMinTries were tried, and for each that got in more
  /// than kTriesByEntry.
  static constexpr size_t kMinTries = 256, kTriesByEntry = 64;

  void resize(size_t origins) { lines_.resize(origins); }
  /// `due`: not before that of the last one of the origin. [s]
  void push(size_t origin, double due, Entry entry) {
    lines_[origin].items.push_back({pushed_++, due, false, std::move(entry)});
    ++size_;
  }
  [[nodiscard]] size_t size() const { return size_; }
  [[nodiscard]] bool empty() const { return size_ == 0; }

  /// From now on all that are due by `time` are tried. [s]
  void begin_step(double time) {
    time_ = time;
    for (Line& line : lines_) line.is_full = false;
  }
  /// All of origins that are not full are tried again.
  void begin_round() {
    for (Line& line : lines_) line.next = line.tried = line.entered = 0;
  }
  /// The next `max_count` to be tried, or all that are left; none: the round is over. They stay
  /// where they are until settle(), which must follow. Time: linear in them and the origins.
  [[nodiscard]] std::vector<Entry*> next(size_t max_count) {
    taken_.clear();
    const auto is_tried = [&](const Line& line) {
      return !line.is_full && line.next < line.items.size() && line.items[line.next].due <= time_;
    };
    merge(lines_, is_tried, [&](Line& line, size_t n) {
      taken_.emplace_back(n, line.next++);
      return taken_.size() < max_count;
    });
    std::vector<Entry*> entries;
    entries.reserve(taken_.size());
    for (const auto& [n, index] : taken_) entries.push_back(&lines_[n].items[index].entry);
    return entries;
  }
  /// Takes out those of the last next() that got in: `entered[k]` for the k-th.
  void settle(const std::vector<bool>& entered) {
    for (size_t k = 0; k < taken_.size(); ++k) {
      Line& line = lines_[taken_[k].first];
      ++line.tried;
      if (!entered[k]) continue;
      ++line.entered;
      ++line.leaving;
      --size_;
      line.items[taken_[k].second].has_entered = true;
    }
    taken_.clear();
    for (Line& line : lines_) {
      line.remove_entered();
      line.is_full =
          line.is_full || (line.tried >= kMinTries && line.entered * kTriesByEntry < line.tried);
    }
  }

  /// Calls visit(entry) for all, in the order of the calls of push.
  template <class Visit>
  void for_each(Visit visit) const {
    std::vector<View> views;
    for (const Line& line : lines_) views.push_back({line.items, 0});
    merge(
        views, [](const View& view) { return view.next < view.items.size(); },
        [&](View& view, size_t) {
          visit(view.items[view.next++].entry);
          return true;
        });
  }

 private:
  struct Item {
    uint64_t order = 0;
    double due = 0;  // [s]
    bool has_entered = false;
    Entry entry;
  };
  struct Line {
    std::deque<Item> items;
    size_t next = 0;                // that is tried in this round
    size_t tried = 0, entered = 0;  // in this round
    size_t leaving = 0;             // that have entered, and are still in `items`
    bool is_full = false;

    // Linear in those that were tried in this round: the others of these move up.
    void remove_entered() {
      if (leaving == 0) return;
      size_t to = next;  // behind the next place
      for (size_t from = next; from-- > 0;) {
        if (!items[from].has_entered && --to != from) items[to] = std::move(items[from]);
      }
      items.erase(items.begin(), items.begin() + static_cast<std::ptrdiff_t>(leaving));
      next -= leaving;
      leaving = 0;
    }
  };
  struct View {
    const std::deque<Item>& items;
    size_t next = 0;
  };

  // Calls take(line, number) for the line whose next item was pushed first, which must go on to the
  // one after it, until no line has_next or it returns false.
  template <class Lines, class HasNext, class Take>
  static void merge(Lines& lines, HasNext has_next, Take take) {
    std::vector<std::pair<uint64_t, size_t>> heap;  // order of the next, line
    const auto add = [&](size_t n) {
      if (!has_next(lines[n])) return;
      heap.emplace_back(lines[n].items[lines[n].next].order, n);
      std::push_heap(heap.begin(), heap.end(), std::greater<>());
    };
    for (size_t n = 0; n < lines.size(); ++n) add(n);
    while (!heap.empty()) {
      std::pop_heap(heap.begin(), heap.end(), std::greater<>());
      const size_t n = heap.back().second;
      heap.pop_back();
      if (!take(lines[n], n)) return;
      add(n);
    }
  }

  std::vector<Line> lines_;
  std::vector<std::pair<size_t, size_t>> taken_;  // line, index: by the last next()
  uint64_t pushed_ = 0;
  size_t size_ = 0;
  double time_ = 0;  // [s]
};

}  // namespace throng::scenario
