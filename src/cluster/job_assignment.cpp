// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "cluster/job_assignment.h"

#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <deque>
#include <mutex>
#include <new>
#include <optional>
#include <thread>

#include "core/parallel.h"
#include "throng/bake.h"

// Rank 0 assigns jobs and enters their results, so that the next bake can continue where a rank has
// died. It works too, on a thread beside the one that listens. All of them poll: MPI waits by
// spinning, which would take a core from those that work.
namespace throng::cluster {
namespace {

enum Tag : int32_t {
  kFree,   // a rank wants work; empty
  kDone,   // uint64_t: the job, and its result
  kFail,   // the code of an error as a byte, and its message
  kWork,   // uint64_t: the job, and its description
  kNoMore  // nothing is left, or the bake has failed elsewhere; empty
};

struct Numbered {
  uint64_t job = 0;
  RankBytes bytes;
};

void nap() { std::this_thread::sleep_for(std::chrono::microseconds(300)); }

RankBytes packed(const Error& error) {
  const std::string text = static_cast<char>(error.code) + error.message;
  return {text.begin(), text.end()};
}

Error unpacked(const RankMessage& message) {
  if (message.bytes.empty()) return {Errc::kIo, "an error without a name"};
  return {static_cast<Errc>(message.bytes[0]),
          "rank " + std::to_string(message.from) + ": " +
              std::string(message.bytes.begin() + 1, message.bytes.end())};
}

RankBytes packed(uint64_t job, std::span<const uint8_t> rest) {
  RankBytes bytes(sizeof job + rest.size());
  std::memcpy(bytes.data(), &job, sizeof job);
  std::copy(rest.begin(), rest.end(), bytes.begin() + sizeof job);
  return bytes;
}

Numbered numbered(const RankMessage& message) {
  constexpr size_t kNumber = sizeof(uint64_t);
  Numbered found{value_of<uint64_t>(message.bytes), {}};
  if (message.bytes.size() > kNumber) {
    found.bytes.assign(message.bytes.begin() + kNumber, message.bytes.end());
  }
  return found;
}

// What does not fit in memory is an error like any other: ranks would wait for ever for one that
// has only stopped.
Result<RankBytes> work_on(const RankJobs& what, std::span<const uint8_t> job,
                          Context& context) try {
  return what.work(job, context);
} catch (const std::bad_alloc&) {
  return Error{Errc::kLimit, std::string(what.stage) +
                                 ": out of memory; use smaller zones or fewer ranks a machine"};
}

class JobAssigner {
 public:
  JobAssigner(Ranks& ranks, const RankJobs& what, JobsToAssign to_assign, Context& context)
      : ranks_(ranks), what_(what), jobs_(std::move(to_assign)), context_(context) {}

  Result<void> run();

 private:
  void work_alongside();
  std::optional<uint64_t> next_job();
  void enter(const Numbered& done);
  void take(const RankMessage& message);
  void fail(Error error);

  Ranks& ranks_;
  const RankJobs& what_;
  JobsToAssign jobs_;
  Context& context_;
  size_t done_ = 0;     // jobs
  int32_t parted_ = 1;  // ranks that take no more jobs: this one never did
  std::optional<Error> error_;

  std::mutex mutex_;  // of what the working thread shares
  std::deque<uint64_t> queue_;
  std::vector<Numbered> own_;
  std::optional<Error> own_error_;
  Context own_context_;  // cancelled when a job fails elsewhere
};

std::optional<uint64_t> JobAssigner::next_job() {
  const std::lock_guard lock(mutex_);
  if (queue_.empty()) return std::nullopt;
  const uint64_t job = queue_.front();
  queue_.pop_front();
  return job;
}

void JobAssigner::work_alongside() {
  while (!own_context_.cancel) {
    const auto job = next_job();
    if (!job) return;
    auto result = work_on(what_, jobs_.jobs[static_cast<size_t>(*job)], own_context_);
    const std::lock_guard lock(mutex_);
    if (!result) {
      own_error_ = result.error();
      return;
    }
    own_.push_back({*job, *std::move(result)});
  }
}

void JobAssigner::fail(Error error) {
  if (!error_) error_ = std::move(error);
  own_context_.cancel = true;
  const std::lock_guard lock(mutex_);
  queue_.clear();
}

void JobAssigner::enter(const Numbered& done) {
  ++done_;
  if (auto ok = jobs_.enter(static_cast<size_t>(done.job), done.bytes); !ok) fail(ok.error());
}

void JobAssigner::take(const RankMessage& message) {
  if (message.tag == kFail) {
    ++parted_;
    fail(unpacked(message));
    return;
  }
  if (message.tag == kDone) enter(numbered(message));
  if (const auto job = next_job()) {
    ranks_.send(message.from, kWork, packed(*job, jobs_.jobs[static_cast<size_t>(*job)]));
  } else {
    ranks_.send(message.from, kNoMore, {});
    ++parted_;
  }
}

Result<void> JobAssigner::run() {
  for (uint64_t job = 0; job < jobs_.jobs.size(); ++job) queue_.push_back(job);
  SideThread beside([&] { work_alongside(); });
  size_t shown = SIZE_MAX;
  while ((done_ < jobs_.jobs.size() && !error_) || parted_ < ranks_.size()) {
    if (context_.cancel) {
      own_context_.cancel = true;
      ranks_.abandon();
      beside.join();  // Its job writes where on_cancel leaves off.
      jobs_.on_cancel();
      return stopped_error(ranks_, what_);
    }
    const auto message = ranks_.poll();
    if (message) take(*message);
    std::vector<Numbered> own;
    std::optional<Error> own_error;
    {
      const std::lock_guard lock(mutex_);
      own.swap(own_);
      own_error.swap(own_error_);
    }
    for (const Numbered& done : own) enter(done);
    if (own_error && own_error->code != Errc::kCancelled) fail(*std::move(own_error));
    if (shown != done_) {
      jobs_.on_progress();
      shown = done_;
    }
    if (!message && own.empty()) nap();
  }
  beside.join();
  if (error_) return *error_;
  return {};
}

}  // namespace

std::string to_be_continued(const std::string& what, const std::string& folder,
                            const std::string& world) {
  return what + " in " + folder + ", and the next bake of " + world + " goes on from there";
}

Error stopped_error(const Ranks& ranks, const RankJobs& what) {
  return {Errc::kCancelled,
          std::string(what.stage) + ": rank " + std::to_string(ranks.rank()) + " of " +
              std::to_string(ranks.size()) +
              " was stopped, because another rank has died or mpirun was interrupted; " +
              what.finished(ranks.rank() == 0)};
}

Result<void> assign_jobs(Ranks& ranks, const RankJobs& what, JobsToAssign to_assign,
                         Context& context) {
  return JobAssigner(ranks, what, std::move(to_assign), context).run();
}

Result<void> do_assigned_jobs(Ranks& ranks, const RankJobs& what, Context& context) {
  ranks.send(0, kFree, {});
  while (true) {
    const auto message = ranks.poll();
    if (context.cancel) {
      ranks.abandon();
      return stopped_error(ranks, what);
    }
    if (!message) {
      nap();
      continue;
    }
    if (message->tag == kNoMore) return {};
    const Numbered job = numbered(*message);
    const auto result = work_on(what, job.bytes, context);
    if (result) {
      ranks.send(0, kDone, packed(job.job, *result));
    } else if (!context.cancel) {
      ranks.send(0, kFail, packed(result.error()));
      return result.error();
    }
  }
}

int32_t workers_of_rank(int32_t asked, const Ranks& ranks) {
  // Unless mpirun has assigned the cores already.
  if (asked > 0) return asked;
  const auto cores = static_cast<int32_t>(sysconf(_SC_NPROCESSORS_ONLN));
  return std::clamp(cores / ranks.local_size(), 1, worker_count(0));
}

Result<void> same_over_ranks(Ranks& ranks, uint64_t input, const char* stage, const char* other) {
  const auto inputs = ranks.gather(input);
  const auto found =
      std::find_if(inputs.begin(), inputs.end(), [&](uint64_t one) { return one != inputs[0]; });
  if (found == inputs.end()) return {};
  return Error{Errc::kBadInput, std::string(stage) + ": rank " +
                                    std::to_string(found - inputs.begin()) + " has " + other +
                                    ", or other options, than rank 0; all ranks must see the same "
                                    "files"};
}

Result<void> meet(Ranks& ranks, const Result<void>& mine, Context& context, RankBytes* shared) {
  constexpr auto kMeetings = Ranks::Channel::kMeetings;
  const RankJobs what{.stage = "bake", .work = {}, .finished = [](bool) {
                        return "what was finished is kept, and the next bake goes on from there";
                      }};
  // Waits without taking a core from those that still work.
  const auto wait = [&]() -> Result<RankMessage> {
    while (true) {
      if (context.cancel) {
        ranks.abandon();
        return stopped_error(ranks, what);
      }
      if (auto message = ranks.poll(kMeetings)) return *std::move(message);
      nap();
    }
  };
  const auto say = [&](int32_t to, const Result<void>& what_is) {
    if (!what_is) {
      ranks.send(to, kFail, packed(what_is.error()), kMeetings);
    } else if (shared != nullptr && ranks.rank() == 0) {
      ranks.send(to, kDone, *shared, kMeetings);
    } else {
      ranks.send(to, kDone, {}, kMeetings);
    }
  };
  if (ranks.rank() != 0) {
    say(0, mine);
    auto verdict = wait();
    if (!verdict) return verdict.error();
    if (verdict->tag == kDone) {
      if (shared != nullptr) *shared = std::move(verdict->bytes);
      return {};
    }
    return Error{Errc::kCancelled, ""};  // Rank 0 says it.
  }
  Result<void> all = mine;
  for (int32_t others = 1; others < ranks.size(); ++others) {
    const auto message = wait();
    if (!message) return message.error();
    if (message->tag == kFail && all) all = unpacked(*message);
  }
  for (int32_t rank = 1; rank < ranks.size(); ++rank) say(rank, all);
  while (!ranks.has_sent_all()) {
    if (context.cancel) {
      ranks.abandon();
      return stopped_error(ranks, what);
    }
    nap();
  }
  return all;
}

Result<void> agree(Ranks& ranks, const Result<void>& mine) {
  const auto all = ranks.gather(mine ? 0 : 1);
  const auto failed = std::find(all.begin(), all.end(), uint64_t{1});
  if (failed == all.end()) return {};
  const auto first = static_cast<int32_t>(failed - all.begin());
  if (ranks.rank() == 0) {
    if (first == 0) return mine;
    while (true) {
      if (const auto message = ranks.poll()) return unpacked(*message);
      nap();
    }
  }
  if (ranks.rank() == first) ranks.send(0, kFail, packed(mine.error()));
  return Error{Errc::kCancelled, ""};  // Rank 0 says it.
}

}  // namespace throng::cluster

namespace throng {

Result<void> meet_over_ranks(const Result<void>& mine, Context& context) {
  if (rank_info().size == 1) return mine;
  auto joined = cluster::Ranks::join();
  if (!joined) return joined.error();
  return cluster::meet(**joined, mine, context);
}

Result<void> agree_over_ranks(const Result<void>& mine) {
  if (rank_info().size == 1) return mine;
  auto joined = cluster::Ranks::join();
  if (!joined) return joined.error();
  return cluster::agree(**joined, mine);
}

}  // namespace throng
