// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "throng/base.h"
#include "throng/math.h"
#include "throng/result.h"

/// Recordings: the positions of all avatars, frame by frame, and the hash of every step. A file
/// format of its own (docs/file_format.md), written during the run: the part that was written opens
/// even if the run was killed.
namespace throng {

/// A direction in the ground plane. Any length.
struct Heading {
  float x = 0, z = 1;
};

inline constexpr size_t kMaxAvatars = size_t{1} << 28;  ///< In one frame, fewer than this.

/// A frame to write, borrowed: avatar i is ids[i], classes[i], ... Fastest in ascending order of
/// id.
struct FrameView {
  double time = 0;                   ///< [s, grows from frame to frame]
  uint64_t step = 0;                 ///< [grows from frame to frame]
  uint64_t state_hash = 0;           ///< Of the whole state, not only of this frame.
  std::span<const uint64_t> ids;     ///< Each once. [< 2^64 - 1]
  std::span<const uint8_t> classes;  ///< Index into RecordingInfo::classes.
  /// Feet; stored to the millimetre. [m, each axis within 2000 km of RecordingInfo::origin]
  std::span<const Vec3d> positions;
  std::span<const float> radii;  ///< Stored to the millimetre. [m, 0 to 65]
  /// Stored to 0.9 degrees; of an avatar that leans: before the lean.
  std::span<const Heading> headings;
  /// Along each body from its feet, stored to 0.06 degrees; empty: all are upright. [any length]
  std::span<const Vec3d> up_vectors = {};
};

/// A frame that was read, owned, in ascending order of id.
struct THRONG_API RecordedFrame {
  double time = 0;
  uint64_t step = 0;
  uint64_t state_hash = 0;
  std::vector<uint64_t> ids;
  std::vector<uint8_t> classes;
  std::vector<Vec3d> positions;
  std::vector<float> radii;
  std::vector<Heading> headings;       ///< Unit vectors.
  std::vector<Vec3d> up_vectors = {};  ///< Unit vectors, empty if RecordingInfo::leans is not set.

  [[nodiscard]] size_t size() const { return ids.size(); }
  void resize(size_t avatars);
  [[nodiscard]] FrameView view() const;
};

/// A class of the recorded avatars.
struct RecordedClass {
  std::string name = "adult";
  double height = 1.75;  ///< [m]
  double radius = 0.25;  ///< [m]
  friend bool operator==(const RecordedClass&, const RecordedClass&) = default;
};

/// The description of a recording's run.
struct RecordingInfo {
  std::string world = {};                   ///< The world: its folder, as the caller named it.
  uint64_t world_hash = 0;                  ///< WorldSummary::hash; 0: unknown.
  double dt = 0.1;                          ///< Length of a step. [s, 1e-6 to 1e6]
  std::vector<RecordedClass> classes = {};  ///< [1 to 256]
  std::string model = {};                   ///< What made the steps: "wanderers" ...
  std::string settings = {};  ///< All settings needed to repeat the run, in the model's own format.
  /// Avatars may lean: frames hold FrameView::up_vectors, and the file has version 2. Otherwise it
  /// has version 1, and a frame in which an avatar leans is refused.
  bool leans = false;
  /// The file stores positions relative to this point; those of frames are absolute all the same.
  /// If it is not zero the file has version 3. [m, whole metres within 1 000 000 km]
  Vec3d origin = {};
};

/// A RecordingInfo::origin from which all of a world can be stored: on each axis 0 if the bounds
/// lie within 1000 km of it, else the whole metre next to their middle. The same on every machine;
/// zero for an empty box.
[[nodiscard]] THRONG_API Vec3d recording_origin(const Box3d& bounds);

/// When a recorder writes. With the defaults at most 32 frames are lost when the process dies.
struct RecorderConfig {
  uint32_t chunk_frames = 32;      ///< Maximum number of frames in a chunk. [1 to 65536]
  uint32_t chunk_bytes = 1 << 18;  ///< A chunk is written once it has this size. [bytes, > 0]
  /// Interval of key frames, which are stored without reference to others. [1 to 65536]
  uint32_t key_frames = 256;
};

/// Writes a recording. Memory: two frames and a chunk. No allocation once the number of avatars,
/// and of those that appear and disappear between frames, no longer grows.
class THRONG_API Recorder {
 public:
  /// Creates the file, in place of one of that name. Fails with kBadConfig or kIo.
  [[nodiscard]] static Result<Recorder> create(const std::string& path, const RecordingInfo& info,
                                               const RecorderConfig& config = {});
  Recorder(Recorder&&) noexcept;
  Recorder& operator=(Recorder&&) noexcept;
  ~Recorder();  ///< Writes the rest, like flush().

  /// Adds a frame, and its hash as that of its step. Fails with kBadInput (an invalid frame:
  /// nothing is added) or kIo.
  [[nodiscard]] Result<void> append(const FrameView& frame);
  /// Adds the hash of a step without a frame. Steps must grow.
  [[nodiscard]] Result<void> append_hash(uint64_t step, uint64_t state_hash);
  /// Passes all frames so far to the operating system: they survive the end of the process, but not
  /// a power failure.
  [[nodiscard]] Result<void> flush();
  /// Marks the file as complete and closes it; nothing can be added afterwards. `outcome`: other
  /// results of the run, in the model's own format. Fails with kIo.
  [[nodiscard]] Result<void> finish(std::string_view outcome = {});
  [[nodiscard]] uint64_t frames() const;
  [[nodiscard]] uint64_t bytes() const;  ///< Written so far.

 private:
  struct State;
  explicit Recorder(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

/// The hash of a step.
struct StepHash {
  uint64_t step = 0;
  uint64_t state_hash = 0;
  friend bool operator==(const StepHash&, const StepHash&) = default;
};

/// The header of a frame.
struct FrameInfo {
  uint64_t step = 0;
  double time = 0;  ///< [s]
  uint32_t avatars = 0;
};

/// Reads a recording. One thread at a time: frames are decoded one after the other.
class THRONG_API Replay {
 public:
  /// Maps the file and reads the headers of its chunks. Reads versions 1 to 3. Fails with kBadFile
  /// if it is no recording, has another version or lacks its settings; a truncated or corrupt file
  /// opens up to the damage.
  [[nodiscard]] static Result<Replay> open(const std::string& path);
  /// The same for bytes in memory, which must outlive it. `name` is used in messages.
  [[nodiscard]] static Result<Replay> from_bytes(std::span<const uint8_t> bytes,
                                                 const std::string& name);
  Replay(Replay&&) noexcept;
  Replay& operator=(Replay&&) noexcept;
  ~Replay();

  [[nodiscard]] const RecordingInfo& info() const;
  /// The `outcome` of Recorder::finish; empty if there was none, or the recording was not finished.
  [[nodiscard]] const std::string& outcome() const;
  [[nodiscard]] uint64_t frame_count() const;
  [[nodiscard]] uint64_t bytes() const;  ///< Of the undamaged part of the file.
  /// Where and why a recording ends too early, as a sentence. Empty if it was finished.
  [[nodiscard]] const std::string& damage() const;
  /// The last frame at or before `time`, or the first one if there is none. There must be a frame.
  /// Fails with kBadFile if its chunk is corrupt.
  [[nodiscard]] Result<uint64_t> find(double time);
  /// Reads frame `index` < frame_count() into `frame`, which keeps its memory. The next frame costs
  /// its own bytes, any other those since the last key frame. Fails with kBadFile, the chunk and
  /// the frames that it held; others can still be read.
  [[nodiscard]] Result<void> read(uint64_t index, RecordedFrame& frame);
  /// All hashes in order of step, of undamaged chunks. Fails with kBadFile like read().
  [[nodiscard]] Result<std::vector<StepHash>> step_hashes();
  /// Step, time and number of avatars of a frame, without decoding it. Fails like read().
  [[nodiscard]] Result<FrameInfo> frame_info(uint64_t index);

 private:
  struct State;
  explicit Replay(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace throng
