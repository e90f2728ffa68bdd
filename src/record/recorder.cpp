// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <flatbuffers/flatbuffers.h>

#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <utility>

#include "record/frame_codec.h"
#include "record/replay_file.h"
#include "record/replay_generated.h"
#include "throng/recording.h"

// Writes recordings in chunks, each with one system write and never changed: if the process dies,
// the file is a sequence of whole chunks and at most one that is cut off. docs/file_format.md.
namespace throng {
namespace {

flatbuffers::DetachedBuffer info_bytes(const RecordingInfo& info) {
  flatbuffers::FlatBufferBuilder builder;
  std::vector<flatbuffers::Offset<format::RecordedClass>> classes;
  for (const RecordedClass& c : info.classes) {
    classes.push_back(
        format::CreateRecordedClass(builder, builder.CreateString(c.name), c.height, c.radius));
  }
  // Without an origin, the older version, which programs without origins can read.
  const bool has_origin = info.origin != Vec3d{};
  const uint32_t version = has_origin   ? record::kReplayVersionWithOrigin
                           : info.leans ? record::kReplayVersionThatLeans
                                        : record::kReplayVersion;
  const auto settings = builder.CreateString(info.settings);
  const auto model = builder.CreateString(info.model);
  const auto all_classes = builder.CreateVector(classes);
  const auto world = builder.CreateString(info.world);
  const auto whole = [](double v) { return static_cast<int64_t>(v); };
  builder.Finish(
      format::CreateRecording(builder, version, world, info.world_hash, info.dt, all_classes, model,
                              settings, whole(info.origin.x), whole(info.origin.y),
                              whole(info.origin.z), has_origin && info.leans),
      format::RecordingIdentifier());
  return builder.Release();
}

Error bad_config(const std::string& what) { return {Errc::kBadConfig, "recording: " + what}; }

bool is_origin(double v) { return std::fabs(v) <= record::kFarthestOrigin && v == std::floor(v); }

}  // namespace

struct Recorder::State {
  std::string path;
  RecorderConfig config;
  size_t classes = 0;
  std::FILE* file = nullptr;
  int reason = 0;  // errno of the first failure
  record::FrameEncoder encoder;
  std::vector<record::FrameEntry> entries;
  std::vector<StepHash> hashes;
  std::vector<uint8_t> bits;   // of the frames of this chunk
  std::vector<uint8_t> chunk;  // as it is written
  uint64_t frames = 0, bytes = 0;
  uint64_t since_key = 0;  // frames
  bool key = true;         // this chunk begins with a frame that needs none before it
  double last_time = 0;
  uint64_t last_step = 0, last_hash_step = 0;
  bool any_hash = false;

  ~State() {
    if (file != nullptr) std::fclose(file);
  }

  [[nodiscard]] Error io_error() const {
    return {Errc::kIo, path + ": cannot write: " + std::strerror(reason) +
                           "; check the folder, its rights and the free space"};
  }

  Result<void> write(record::ChunkHead head,
                     std::initializer_list<std::span<const uint8_t>> parts) {
    chunk.resize(sizeof head);
    for (const auto& part : parts) chunk.insert(chunk.end(), part.begin(), part.end());
    chunk.resize((chunk.size() + 7) & ~size_t{7});
    head.bytes = chunk.size() - sizeof head;
    head.sum = hash_bytes(chunk.data() + sizeof head, head.bytes);
    head.head_sum = head.own_sum();
    std::memcpy(chunk.data(), &head, sizeof head);
    if (reason == 0 && std::fwrite(chunk.data(), 1, chunk.size(), file) != chunk.size()) {
      reason = errno != 0 ? errno : EIO;
    }
    if (reason != 0) return io_error();
    bytes += chunk.size();
    return {};
  }

  template <class T>
  static std::span<const uint8_t> bytes_of(const std::vector<T>& values) {
    return {reinterpret_cast<const uint8_t*>(values.data()), values.size() * sizeof(T)};
  }

  Result<void> flush() {
    if (file == nullptr || (entries.empty() && hashes.empty())) return {};
    record::ChunkHead head;
    head.kind =
        static_cast<uint32_t>(key ? record::ChunkKind::kKeyFrames : record::ChunkKind::kFrames);
    head.first_frame = frames - entries.size();
    head.frames = static_cast<uint32_t>(entries.size());
    head.hashes = static_cast<uint32_t>(hashes.size());
    head.first_time = entries.empty() ? last_time : entries.front().time;
    head.last_time = entries.empty() ? last_time : entries.back().time;
    Result<void> written = write(head, {bytes_of(entries), bytes_of(hashes), bits});
    entries.clear();
    hashes.clear();
    bits.clear();
    key = since_key >= config.key_frames || frames == 0;
    if (key) encoder.forget();
    return written;
  }
};

Vec3d recording_origin(const Box3d& bounds) {
  constexpr double kMaxUnshifted = 1e6;  // [m] Half the range of positions in a frame.
  if (bounds.empty()) return {};
  const auto axis = [](double low, double high) {
    if (low >= -kMaxUnshifted && high <= kMaxUnshifted) return 0.0;
    return std::floor(low + (high - low) / 2 + 0.5) + 0.0;  // never -0
  };
  return {axis(bounds.min.x, bounds.max.x), axis(bounds.min.y, bounds.max.y),
          axis(bounds.min.z, bounds.max.z)};
}

Recorder::Recorder(std::unique_ptr<State> state) : state_(std::move(state)) {}
Recorder::Recorder(Recorder&&) noexcept = default;
Recorder& Recorder::operator=(Recorder&& other) noexcept {
  if (state_) (void)state_->flush();
  state_ = std::move(other.state_);
  return *this;
}
Recorder::~Recorder() {
  if (state_) (void)state_->flush();
}

Result<Recorder> Recorder::create(const std::string& path, const RecordingInfo& info,
                                  const RecorderConfig& config) {
  constexpr uint32_t kMax = 65536;
  constexpr double kMinDt = 1e-6, kMaxDt = 1e6;  // [s]
  if (!(info.dt >= kMinDt && info.dt <= kMaxDt)) {
    return bad_config("dt must be 0.000001 to 1000000 s");
  }
  if (info.classes.empty() || info.classes.size() > 256) return bad_config("1 to 256 classes");
  for (const RecordedClass& c : info.classes) {
    if (std::isfinite(c.height) && std::isfinite(c.radius)) continue;
    return bad_config("class " + c.name + " has no finite size");
  }
  if (!is_origin(info.origin.x) || !is_origin(info.origin.y) || !is_origin(info.origin.z)) {
    return bad_config("the origin must be whole metres within 1 000 000 km");
  }
  if (config.chunk_frames < 1 || config.chunk_frames > kMax || config.key_frames < 1 ||
      config.key_frames > kMax || config.chunk_bytes < 1) {
    return bad_config("chunks and keys of 1 to 65536 frames, more than 0 bytes");
  }
  auto state = std::make_unique<State>();
  state->path = path;
  state->config = config;
  state->classes = info.classes.size();
  state->encoder = record::FrameEncoder(info.leans, info.origin);
  state->file = std::fopen(path.c_str(), "wb");
  if (state->file == nullptr) {
    state->reason = errno;
    return state->io_error();
  }
  std::setvbuf(state->file, nullptr, _IONBF, 0);
  record::ChunkHead head;
  head.kind = static_cast<uint32_t>(record::ChunkKind::kRun);
  const auto bytes = info_bytes(info);
  if (auto ok = state->write(head, {{bytes.data(), bytes.size()}}); !ok) return ok.error();
  return Recorder(std::move(state));
}

Result<void> Recorder::append_hash(uint64_t step, uint64_t state_hash) {
  State& s = *state_;
  THRONG_ASSERT(s.file != nullptr);
  if (s.any_hash && step <= s.last_hash_step) {
    return Error{Errc::kBadInput, "recording: step " + std::to_string(step) + " after step " +
                                      std::to_string(s.last_hash_step) + "; steps must grow"};
  }
  s.hashes.push_back({step, state_hash});
  s.last_hash_step = step;
  s.any_hash = true;
  if (s.hashes.size() >= size_t{s.config.chunk_frames} * 64) return s.flush();
  return {};
}

Result<void> Recorder::append(const FrameView& frame) {
  State& s = *state_;
  THRONG_ASSERT(s.file != nullptr);
  if (!std::isfinite(frame.time) || (s.frames > 0 && !(frame.time > s.last_time))) {
    return Error{Errc::kBadInput, "recording: the time of step " + std::to_string(frame.step) +
                                      " is not after that of the frame before"};
  }
  if (s.any_hash && frame.step <= s.last_hash_step) {
    return Error{Errc::kBadInput, "recording: step " + std::to_string(frame.step) + " after step " +
                                      std::to_string(s.last_hash_step) + "; steps must grow"};
  }
  for (size_t i = 0; i < frame.classes.size(); ++i) {
    if (frame.classes[i] < s.classes) continue;
    return Error{Errc::kBadInput, "recording: avatar number " + std::to_string(i) + " of step " +
                                      std::to_string(frame.step) + " is of class " +
                                      std::to_string(frame.classes[i]) + " of " +
                                      std::to_string(s.classes)};
  }
  const size_t before = s.bits.size();
  if (auto ok = s.encoder.encode(frame, s.bits); !ok) return ok;
  if (s.entries.empty() && s.key) s.since_key = 0;
  s.entries.push_back({frame.step, frame.time, static_cast<uint32_t>(frame.ids.size()),
                       static_cast<uint32_t>(s.bits.size() - before)});
  s.hashes.push_back({frame.step, frame.state_hash});
  s.last_hash_step = frame.step;
  s.any_hash = true;
  s.last_time = frame.time;
  ++s.frames;
  ++s.since_key;
  const bool full = s.entries.size() >= s.config.chunk_frames ||
                    s.bits.size() >= s.config.chunk_bytes || s.since_key >= s.config.key_frames;
  return full ? s.flush() : Result<void>();
}

Result<void> Recorder::flush() { return state_->flush(); }

Result<void> Recorder::finish(std::string_view outcome) {
  State& s = *state_;
  if (auto ok = s.flush(); !ok) return ok;
  record::ChunkHead head;
  head.kind = static_cast<uint32_t>(record::ChunkKind::kEnd);
  head.first_frame = s.frames;
  head.first_time = head.last_time = s.last_time;
  const auto* text = reinterpret_cast<const uint8_t*>(outcome.data());
  if (auto ok = s.write(head, {{text, outcome.size()}}); !ok) return ok;
  if (std::fclose(std::exchange(s.file, nullptr)) != 0) {
    s.reason = errno != 0 ? errno : EIO;
    return s.io_error();
  }
  return {};
}

uint64_t Recorder::frames() const { return state_->frames; }
uint64_t Recorder::bytes() const { return state_->bytes; }

}  // namespace throng
