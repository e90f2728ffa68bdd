// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "core/hash.h"
#include "throng/recording.h"

/// The layout of a recording: chunks, each a head of 64 bytes and its contents.
namespace throng::record {

inline constexpr uint32_t kReplayVersion = 1, kReplayVersionThatLeans = 2;
inline constexpr uint32_t kReplayVersionWithOrigin = 3;  // `leans` is a field.
inline constexpr double kFarthestOrigin = 1e9;           // [m]
inline constexpr std::array<char, 4> kChunkMark{'T', 'H', 'R', 'C'};

enum class ChunkKind : uint32_t {
  kRun = 1,        ///< replay.fbs; the first chunk, and only that.
  kFrames = 2,     ///< FrameEntry, StepHash, then the frames' bytes.
  kKeyFrames = 3,  ///< The same; its first frame needs no frame before it.
  kEnd = 4,        ///< The recording is complete: the text of its outcome, or nothing.
};

struct ChunkHead {
  std::array<char, 4> mark = kChunkMark;
  uint32_t kind = 0;
  uint64_t bytes = 0;        ///< After the head; padded with zeros to a multiple of 8.
  uint64_t sum = 0;          ///< XXH3 of these.
  uint64_t first_frame = 0;  ///< Number of its first frame.
  uint32_t frames = 0;
  uint32_t hashes = 0;
  double first_time = 0;  ///< Of its first and last frame. [s]
  double last_time = 0;
  uint64_t head_sum = 0;  ///< XXH3 of the 56 bytes before.

  [[nodiscard]] uint64_t own_sum() const { return hash_bytes(this, offsetof(ChunkHead, head_sum)); }
};
static_assert(sizeof(ChunkHead) == 64);

struct FrameEntry {
  uint64_t step = 0;
  double time = 0;
  uint32_t avatars = 0;
  uint32_t bytes = 0;
};
static_assert(sizeof(FrameEntry) == 24 && sizeof(StepHash) == 16);

}  // namespace throng::record
