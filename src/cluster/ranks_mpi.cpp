// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <mpi.h>
#include <zoltan.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <list>
#include <string>
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
MPI_Comm g_crowds = MPI_COMM_NULL;

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

// The callbacks through which Zoltan reads points; `data` is a span of them.
using Points = std::span<const RankGroup::Weight>;

int count_points(void* data, int* error) {
  *error = ZOLTAN_OK;
  return static_cast<int>(static_cast<const Points*>(data)->size());
}

void list_points(void* data, int /*of_global*/, int /*of_local*/, ZOLTAN_ID_PTR ids,
                 ZOLTAN_ID_PTR /*local*/, int /*weights*/, float* weights, int* error) {
  const Points& points = *static_cast<const Points*>(data);
  for (size_t n = 0; n < points.size(); ++n) {
    ids[n] = static_cast<ZOLTAN_ID_TYPE>(n);
    weights[n] = points[n].weight;
  }
  *error = ZOLTAN_OK;
}

int count_axes(void* /*data*/, int* error) {
  *error = ZOLTAN_OK;
  return 2;
}

void place_points(void* data, int /*of_global*/, int /*of_local*/, int count, ZOLTAN_ID_PTR ids,
                  ZOLTAN_ID_PTR /*local*/, int /*axes*/, double* at, int* error) {
  const Points& points = *static_cast<const Points*>(data);
  for (int n = 0; n < count; ++n) {
    at[2 * n] = points[ids[n]].x;
    at[2 * n + 1] = points[ids[n]].z;
  }
  *error = ZOLTAN_OK;
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
  MPI_Comm_dup(MPI_COMM_WORLD, &g_crowds);
  return &ranks;
}

std::vector<uint64_t> Ranks::gather(uint64_t mine) {
  std::vector<uint64_t> all(static_cast<size_t>(size_));
  MPI_Allgather(&mine, 1, MPI_UINT64_T, all.data(), 1, MPI_UINT64_T, MPI_COMM_WORLD);
  return all;
}

std::vector<RankBytes> Ranks::gather(std::span<const uint8_t> mine) {
  const auto own = static_cast<int>(mine.size());
  std::vector<int> sizes(static_cast<size_t>(size_)), begins(static_cast<size_t>(size_));
  MPI_Allgather(&own, 1, MPI_INT, sizes.data(), 1, MPI_INT, g_crowds);
  int sum = 0;
  for (size_t rank = 0; rank < sizes.size(); ++rank) {
    begins[rank] = sum;
    sum += sizes[rank];
  }
  RankBytes bytes(static_cast<size_t>(sum));
  MPI_Allgatherv(mine.data(), own, MPI_BYTE, bytes.data(), sizes.data(), begins.data(), MPI_BYTE,
                 g_crowds);
  std::vector<RankBytes> all;
  for (size_t rank = 0; rank < sizes.size(); ++rank) {
    const auto first = bytes.begin() + begins[rank];
    all.emplace_back(first, first + sizes[rank]);
  }
  return all;
}

std::vector<RankBytes> Ranks::exchange(std::span<const int32_t> ranks,
                                       std::span<const RankBytes> to) {
  std::vector<MPI_Request> sent(ranks.size());
  for (size_t n = 0; n < ranks.size(); ++n) {
    MPI_Isend(to[n].data(), static_cast<int>(to[n].size()), MPI_BYTE, ranks[n], 0, g_crowds,
              &sent[n]);
  }
  std::vector<RankBytes> from(ranks.size());
  for (size_t n = 0; n < ranks.size(); ++n) {
    MPI_Message message;
    MPI_Status status;
    MPI_Mprobe(ranks[n], 0, g_crowds, &message, &status);
    int count = 0;
    MPI_Get_count(&status, MPI_BYTE, &count);
    from[n].resize(static_cast<size_t>(count));
    MPI_Mrecv(from[n].data(), count, MPI_BYTE, &message, MPI_STATUS_IGNORE);
  }
  MPI_Waitall(static_cast<int>(sent.size()), sent.data(), MPI_STATUSES_IGNORE);
  return from;
}

// Zoltan on this rank alone: all ranks have all points, and find the same.
std::vector<int32_t> Ranks::divide(std::span<const RankGroup::Weight> points) const {
  std::vector<int32_t> parts(points.size(), 0);
  if (size_ == 1 || points.empty()) return parts;
  static const bool is_ready = [] {
    float version = 0;
    return Zoltan_Initialize(0, nullptr, &version) == ZOLTAN_OK;
  }();
  Zoltan_Struct* zoltan = is_ready ? Zoltan_Create(MPI_COMM_SELF) : nullptr;
  if (zoltan == nullptr) MPI_Abort(MPI_COMM_WORLD, 1);  // (Out of memory.)
  const std::string count = std::to_string(size_);
  const std::array<std::array<const char*, 2>, 7> settings = {{{"DEBUG_LEVEL", "0"},
                                                               {"LB_METHOD", "RCB"},
                                                               {"NUM_GLOBAL_PARTS", count.c_str()},
                                                               {"NUM_GID_ENTRIES", "1"},
                                                               {"NUM_LID_ENTRIES", "0"},
                                                               {"OBJ_WEIGHT_DIM", "1"},
                                                               {"RETURN_LISTS", "PARTS"}}};
  for (const auto& [name, value] : settings) Zoltan_Set_Param(zoltan, name, value);
  Zoltan_Set_Num_Obj_Fn(zoltan, count_points, &points);
  Zoltan_Set_Obj_List_Fn(zoltan, list_points, &points);
  Zoltan_Set_Num_Geom_Fn(zoltan, count_axes, nullptr);
  Zoltan_Set_Geom_Multi_Fn(zoltan, place_points, &points);
  int changes = 0, ids_a_point = 0, locals_a_point = 0, imports = 0, exports = 0;
  ZOLTAN_ID_PTR import_ids = nullptr, import_locals = nullptr, ids = nullptr, locals = nullptr;
  int *import_ranks = nullptr, *import_parts = nullptr, *ranks = nullptr, *to_parts = nullptr;
  const int ok = Zoltan_LB_Partition(zoltan, &changes, &ids_a_point, &locals_a_point, &imports,
                                     &import_ids, &import_locals, &import_ranks, &import_parts,
                                     &exports, &ids, &locals, &ranks, &to_parts);
  if (ok != ZOLTAN_OK && ok != ZOLTAN_WARN) MPI_Abort(MPI_COMM_WORLD, 1);
  for (int n = 0; n < exports; ++n) parts[ids[n]] = to_parts[n];
  Zoltan_LB_Free_Part(&import_ids, &import_locals, &import_ranks, &import_parts);
  Zoltan_LB_Free_Part(&ids, &locals, &ranks, &to_parts);
  Zoltan_Destroy(&zoltan);
  return parts;
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
