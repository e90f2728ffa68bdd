// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "cluster/ranks.h"

// The library without MPI.
namespace throng::cluster {

Result<Ranks*> Ranks::join() {
  return Error{Errc::kBadConfig,
               "started by mpirun as several processes, but throng was built without MPI; install "
               "libopenmpi-dev and build it again, or start one process"};
}

std::vector<uint64_t> Ranks::gather(uint64_t mine) { return {mine}; }
std::vector<RankBytes> Ranks::gather(std::span<const uint8_t> mine) {
  return {RankBytes(mine.begin(), mine.end())};
}
std::vector<RankBytes> Ranks::exchange(std::span<const int32_t> /*ranks*/,
                                       std::span<const RankBytes> /*to*/) {
  return {};
}
std::vector<int32_t> Ranks::divide(std::span<const RankGroup::Weight> points) const {
  return std::vector<int32_t>(points.size(), 0);
}
void Ranks::send(int32_t /*to*/, int32_t /*tag*/, std::span<const uint8_t> /*bytes*/,
                 Channel /*channel*/) {}
bool Ranks::has_sent_all() { return true; }

std::optional<RankMessage> Ranks::poll(Channel) { return std::nullopt; }
void Ranks::abandon() {}

}  // namespace throng::cluster
