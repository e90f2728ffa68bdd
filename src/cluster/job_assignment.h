// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <functional>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "cluster/ranks.h"
#include "throng/base.h"

/// Jobs handed out one by one to whichever rank is free.
namespace throng::cluster {

/// What all ranks were started for.
struct RankJobs {
  const char* stage = "";  ///< As progress and errors name it.
  /// Does a job, given by rank 0's description of it, and returns the result for rank 0. On any
  /// rank, one call at a time.
  std::function<Result<RankBytes>(std::span<const uint8_t> job, Context& context)> work;
  /// What is finished, and that the next bake continues from there, as a part of a sentence.
  std::function<std::string(bool is_rank_0)> finished;
};

/// What rank 0 has to assign, in this order, and what it does with the results, on its own thread.
struct JobsToAssign {
  std::vector<RankBytes> jobs;
  std::function<Result<void>(size_t job, std::span<const uint8_t> result)> enter;
  std::function<void()> on_progress;  ///< After one or more were entered.
  std::function<void()> on_cancel;
};

/// Rank 0: assigns all jobs, does some itself, and waits for the others. Fails with the first error
/// of any rank, or with kCancelled; no job is begun after that.
Result<void> assign_jobs(Ranks& ranks, const RankJobs& what, JobsToAssign to_assign,
                         Context& context);

/// The others: does the jobs of rank 0 until there are no more. Fails with its own error, which
/// rank 0 knows then, or with kCancelled.
Result<void> do_assigned_jobs(Ranks& ranks, const RankJobs& what, Context& context);

/// Fails with kBadInput on every rank if a rank has another input than rank 0: it "has <read
/// another scene>, or other options".
Result<void> same_over_ranks(Ranks& ranks, uint64_t input, const char* stage, const char* other);

/// meet_over_ranks, for several ranks. `shared`, if it is not null: rank 0's, which all have then.
Result<void> meet(Ranks& ranks, const Result<void>& mine, Context& context,
                  RankBytes* shared = nullptr);
/// agree_over_ranks, for several ranks.
Result<void> agree(Ranks& ranks, const Result<void>& mine);

/// Threads of a rank: the cores of its machine, shared among its ranks, unless a number is given.
int32_t workers_of_rank(int32_t asked, const Ranks& ranks);

/// What RankJobs::finished says: what is finished, in which folder, of the bake of which world.
[[nodiscard]] std::string to_be_continued(const std::string& what, const std::string& folder,
                                          const std::string& world);

/// The error of a rank whose context is cancelled.
Error stopped_error(const Ranks& ranks, const RankJobs& what);

/// A value as the bytes of a message, and back.
template <class T>
RankBytes bytes_of(const T& value) {
  static_assert(std::is_trivially_copyable_v<T>);
  RankBytes bytes(sizeof value);
  std::memcpy(bytes.data(), &value, sizeof value);
  return bytes;
}
template <class T>
RankBytes bytes_of(const std::vector<T>& values) {
  static_assert(std::is_trivially_copyable_v<T>);
  RankBytes bytes(values.size() * sizeof(T));
  if (!bytes.empty()) std::memcpy(bytes.data(), values.data(), bytes.size());
  return bytes;
}
template <class T>
T value_of(std::span<const uint8_t> bytes) {
  static_assert(std::is_trivially_copyable_v<T>);
  T value{};
  std::memcpy(&value, bytes.data(), std::min(sizeof value, bytes.size()));
  return value;
}
template <class T>
std::vector<T> values_of(std::span<const uint8_t> bytes) {
  static_assert(std::is_trivially_copyable_v<T>);
  std::vector<T> values(bytes.size() / sizeof(T));
  if (!values.empty()) std::memcpy(values.data(), bytes.data(), values.size() * sizeof(T));
  return values;
}

}  // namespace throng::cluster
