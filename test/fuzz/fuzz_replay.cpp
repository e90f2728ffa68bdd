// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <vector>

#include "core/hash.h"
#include "record/replay_file.h"

// Checksums would stop the fuzzer, so they are corrected first: the code behind them must not rely
// on them. A file that opens must be readable in any order without reading past its bytes.
namespace {

void seal(std::vector<uint8_t>& bytes) {
  for (size_t at = 0; at + sizeof(throng::record::ChunkHead) <= bytes.size();) {
    throng::record::ChunkHead head;
    std::memcpy(&head, &bytes[at], sizeof head);
    const size_t left = bytes.size() - at - sizeof head;
    head.mark = throng::record::kChunkMark;
    head.bytes = std::min<uint64_t>(head.bytes, left);
    head.sum = throng::hash_bytes(bytes.data() + at + sizeof head, head.bytes);
    head.head_sum = head.own_sum();
    std::memcpy(&bytes[at], &head, sizeof head);
    at += sizeof head + head.bytes;
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace throng;
  std::vector<uint8_t> bytes(data, data + size);
  for (const bool sealed : {false, true}) {
    if (sealed) seal(bytes);
    // A copy of the exact size, so that the sanitizer detects a read past its end.
    const std::vector<uint8_t> exact(bytes.begin(), bytes.end());
    auto replay = Replay::from_bytes(exact, "fuzz");
    if (!replay) continue;
    RecordedFrame frame;
    const uint64_t frames = replay->frame_count();
    for (uint64_t f = 0; f < std::min<uint64_t>(frames, 60); ++f) {
      (void)replay->read(f, frame);
      (void)replay->read(frames - 1 - f * 7 % frames, frame);
      (void)replay->frame_info(f);
    }
    if (frames > 0) (void)replay->find(0.3);
    (void)replay->step_hashes();
  }
  return 0;
}
