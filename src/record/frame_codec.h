// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "throng/recording.h"

/// Frames as bits: differences from the expected positions, headings and axes.
namespace throng::record {

/// A direction: its point on an octahedron that stands on its tip, unfolded into a square; upright
/// is (0, 0). [-kUpSteps to kUpSteps]
using UpCode = std::array<int16_t, 2>;
inline constexpr int32_t kUpSteps = 2047;

/// An avatar after the last frame. Writer and reader hold the same tracks, in order of id.
struct Track {
  uint64_t id = 0;
  std::array<int32_t, 3> at{};     // from the recording's origin [mm]
  std::array<int32_t, 3> by{};     // how far it moved since the frame before [mm]
  std::array<uint16_t, 6> mean{};  // of its last differences, x y z, heading and up, in 1/16
  uint16_t radius = 0;             // [mm]
  uint8_t avatar_class = 0;
  uint8_t heading = 0;  // 256 to a turn
  UpCode up{};
};

/// The nearest of 256 directions, and back. Exact arithmetic: 0.9 degrees off at most.
[[nodiscard]] uint8_t heading_code(Heading heading);
[[nodiscard]] Heading heading_of(uint8_t code);
/// The same of any direction except zero: 0.06 degrees off at most.
[[nodiscard]] UpCode up_code(Vec3d up);
[[nodiscard]] Vec3d up_of(UpCode code);

class FrameEncoder {
 public:
  /// `leans`: frames hold axes. `origin`: tracks are relative to it [whole metres].
  explicit FrameEncoder(bool leans = false, Vec3d origin = {}) : leans_(leans), origin_(origin) {}
  /// The next frame is written without any frame before it.
  void forget() { tracks_.clear(); }
  /// Appends a frame, whole bytes, to `bytes`. Fails with kBadInput and the avatar; then nothing
  /// has changed.
  [[nodiscard]] Result<void> encode(const FrameView& frame, std::vector<uint8_t>& bytes);

 private:
  [[nodiscard]] Result<void> quantise(const FrameView& frame);

  bool leans_ = false;
  Vec3d origin_;
  std::vector<Track> tracks_, wanted_, kept_, next_;
  std::vector<uint32_t> order_, removed_, added_;
};

class FrameDecoder {
 public:
  explicit FrameDecoder(bool leans = false) : leans_(leans) {}
  void forget() { tracks_.clear(); }
  /// Decodes the next frame; false if the bytes are not valid, then call forget().
  [[nodiscard]] bool decode(std::span<const uint8_t> bytes, uint32_t avatars);
  [[nodiscard]] std::span<const Track> tracks() const { return tracks_; }

 private:
  bool leans_ = false;
  std::vector<Track> tracks_, kept_, added_;
};

}  // namespace throng::record
