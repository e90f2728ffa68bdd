// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <mpi.h>

#include <cstdlib>
#include <list>
#include <vector>

#include "cluster/ranks.h"

// Messages between ranks over MPI. MPI is started once in a process and ended at its exit.
namespace throng::cluster {
namespace {

bool g_abandoned = false;

struct Sent {
  MPI_Request request = MPI_REQUEST_NULL;
  std::vector<uint8_t> bytes;
};
std::list<Sent> g_sent;  // not yet gone

void forget_those_gone() {
  std::erase_if(g_sent, [](Sent& sent) {
    int done = 0;
    MPI_Test(&sent.request, &done, MPI_STATUS_IGNORE);
    return done != 0;
  });
}

// MPI is begun once in a process. What has begun it ends it.
MPI_Comm g_meetings = MPI_COMM_NULL;

MPI_Comm comm_of(Ranks::Channel channel) {
  return channel == Ranks::Channel::kJobs ? MPI_COMM_WORLD : g_meetings;
}

void part() {
  int over = 0;
  MPI_Finalized(&over);
  if (over != 0 || g_abandoned) return;
  for (Sent& sent : g_sent) MPI_Wait(&sent.request, MPI_STATUS_IGNORE);
  MPI_Finalize();
}

}  // namespace

Result<Ranks*> Ranks::join() {
  static Ranks ranks;
  static bool joined = false;
  int begun = 0, over = 0;
  MPI_Finalized(&over);
  if (over != 0) return Error{Errc::kBadConfig, "MPI was ended before the bake began"};
  if (joined) return &ranks;
  joined = true;
  MPI_Initialized(&begun);
  if (begun == 0) {
    // The thread that bakes on rank 0 leaves MPI alone.
    int provided = 0;
    MPI_Init_thread(nullptr, nullptr, MPI_THREAD_FUNNELED, &provided);
    std::atexit(part);
  }
  MPI_Comm_rank(MPI_COMM_WORLD, &ranks.rank_);
  MPI_Comm_size(MPI_COMM_WORLD, &ranks.size_);
  MPI_Comm local;
  MPI_Comm_split_type(MPI_COMM_WORLD, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &local);
  MPI_Comm_size(local, &ranks.local_size_);
  MPI_Comm_free(&local);
  MPI_Comm_dup(MPI_COMM_WORLD, &g_meetings);
  return &ranks;
}

std::vector<uint64_t> Ranks::gather(uint64_t mine) {
  std::vector<uint64_t> all(static_cast<size_t>(size_));
  MPI_Allgather(&mine, 1, MPI_UINT64_T, all.data(), 1, MPI_UINT64_T, MPI_COMM_WORLD);
  return all;
}

void Ranks::send(int32_t to, int32_t tag, std::span<const uint8_t> bytes, Channel channel) {
  Sent& sent = g_sent.emplace_back();
  sent.bytes.assign(bytes.begin(), bytes.end());
  MPI_Isend(sent.bytes.data(), static_cast<int>(bytes.size()), MPI_BYTE, to, tag, comm_of(channel),
            &sent.request);
  forget_those_gone();
}

bool Ranks::has_sent_all() {
  forget_those_gone();
  return g_sent.empty();
}

std::optional<RankMessage> Ranks::poll(Channel channel) {
  forget_those_gone();
  const MPI_Comm comm = comm_of(channel);
  int found = 0;
  MPI_Status status;
  MPI_Iprobe(MPI_ANY_SOURCE, MPI_ANY_TAG, comm, &found, &status);
  if (found == 0) return std::nullopt;
  int count = 0;
  MPI_Get_count(&status, MPI_BYTE, &count);
  RankMessage message{.from = status.MPI_SOURCE, .tag = status.MPI_TAG, .bytes = {}};
  message.bytes.resize(static_cast<size_t>(count));
  MPI_Recv(message.bytes.data(), count, MPI_BYTE, message.from, message.tag, comm,
           MPI_STATUS_IGNORE);
  return message;
}

void Ranks::abandon() { g_abandoned = true; }

}  // namespace throng::cluster
