// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstring>
#include <deque>
#include <mutex>
#include <new>
#include <numeric>
#include <optional>
#include <thread>
#include <type_traits>

#include "bake/graph_bake.h"
#include "bake/world_bake.h"
#include "bake/world_folder.h"
#include "cluster/ranks.h"
#include "core/hash.h"
#include "core/parallel.h"
#include "core/stopwatch.h"
#include "throng/cluster.h"

// Rank 0 owns the folder: it takes over what need not be baked, hands out the rest, the largest
// zones first, and enters what comes back into the journal, so that the next bake can go on where a
// rank has died. The others write their zones' files and send what the manifest wants to know of
// them. Rank 0 bakes too, on a thread beside the one that listens. All of them poll: MPI waits by
// spinning, which would take a core from those that bake.
namespace throng {
namespace {

enum Tag : int32_t {
  kFree,   // a rank wants work; empty
  kDone,   // Finished
  kFail,   // the code of an error as a byte, and its message
  kWork,   // uint64_t: the zone to bake
  kNoMore  // nothing is left, or the bake has failed elsewhere; empty
};

struct Finished {
  uint64_t zone = 0;
  ZoneFacts facts;
};
static_assert(std::is_trivially_copyable_v<Finished>);

template <class T>
std::span<const uint8_t> bytes_of(const T& value) {
  return {reinterpret_cast<const uint8_t*>(&value), sizeof value};
}

template <class T>
T value_of(const RankMessage& message) {
  T value{};
  std::memcpy(&value, message.bytes.data(), std::min(sizeof value, message.bytes.size()));
  return value;
}

void nap() { std::this_thread::sleep_for(std::chrono::microseconds(300)); }

// The cores of the machine, shared among its ranks, unless mpirun has dealt them already.
int32_t own_workers(int32_t asked, int32_t local_ranks) {
  if (asked > 0) return asked;
  const auto cores = static_cast<int32_t>(sysconf(_SC_NPROCESSORS_ONLN));
  return std::clamp(cores / local_ranks, 1, worker_count(0));
}

std::vector<uint8_t> packed(const Error& error) {
  const std::string text = static_cast<char>(error.code) + error.message;
  return {text.begin(), text.end()};
}

Error unpacked(const RankMessage& message) {
  if (message.bytes.empty()) return {Errc::kIo, "an error without a name"};
  return {static_cast<Errc>(message.bytes[0]),
          "rank " + std::to_string(message.from) + ": " +
              std::string(message.bytes.begin() + 1, message.bytes.end())};
}

Error told_to_stop(const Ranks& ranks, const std::string& path, const std::string& finished) {
  return {Errc::kCancelled,
          "bake: rank " + std::to_string(ranks.rank()) + " of " + std::to_string(ranks.size()) +
              " was told to stop, because another rank has died or mpirun was interrupted; " +
              finished + " in " + path + ".part, and the next bake of " + path +
              " goes on from there"};
}

// Bakes one zone and writes its file. `scratch` is made for the first. What does not fit in memory
// is an error like any other: ranks would wait for ever for one that has only stopped.
Result<ZoneFacts> bake_and_write(const WorldBake& bake, const std::string& path, size_t zone,
                                 int32_t workers, std::optional<ZoneScratch>& scratch,
                                 Context& context) try {
  if (!scratch) scratch.emplace(workers);
  ZoneFacts facts;
  flatbuffers::DetachedBuffer bytes;
  if (!bake.bake(zone, *scratch, context, facts, bytes)) {
    return Error{Errc::kCancelled, "bake: cancelled"};
  }
  const auto start = Clock::now();
  if (auto ok = WorldFolder::write_zone(path, facts.entry, {bytes.data(), bytes.size()}); !ok) {
    return ok.error();
  }
  facts.seconds_write = seconds_since(start);
  return facts;
} catch (const std::bad_alloc&) {
  return Error{Errc::kLimit, "bake: out of memory; use smaller zones or fewer ranks a machine"};
}

// Rank 0.
class Coordinator {
 public:
  Coordinator(Ranks& ranks, const WorldBake& bake, const std::string& path, WorldFolder& folder,
              Context& context)
      : ranks_(ranks), bake_(bake), path_(path), folder_(folder), context_(context) {}

  // The facts of all zones, in their order.
  Result<std::vector<ZoneFacts>> run(int32_t workers);

 private:
  void keep_what_is_there();
  void bake_beside(int32_t workers);
  std::optional<uint64_t> next_zone();
  void enter(const Finished& finished);
  void take(const RankMessage& message);
  void fail(Error error);

  Ranks& ranks_;
  const WorldBake& bake_;
  const std::string& path_;
  WorldFolder& folder_;
  Context& context_;
  std::vector<ZoneFacts> facts_;
  size_t done_ = 0;     // zones
  int32_t parted_ = 1;  // ranks that ask for nothing any more: this one never did
  std::optional<Error> error_;

  std::mutex mutex_;  // of what the baking thread shares
  std::deque<uint64_t> queue_;
  std::vector<Finished> own_;
  std::optional<Error> own_error_;
  Context own_context_;  // cancelled when the bake fails elsewhere
};

void Coordinator::keep_what_is_there() {
  const auto zones = bake_.zones();
  facts_.resize(zones.size());
  std::vector<uint64_t> open;
  for (size_t i = 0; i < zones.size() && !context_.cancel; ++i) {
    if (const auto kept = folder_.keep(zones[i].x(), zones[i].z(), zones[i].hash())) {
      facts_[i] = bake_.facts_of(*kept);
      ++done_;
    } else {
      open.push_back(i);
    }
  }
  std::stable_sort(open.begin(), open.end(), [&](uint64_t a, uint64_t b) {
    return bake_.triangle_count(a) > bake_.triangle_count(b);
  });
  queue_.assign(open.begin(), open.end());
}

std::optional<uint64_t> Coordinator::next_zone() {
  const std::lock_guard lock(mutex_);
  if (queue_.empty()) return std::nullopt;
  const uint64_t zone = queue_.front();
  queue_.pop_front();
  return zone;
}

void Coordinator::bake_beside(int32_t workers) {
  std::optional<ZoneScratch> scratch;
  while (!own_context_.cancel) {
    const auto zone = next_zone();
    if (!zone) return;
    auto facts = bake_and_write(bake_, path_, *zone, workers, scratch, own_context_);
    const std::lock_guard lock(mutex_);
    if (!facts) {
      own_error_ = facts.error();
      return;
    }
    own_.push_back({*zone, *facts});
  }
}

void Coordinator::fail(Error error) {
  if (!error_) error_ = std::move(error);
  own_context_.cancel = true;
  const std::lock_guard lock(mutex_);
  queue_.clear();
}

void Coordinator::enter(const Finished& finished) {
  const auto zone = static_cast<size_t>(finished.zone);
  facts_[zone] = finished.facts;
  ++done_;
  if (auto ok = folder_.add(finished.facts.entry, bake_.zones()[zone].hash()); !ok) {
    fail(ok.error());
  }
}

void Coordinator::take(const RankMessage& message) {
  if (message.tag == kFail) {
    ++parted_;
    fail(unpacked(message));
    return;
  }
  if (message.tag == kDone) enter(value_of<Finished>(message));
  if (const auto zone = next_zone()) {
    ranks_.send(message.from, kWork, bytes_of(*zone));
  } else {
    ranks_.send(message.from, kNoMore, {});
    ++parted_;
  }
}

Result<std::vector<ZoneFacts>> Coordinator::run(int32_t workers) {
  keep_what_is_there();
  SideThread beside([&] { bake_beside(workers); });
  size_t shown = SIZE_MAX;
  while ((done_ < facts_.size() && !error_) || parted_ < ranks_.size()) {
    if (context_.cancel) {
      own_context_.cancel = true;
      ranks_.abandon();
      folder_.leave();
      return told_to_stop(
          ranks_, path_,
          std::to_string(done_) + " of " + std::to_string(facts_.size()) + " zones are finished");
    }
    const auto message = ranks_.poll();
    if (message) take(*message);
    std::vector<Finished> own;
    std::optional<Error> own_error;
    {
      const std::lock_guard lock(mutex_);
      own.swap(own_);
      own_error.swap(own_error_);
    }
    for (const Finished& finished : own) enter(finished);
    if (own_error && own_error->code != Errc::kCancelled) fail(*std::move(own_error));
    if (shown != done_ && context_.on_progress) {
      context_.on_progress({"bake", done_, facts_.size()});
      shown = done_;
    }
    if (!message && own.empty()) nap();
  }
  beside.join();
  if (error_) return *error_;
  return std::move(facts_);
}

// All others: bake what rank 0 says, until it says no more.
Result<void> work(Ranks& ranks, const WorldBake& bake, const std::string& path, int32_t workers,
                  Context& context) {
  std::optional<ZoneScratch> scratch;
  ranks.send(0, kFree, {});
  while (true) {
    const auto message = ranks.poll();
    if (context.cancel) {
      ranks.abandon();
      return told_to_stop(ranks, path, "finished zones are");
    }
    if (!message) {
      nap();
      continue;
    }
    if (message->tag == kNoMore) return {};
    const auto zone = value_of<uint64_t>(*message);
    const auto facts =
        bake_and_write(bake, path, static_cast<size_t>(zone), workers, scratch, context);
    if (facts) {
      ranks.send(0, kDone, bytes_of(Finished{zone, *facts}));
    } else if (!context.cancel) {
      ranks.send(0, kFail, packed(facts.error()));
      return facts.error();
    }
  }
}

}  // namespace

Result<void> agree_over_ranks(const Result<void>& mine) {
  if (rank_info().size == 1) return mine;
  auto joined = Ranks::join();
  if (!joined) return joined.error();
  Ranks& ranks = **joined;
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
  if (ranks.rank() == first) {
    ranks.send(0, kFail, packed(mine.error()));
  }
  return Error{Errc::kCancelled, ""};  // Rank 0 says it.
}

Result<BakeReport> bake_over_ranks(const std::string& path, const Scene& scene,
                                   const BakeConfig& config, Context& context) {
  if (rank_info().size == 1) return bake_world_to(path, scene, config, context);
  const auto start = Clock::now();
  auto joined = Ranks::join();
  if (!joined) return joined.error();
  Ranks& ranks = **joined;
  if (auto ok = agree_over_ranks(check_bake(scene, config)); !ok) return ok.error();

  BakeConfig own = config;
  own.workers = own_workers(config.workers, ranks.local_size());
  // The folder first: what is there decides on the grid.
  std::optional<WorldFolder> folder;
  Result<void> begun;
  if (ranks.rank() == 0) {
    auto opened = WorldFolder::begin(path, config.old_zones);
    if (opened) {
      folder.emplace(*std::move(opened));
    } else {
      begun = opened.error();
    }
  }
  if (auto ok = agree_over_ranks(begun); !ok) return ok.error();
  std::shared_ptr<WorldData> read;
  if (!folder && config.old_zones == OldZones::kKeep) read = WorldFolder::read_world(path);
  const WorldData* old = folder ? folder->old_world() : read.get();
  const auto bake = WorldBake::begin(scene, own, old, true);
  Result<void> planned;
  if (!bake) planned = bake.error();
  if (auto ok = agree_over_ranks(planned); !ok) return ok.error();
  const auto inputs = ranks.gather(bake->input_hash());
  const auto other = std::find_if(inputs.begin(), inputs.end(),
                                  [&](uint64_t input) { return input != inputs[0]; });
  if (other != inputs.end()) {
    return Error{Errc::kBadInput, "bake: rank " + std::to_string(other - inputs.begin()) +
                                      " has read another scene, or other options, than rank 0; "
                                      "all ranks must see the same files"};
  }

  BakeReport report;
  if (ranks.rank() != 0) {
    if (auto ok = work(ranks, *bake, path, own.workers, context); !ok) return ok.error();
  } else {
    const auto facts = Coordinator(ranks, *bake, path, *folder, context).run(own.workers);
    if (!facts) return facts.error();
    const auto world = bake->world(*facts, report);
    if (!world) return world.error();
    // By this rank alone, on its own threads: the others have parted.
    const auto failed = [&](const Error& error, const char* finished) {
      if (error.code != Errc::kCancelled) return error;
      ranks.abandon();
      folder->leave();
      return told_to_stop(ranks, path, finished);
    };
    if (auto ok = bake->add_air(&*folder, **world, context, report); !ok) {
      return failed(ok.error(), "all zones' ground and some of their air are finished");
    }
    const auto graph = bake_graph(*folder, **world, own.workers, context, report);
    if (!graph) {
      return failed(graph.error(), "all zones and some of their regions and links are finished");
    }
    if (auto ok = folder->finish(**world, **graph, config.carry_nodes); !ok) return ok.error();
    report.seconds_total = seconds_since(start);
  }
  return report;
}

}  // namespace throng
