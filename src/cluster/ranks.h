// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/rank_group.h"
#include "throng/base.h"

/// What bakes and crowds need of MPI, and the only place that knows it. Calls come from the thread
/// that made the first one.
namespace throng::cluster {

using RankBytes = std::vector<uint8_t>;

struct RankMessage {
  int32_t from = 0;
  int32_t tag = 0;
  std::vector<uint8_t> bytes;
};

class Ranks {
 public:
  /// The ranks of this process, joined at the first call; they part when the program ends. Fails
  /// with kBadConfig if the library was built without MPI.
  static Result<Ranks*> join();

  [[nodiscard]] int32_t rank() const { return rank_; }
  [[nodiscard]] int32_t size() const { return size_; }
  /// Ranks on this machine.
  [[nodiscard]] int32_t local_size() const { return local_size_; }

  /// Of all ranks, by rank. All call it.
  [[nodiscard]] std::vector<uint64_t> gather(uint64_t mine);

  // What ranks that share a crowd need: see RankGroup. They wait for each other.
  [[nodiscard]] std::vector<RankBytes> gather(std::span<const uint8_t> mine);
  [[nodiscard]] std::vector<RankBytes> exchange(std::span<const int32_t> ranks,
                                                std::span<const RankBytes> to);
  /// By recursive bisection. On this rank alone.
  [[nodiscard]] std::vector<int32_t> divide(std::span<const RankGroup::Weight> points) const;

  /// Messages of one channel are not seen on another.
  enum class Channel : uint8_t { kJobs, kMeetings };
  /// Does not wait: a rank that has died takes no message. What is large goes while this rank
  /// polls.
  void send(int32_t to, int32_t tag, std::span<const uint8_t> bytes,
            Channel channel = Channel::kJobs);
  /// Has all that was sent gone?
  [[nodiscard]] bool has_sent_all();
  /// A message if one has come. Does not wait.
  std::optional<RankMessage> poll(Channel channel = Channel::kJobs);

  /// The program ends without parting: others may be dead, and parting waits for them.
  void abandon();

 private:
  int32_t rank_ = 0, size_ = 1, local_size_ = 1;
};

}  // namespace throng::cluster
