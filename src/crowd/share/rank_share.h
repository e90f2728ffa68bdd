// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "core/arrays/value_bytes.h"
#include "core/rank_group.h"
#include "crowd/ground/body.h"
#include "crowd/share/column_owners.h"

/// What a crowd knows of the ranks that share it. docs/design/019-ranks.md.
namespace throng::crowd {

class RankShare {
 public:
  /// Of a world of so many cells. The group stays as long as this.
  RankShare(RankGroup& group, int32_t width, int32_t depth);

  [[nodiscard]] bool is_own(const Body& body) const {
    return owners_.owner_at(body.x, body.z) == group_.rank();
  }
  [[nodiscard]] int32_t rank() const { return group_.rank(); }
  [[nodiscard]] int32_t size() const { return group_.size(); }
  [[nodiscard]] const ColumnOwners& owners() const { return owners_; }
  /// Bodies that far off matter to each other. [units]
  void set_reach(int32_t reach) { owners_.set_reach(reach); }

  // All ranks call these alike.

  /// What all have, by rank. Stays until the next call.
  [[nodiscard]] std::span<const RankGroup::Bytes> gather_bytes(std::span<const uint8_t> mine);
  /// The same as values, one after the other.
  template <class T>
  [[nodiscard]] std::vector<T> gather(std::span<const T> mine) {
    std::vector<T> all;
    for (const RankGroup::Bytes& bytes : gather_bytes(bytes_of_span(mine))) {
      append_values(std::span<const uint8_t>(bytes), all);
    }
    return all;
  }
  [[nodiscard]] uint64_t sum(uint64_t mine);
  [[nodiscard]] float largest(float mine);
  /// Is it true on any of them?
  [[nodiscard]] bool any(bool mine) { return sum(mine ? 1 : 0) > 0; }
  /// What one of them has, if one does.
  template <class T>
  [[nodiscard]] std::optional<T> find_on_any(const std::optional<T>& mine) {
    const std::span<const T> own(mine ? &*mine : nullptr, mine ? 1 : 0);
    const std::vector<T> all = gather(own);
    return all.empty() ? std::nullopt : std::optional<T>(all.front());
  }
  /// Sends bytes to each of owners().neighbours(), and returns theirs. Stays until the next call.
  std::span<const RankGroup::Bytes> exchange_bytes(std::span<const RankGroup::Bytes> to);
  /// What neighbours have for this rank, in their order. `to`: for each of owners().neighbours().
  template <class T>
  std::span<const T> exchange(std::span<const std::vector<T>> to, std::vector<T>& from) {
    outgoing_.resize(to.size());
    for (size_t n = 0; n < to.size(); ++n) {
      const auto bytes = bytes_of_span(std::span<const T>(to[n]));
      outgoing_[n].assign(bytes.begin(), bytes.end());
    }
    from.clear();
    for (const RankGroup::Bytes& bytes : exchange_bytes(outgoing_)) {
      append_values(std::span<const uint8_t>(bytes), from);
    }
    return from;
  }
  /// Sends what is for any rank. `to`: by rank.
  template <class T>
  std::vector<T> exchange_with_all(std::span<const std::vector<T>> to) {
    std::vector<int32_t> others;
    outgoing_.clear();
    for (int32_t rank = 0; rank < size(); ++rank) {
      if (rank == this->rank()) continue;
      others.push_back(rank);
      const auto bytes = bytes_of_span(std::span<const T>(to[static_cast<size_t>(rank)]));
      outgoing_.emplace_back(bytes.begin(), bytes.end());
      sent_bytes_ += bytes.size();
    }
    std::vector<T> from;
    for (const RankGroup::Bytes& bytes : group_.exchange(others, outgoing_)) {
      append_values(std::span<const uint8_t>(bytes), from);
    }
    return from;
  }

  /// Assigns the columns to the ranks, by these bodies of this one and those of the others.
  void assign_columns(std::span<const Body> bodies);

  /// By this rank, since they were forgotten. What all gather counts once.
  [[nodiscard]] uint64_t sent_bytes() const { return sent_bytes_; }
  void forget_sent_bytes() { sent_bytes_ = 0; }

 private:
  RankGroup& group_;
  ColumnOwners owners_;
  std::vector<RankGroup::Bytes> outgoing_;
  uint64_t sent_bytes_ = 0;
};

}  // namespace throng::crowd
