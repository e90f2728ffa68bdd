// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <charconv>
#include <cstdlib>
#include <cstring>

#include "throng/bake.h"

// Rank and number of ranks, from the environment that mpirun sets, without starting MPI.
namespace throng {
namespace {

// A whole number in the environment, or -1.
int32_t number_of(const char* name) {
  const char* text = std::getenv(name);
  int32_t value = -1;
  if (text != nullptr) std::from_chars(text, text + std::strlen(text), value);
  return value;
}

}  // namespace

RankInfo rank_info() {
  struct Names {
    const char *rank, *size;
  };
  // Open MPI; MPICH and its kin.
  for (const Names& names :
       {Names{"OMPI_COMM_WORLD_RANK", "OMPI_COMM_WORLD_SIZE"}, Names{"PMI_RANK", "PMI_SIZE"}}) {
    const RankInfo info{number_of(names.rank), number_of(names.size)};
    if (info.size > 0 && info.rank >= 0 && info.rank < info.size) return info;
  }
  return {};
}

}  // namespace throng
