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

/// Recordings of a crowd: writing, replay, exports, summaries.
namespace throng {

// ----
// Recordings: the positions of all avatars, frame by frame, and the hash of every step. A file
// format of its own (docs/file_format.md), written during the run: the part that was written opens
// even if the run was killed.

/// A direction in the ground plane. Any length.
struct Heading {
  float x = 0, z = 1;
};

inline constexpr size_t kMaxAvatars = size_t{1} << 28;  ///< A frame has fewer avatars than this.

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
  // As in FrameView, the fields of the same names.
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
  /// Makes all arrays but `up_vectors` so long.
  void resize(size_t avatars);
  /// The frame as one to write; valid until the arrays change.
  [[nodiscard]] FrameView view() const;
};

/// A class of the recorded avatars.
struct RecordedClass {
  std::string name = "adult";
  double height = 1.75;  ///< [m]
  double radius = 0.19;  ///< [m]
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
  /// The point to which the positions in the file are relative. Those of frames are absolute.
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
  [[nodiscard]] uint64_t frames() const;  ///< Added so far.
  [[nodiscard]] uint64_t bytes() const;   ///< Written so far.

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

  /// The description that the recorder was given.
  [[nodiscard]] const RecordingInfo& info() const;
  /// The `outcome` of Recorder::finish; empty if there was none, or the recording was not finished.
  [[nodiscard]] const std::string& outcome() const;
  /// Frames that can be read, if their chunks are not corrupt.
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

// ----
// Exports recordings as text that other programs read. Files are complete or absent.

/// Which avatars of a recording to export: many tools know one floor only, a recording may have
/// several.
struct ExportConfig {
  double lowest = -1e9;  ///< Lowest feet to export. [m]
  double highest = 1e9;  ///< Highest feet to export. [m]
};

/// Maps steps to film frames at a constant rate. The interval is the greatest common divisor of the
/// steps between recorded frames, so that each of these falls on a film frame.
struct FilmRate {
  uint64_t first_step = 0;  ///< Of the first recorded frame.
  uint64_t steps = 1;       ///< From one film frame to the next.
  double rate = 10;         ///< Film frames per second.
  /// The film frame that shows a step, from 0. [step >= first_step]
  [[nodiscard]] uint64_t frame_of(uint64_t step) const { return (step - first_step) / steps; }
};

/// The film rate of a recording. Fails with kBadFile as Replay::read does.
[[nodiscard]] THRONG_API Result<FilmRate> film_rate(Replay& replay);

/// The first line of a CSV table, and its continuation where avatars may lean: the unit vector
/// along the body from its feet.
inline constexpr const char* kCsvColumns = "step,id,class,x,y,z,radius";
inline constexpr const char* kCsvUpColumns = ",up_x,up_y,up_z";

/// Exports a CSV table, one line per avatar and frame, as `throng run --trajectories` writes. Fails
/// with kBadFile (also if there is no frame), kIo or kCancelled; then nothing is written.
[[nodiscard]] THRONG_API Result<void> export_csv(Replay& replay, const std::string& path,
                                                 const ExportConfig& config, Context& context);

/// Exports the text format of the Juelich experiments, one line per avatar and frame: id, frame, x,
/// y, z in metres. Its x and y are x and z here, its z is the height of the feet. Fails as
/// export_csv does.
[[nodiscard]] THRONG_API Result<void> export_juelich(Replay& replay, const std::string& path,
                                                     const ExportConfig& config, Context& context);

// ----
// Summaries of recordings: numbers of avatars, flows over lines, maps of density and of waiting.

/// A line on the ground, seen from above, where crossings are counted.
struct FlowLine {
  double x0 = 0, z0 = 0, x1 = 0, z1 = 0;  ///< Its ends. [m, not the same]
  double lowest = -1e9, highest = 1e9;    ///< Only feet between these heights count. [m]
};

/// Settings for summarise.
struct SummaryConfig {
  std::vector<FlowLine> lines = {};
  double bin = 1;                          ///< Time bin of the flows. [s, >= 0.001]
  double cell = 0.5;                       ///< Side of a cell of the maps. [m, >= 0.001]
  double storey = 3;                       ///< Height of a storey; each has its maps. [m, >= 0.001]
  double slow = 0.2;                       ///< Avatars slower than this wait. [m/s, >= 0.001]
  uint64_t max_cells = uint64_t{1} << 24;  ///< Limit of the cells of all maps together.
};

/// Crossings of one line, per time bin from the first frame on. Forth is to the right as seen from
/// the line's first end towards its second (x to the right, z down).
struct LineFlow {
  std::vector<uint32_t> forth, back;         ///< Avatars, one entry per bin.
  uint64_t total_forth = 0, total_back = 0;  ///< Over all bins.
};

/// Cells of one storey, row by row: cell (i, k) begins at x0 + i * cell, z0 + k * cell.
struct SummaryMap {
  double lowest = 0, highest = 0;     ///< Feet in [lowest, highest). [m]
  double x0 = 0, z0 = 0, cell = 0.5;  ///< [m]
  int32_t width = 0, depth = 0;       ///< Cells along X and Z.
  std::vector<double> density;        ///< Mean over the whole time. [avatars / m^2]
  std::vector<double> waiting;        ///< Waiting time, summed over avatars. [s / m^2]
};

/// The summary of a recording.
struct ReplaySummary {
  uint64_t positions = 0;  ///< Avatars summed over all frames.
  double mean_speed = 0;   ///< Over all avatars and frames. [m/s]
  double waited = 0;       ///< Waiting time, summed over avatars. [s]
  double last_left = 0;    ///< When the last avatar left; 0 if none did. [s]
  // One per frame:
  std::vector<double> time;             ///< [s]
  std::vector<uint32_t> present;        ///< Avatars in the frame.
  std::vector<uint64_t> entered, left;  ///< So far; avatars of the first frame have entered.
  /// Mean over avatars that are also in the next frame; the last frame repeats the one before.
  /// [m/s]
  std::vector<double> speed;
  std::vector<LineFlow> lines;   ///< In the order of the config.
  std::vector<SummaryMap> maps;  ///< Of storeys with avatars, lowest first.
};

/// Summarises a recording; each position counts until the next frame. Reads all frames twice. Fails
/// with kBadConfig, kBadFile (a corrupt chunk, no frame at all), kLimit (too many cells) or
/// kCancelled.
[[nodiscard]] THRONG_API Result<ReplaySummary> summarise(Replay& replay,
                                                         const SummaryConfig& config,
                                                         Context& context);

}  // namespace throng
