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

/// Recordings: where everybody was, frame by frame, and the hash of every step. A file of its own
/// kind (docs/file_format.md), written as the run goes on: whatever was written when a run was
/// killed opens.
namespace throng {

/// A direction in the ground plane. Any length.
struct Heading {
  float x = 0, z = 1;
};

inline constexpr size_t kMaxAvatars = size_t{1} << 28;  ///< In one frame, fewer than this.

/// One moment, borrowed: avatar i is ids[i], classes[i], ... Fastest in ascending order of id.
struct FrameView {
  double time = 0;                   ///< [s, grows from frame to frame]
  uint64_t step = 0;                 ///< [grows from frame to frame]
  uint64_t state_hash = 0;           ///< Of the whole state, all of it and not only what is here.
  std::span<const uint64_t> ids;     ///< Each once. [< 2^64 - 1]
  std::span<const uint8_t> classes;  ///< Index into RecordingInfo::classes.
  /// Feet; kept to the millimetre. [m, each axis within 2000 km of RecordingInfo::origin]
  std::span<const Vec3d> positions;
  std::span<const float> radii;       ///< Kept to the millimetre. [m, 0 to 65]
  std::span<const Heading> headings;  ///< Kept to 0.9 degrees; of who leans, before he leans.
  /// Along each body from its feet, kept to 0.06 degrees; nothing: all stand upright. [any length]
  std::span<const Vec3d> up_vectors = {};
};

/// The same, owned: what is read back, in ascending order of id.
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

struct RecordedClass {
  std::string name = "adult";
  double height = 1.75;  ///< [m]
  double radius = 0.25;  ///< [m]
  friend bool operator==(const RecordedClass&, const RecordedClass&) = default;
};

/// What a recording tells about its run.
struct RecordingInfo {
  std::string world = {};   ///< Where it was walked: the folder, as the caller named it.
  uint64_t world_hash = 0;  ///< WorldSummary::hash; 0: not known.
  double dt = 0.1;          ///< Length of a step. [s, 1e-6 to 1e6]
  std::vector<RecordedClass> classes = {};  ///< [1 to 256]
  std::string model = {};                   ///< What made the steps: "wanderers" ...
  std::string settings = {};  ///< All that it takes to run again, as the model writes it.
  /// Some may lean: frames hold FrameView::up_vectors, and the file is of version 2. Else it is of
  /// version 1, as it was before there were any, and a frame in which somebody leans is refused.
  bool leans = false;
  /// What the file stores positions relative to; those of frames are absolute all the same. If it
  /// is not zero the file is of version 3. [m, whole metres within 1 000 000 km]
  Vec3d origin = {};
};

/// An origin from which a recording reaches all of a world, RecordingInfo::origin: on each axis 0
/// if the bounds lie within 1000 km of it, else the whole metre next to their middle. The same on
/// every machine; zero for an empty box.
[[nodiscard]] THRONG_API Vec3d recording_origin(const Box3d& bounds);

/// When a recorder writes. The defaults lose at most 32 frames when the process dies.
struct RecorderConfig {
  uint32_t chunk_frames = 32;      ///< Frames written together at most. [1 to 65536]
  uint32_t chunk_bytes = 1 << 18;  ///< A chunk that has grown to this is written. [bytes, > 0]
  uint32_t key_frames = 256;       ///< After so many frames one stands alone. [1 to 65536]
};

/// Writes a recording. Memory: two frames and a chunk. Nothing is allocated once it has seen as
/// many avatars, come and gone at a time, as there will be.
class THRONG_API Recorder {
 public:
  /// Begins the file; one of that name is replaced. Fails with kBadConfig or kIo.
  [[nodiscard]] static Result<Recorder> create(const std::string& path, const RecordingInfo& info,
                                               const RecorderConfig& config = {});
  Recorder(Recorder&&) noexcept;
  Recorder& operator=(Recorder&&) noexcept;
  ~Recorder();  ///< Writes what is left, like flush().

  /// Adds a frame, and its hash as that of its step. Fails with kBadInput (the frame makes no
  /// sense: nothing was added) or kIo.
  [[nodiscard]] Result<void> append(const FrameView& frame);
  /// Adds the hash of a step that has no frame. Steps grow.
  [[nodiscard]] Result<void> append_hash(uint64_t step, uint64_t state_hash);
  /// Hands all frames so far to the system: they survive the process, not a power cut.
  [[nodiscard]] Result<void> flush();
  /// Marks the file as complete and closes it. Nothing can be added then. `outcome`: what else came
  /// out of the run, as the model writes it. Fails with kIo.
  [[nodiscard]] Result<void> finish(std::string_view outcome = {});
  [[nodiscard]] uint64_t frames() const;
  [[nodiscard]] uint64_t bytes() const;  ///< Written so far.

 private:
  struct State;
  explicit Recorder(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

struct StepHash {
  uint64_t step = 0;
  uint64_t state_hash = 0;
  friend bool operator==(const StepHash&, const StepHash&) = default;
};

struct FrameInfo {
  uint64_t step = 0;
  double time = 0;  ///< [s]
  uint32_t avatars = 0;
};

/// Reads a recording. Not for several threads at a time: frames are undone one after the other.
class THRONG_API Replay {
 public:
  /// Maps the file and walks over its chunks' heads. Reads versions 1 to 3. Fails with kBadFile if
  /// it is no recording, of another version or holds none of its settings; one that ends too early
  /// or is corrupt opens as far as it is good.
  [[nodiscard]] static Result<Replay> open(const std::string& path);
  /// The same for bytes in memory, which must outlive it. `name` stands in sentences.
  [[nodiscard]] static Result<Replay> from_bytes(std::span<const uint8_t> bytes,
                                                 const std::string& name);
  Replay(Replay&&) noexcept;
  Replay& operator=(Replay&&) noexcept;
  ~Replay();

  [[nodiscard]] const RecordingInfo& info() const;
  /// What Recorder::finish was given; empty if that was nothing, or it was not finished.
  [[nodiscard]] const std::string& outcome() const;
  [[nodiscard]] uint64_t frame_count() const;
  [[nodiscard]] uint64_t bytes() const;  ///< Of the good part of the file.
  /// Empty for a recording that was finished, else a sentence: where it ends and why.
  [[nodiscard]] const std::string& damage() const;
  /// The last frame at or before `time`, the first if there is none. Needs a frame at all. Fails
  /// with kBadFile if the chunk that it would be in is corrupt.
  [[nodiscard]] Result<uint64_t> find(double time);
  /// Reads frame `index` < frame_count() into `frame`, which keeps its memory. The next one costs
  /// its own bytes, any other those since the last frame that stands alone. Fails with kBadFile,
  /// the chunk and the frames that it held; others can still be read.
  [[nodiscard]] Result<void> read(uint64_t index, RecordedFrame& frame);
  /// All hashes in order of step, of good chunks. Fails with kBadFile like read().
  [[nodiscard]] Result<std::vector<StepHash>> step_hashes();
  /// What stands beside a frame, without reading it. Fails like read().
  [[nodiscard]] Result<FrameInfo> frame_info(uint64_t index);

 private:
  struct State;
  explicit Replay(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace throng
