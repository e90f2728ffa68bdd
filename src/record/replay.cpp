// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <flatbuffers/flatbuffers.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <utility>

#include "core/files/file_map.h"
#include "record/frame_codec.h"
#include "record/replay_file.h"
#include "record/replay_generated.h"
#include "throng/recording.h"

// Reads recordings. Opening goes from head to head and trusts only bytes under a checksum; a
// chunk's contents are checked when it is first read. Bytes from the first wrong head on are not
// part of the recording. Time of a read: the frames since the last key frame.
namespace throng {
namespace {

constexpr uint32_t kMaxFrames = 65536;  // in a chunk
constexpr const char* kBadSettings = "its settings are corrupt; record the run again";

// A chunk of frames, found by its head.
struct Chunk {
  record::ChunkHead head;
  uint64_t at = 0;    // where its bytes begin
  uint64_t key = 0;   // the key chunk at or before it: its first frame needs none before it
  bool good = false;  // its bytes have been checked
};

std::string text_of(const flatbuffers::String* text) { return text ? text->str() : ""; }

}  // namespace

struct Replay::State {
  std::string name;
  FileMap map;
  std::span<const uint8_t> bytes;
  RecordingInfo info;
  std::array<int64_t, 3> origin{};  // [m]
  std::string damage, outcome;
  std::vector<Chunk> chunks;
  uint64_t frames = 0;
  uint64_t good_bytes = 0;

  // The decoder's state: the frame before `next_frame`, in chunk `chunk`.
  static constexpr uint64_t kNone = ~uint64_t{0};
  record::FrameDecoder decoder;
  uint64_t next_frame = kNone;
  uint64_t next_at = 0;  // where its bytes begin

  [[nodiscard]] Error bad(const std::string& what) const {
    return {Errc::kBadFile, name + ": " + what};
  }

  [[nodiscard]] Error bad_chunk(const Chunk& chunk) const {
    return bad("the chunk at byte " + std::to_string(chunk.at - sizeof(record::ChunkHead)) +
               " is corrupt; frames " + std::to_string(chunk.head.first_frame) + " to " +
               std::to_string(chunk.head.first_frame + chunk.head.frames) +
               " are lost, others can be read");
  }

  // Entry `index` of the file's arrays; they need not lie on whole words.
  template <class T>
  [[nodiscard]] T load(uint64_t at, uint64_t index) const {
    T value;
    std::memcpy(&value, bytes.data() + at + index * sizeof(T), sizeof(T));
    return value;
  }
  [[nodiscard]] record::FrameEntry entry(const Chunk& chunk, uint64_t frame) const {
    return load<record::FrameEntry>(chunk.at, frame - chunk.head.first_frame);
  }
  [[nodiscard]] static uint64_t hashes_at(const Chunk& chunk) {
    return chunk.at + uint64_t{chunk.head.frames} * sizeof(record::FrameEntry);
  }
  [[nodiscard]] static uint64_t bits_at(const Chunk& chunk) {
    return hashes_at(chunk) + uint64_t{chunk.head.hashes} * sizeof(StepHash);
  }

  // Checks a chunk's bytes once: the checksum, and that its entries fit its head and each other.
  bool check(Chunk& chunk) {
    if (chunk.good) return true;
    const record::ChunkHead& head = chunk.head;
    if (hash_bytes(bytes.data() + chunk.at, head.bytes) != head.sum) return false;
    uint64_t sum = 0;
    record::FrameEntry last;
    for (uint64_t k = 0; k < head.frames; ++k) {
      const record::FrameEntry now = load<record::FrameEntry>(chunk.at, k);
      if (k > 0 && !(now.time > last.time && now.step > last.step)) return false;
      if (!(now.time >= head.first_time && now.time <= head.last_time)) return false;
      sum += now.bytes;
      last = now;
    }
    StepHash last_hash;
    for (uint64_t k = 0; k < head.hashes; ++k) {
      const auto now = load<StepHash>(hashes_at(chunk), k);
      if (k > 0 && now.step <= last_hash.step) return false;
      last_hash = now;
    }
    const uint64_t end = chunk.at + head.bytes;
    chunk.good = bits_at(chunk) + sum <= end && end - bits_at(chunk) - sum < 8;
    return chunk.good;
  }

  Chunk& chunk_of(uint64_t frame) {
    const auto after = std::upper_bound(
        chunks.begin(), chunks.end(), frame,
        [](uint64_t f, const Chunk& c) { return f < c.head.first_frame + c.head.frames; });
    return *after;
  }

  Result<void> read_info(const record::ChunkHead& head, uint64_t at);
  Result<void> walk();
  Result<void> decode_to(uint64_t index);
};

Result<void> Replay::State::read_info(const record::ChunkHead& head, uint64_t at) {
  const uint8_t* data = bytes.data() + at;
  if (hash_bytes(data, head.bytes) != head.sum) return bad(kBadSettings);
  flatbuffers::Verifier verifier(data, head.bytes);
  if (head.bytes < 8 || !format::RecordingBufferHasIdentifier(data) ||
      !format::VerifyRecordingBuffer(verifier)) {
    return bad(kBadSettings);
  }
  const format::Recording& root = *format::GetRecording(data);
  const uint32_t version = root.version();
  if (version < record::kReplayVersion || version > record::kReplayVersionWithOrigin) {
    return bad("recording version " + std::to_string(version) + ", this program reads " +
               std::to_string(record::kReplayVersion) + " to " +
               std::to_string(record::kReplayVersionWithOrigin) +
               "; open it with the program that recorded it");
  }
  const bool has_origin = version == record::kReplayVersionWithOrigin;
  if (has_origin) origin = {root.origin_x(), root.origin_y(), root.origin_z()};
  for (const int64_t v : origin) {
    if (std::fabs(static_cast<double>(v)) > record::kFarthestOrigin) return bad(kBadSettings);
  }
  if (!root.classes() || root.classes()->size() == 0 || root.classes()->size() > 256 ||
      !(root.dt() >= 1e-6 && root.dt() <= 1e6)) {
    return bad(kBadSettings);
  }
  info = {.world = text_of(root.world()),
          .world_hash = root.world_hash(),
          .dt = root.dt(),
          .classes = {},
          .model = text_of(root.model()),
          .settings = text_of(root.settings()),
          .leans = has_origin ? root.leans() : version == record::kReplayVersionThatLeans,
          .origin = {static_cast<double>(origin[0]), static_cast<double>(origin[1]),
                     static_cast<double>(origin[2])}};
  decoder = record::FrameDecoder(info.leans);
  for (const format::RecordedClass* c : *root.classes()) {
    info.classes.push_back({text_of(c->name()), c->height(), c->radius()});
    if (!std::isfinite(c->height()) || !std::isfinite(c->radius())) {
      return bad(kBadSettings);
    }
  }
  return {};
}

Result<void> Replay::State::walk() {
  uint64_t at = 0;
  double last_time = 0;
  bool ended = false;
  std::string why;
  while (!ended && why.empty()) {
    if (at == bytes.size()) {
      why = "was not finished: it ends";
      break;
    }
    const uint64_t left = bytes.size() - at;
    Chunk chunk;
    record::ChunkHead& head = chunk.head;
    if (left < sizeof head) {
      why = "breaks off in the head of a chunk";
      break;
    }
    std::memcpy(&head, bytes.data() + at, sizeof head);
    if (head.mark != record::kChunkMark || head.head_sum != head.own_sum()) {
      why = "is corrupt";
      break;
    }
    if (head.bytes > left - sizeof head) {
      why = "breaks off in a chunk";
      break;
    }
    chunk.at = at + sizeof head;
    const auto kind = static_cast<record::ChunkKind>(head.kind);
    if (at == 0) {
      if (kind != record::ChunkKind::kRun) break;
      if (auto ok = read_info(head, chunk.at); !ok) return ok;
    } else if (kind == record::ChunkKind::kEnd) {
      ended = hash_bytes(bytes.data() + chunk.at, head.bytes) == head.sum;
      if (!ended) {
        why = "is corrupt";
        break;
      }
      const auto* text = reinterpret_cast<const char*>(bytes.data() + chunk.at);
      outcome.assign(text, head.bytes);
      outcome.resize(outcome.find_last_not_of('\0') + 1);  // what it was padded with
    } else {
      const bool key = kind == record::ChunkKind::kKeyFrames;
      const uint64_t table =
          head.frames * sizeof(record::FrameEntry) + uint64_t{head.hashes} * sizeof(StepHash);
      const bool times = head.first_time <= head.last_time && std::isfinite(head.first_time) &&
                         std::isfinite(head.last_time) &&
                         (frames == 0 || head.frames == 0 || head.first_time > last_time);
      if ((!key && (kind != record::ChunkKind::kFrames || frames == 0)) ||
          head.first_frame != frames || head.frames > kMaxFrames || table > head.bytes ||
          (head.frames > 0 && !times)) {
        why = "is corrupt";
        break;
      }
      if (head.frames > 0) last_time = head.last_time;
      chunk.key = key ? chunks.size() : chunks.back().key;
      chunks.push_back(chunk);
      frames += head.frames;
    }
    at = chunk.at + head.bytes;
  }
  if (at == 0) {
    const bool ours =
        bytes.size() >= 4 && std::equal(record::kChunkMark.begin(), record::kChunkMark.end(),
                                        reinterpret_cast<const char*>(bytes.data()));
    return bad(ours ? kBadSettings : "not a recording; `throng run --record` writes one");
  }
  // After a crash of the system a head may be on disk without its contents: that chunk is lost too.
  while (!chunks.empty() && !check(chunks.back())) {
    frames -= chunks.back().head.frames;
    at = chunks.back().at - sizeof(record::ChunkHead);
    why = "is corrupt";
    chunks.pop_back();
  }
  if (ended && why.empty() && at < bytes.size()) why = "goes on after its end";
  good_bytes = at;
  if (!ended || !why.empty()) {
    damage = name + " " + why + " at byte " + std::to_string(at) + "; the first " +
             std::to_string(frames) + " frames are good";
  }
  return {};
}

// Brings the decoder to frame `index`.
Result<void> Replay::State::decode_to(uint64_t index) {
  const Chunk* chunk = &chunk_of(index);
  const uint64_t first = chunks[chunk->key].head.first_frame;
  if (next_frame == kNone || next_frame > index || next_frame < first) {
    decoder.forget();
    next_frame = first;
    next_at = bits_at(chunks[chunk->key]);
  }
  while (next_frame <= index) {
    Chunk& here = chunk_of(next_frame);
    if (!check(here)) {
      next_frame = kNone;
      return bad_chunk(here);
    }
    if (next_frame == here.head.first_frame) {
      next_at = bits_at(here);
      if (here.head.kind == static_cast<uint32_t>(record::ChunkKind::kKeyFrames)) decoder.forget();
    }
    const record::FrameEntry now = entry(here, next_frame);
    if (!decoder.decode(bytes.subspan(next_at, now.bytes), now.avatars)) {
      next_frame = kNone;
      return bad_chunk(here);
    }
    next_at += now.bytes;
    ++next_frame;
  }
  return {};
}

Replay::Replay(std::unique_ptr<State> state) : state_(std::move(state)) {}
Replay::Replay(Replay&&) noexcept = default;
Replay& Replay::operator=(Replay&&) noexcept = default;
Replay::~Replay() = default;

Result<Replay> Replay::open(const std::string& path) {
  auto map = FileMap::open(path);
  if (!map) return map.error();
  auto replay = from_bytes(map->bytes(), path);
  if (replay) replay->state_->map = std::move(*map);
  return replay;
}

Result<Replay> Replay::from_bytes(std::span<const uint8_t> bytes, const std::string& name) {
  auto state = std::make_unique<State>();
  state->name = name;
  state->bytes = bytes;
  if (auto ok = state->walk(); !ok) return ok.error();
  return Replay(std::move(state));
}

const std::string& Replay::outcome() const { return state_->outcome; }
const RecordingInfo& Replay::info() const { return state_->info; }
uint64_t Replay::frame_count() const { return state_->frames; }
uint64_t Replay::bytes() const { return state_->good_bytes; }
const std::string& Replay::damage() const { return state_->damage; }

Result<uint64_t> Replay::find(double time) {
  State& s = *state_;
  THRONG_ASSERT(s.frames > 0);
  // The last chunk that begins at or before the time, and in it the last frame.
  uint64_t found = 0;
  Chunk* chunk = nullptr;
  for (Chunk& c : s.chunks) {
    if (c.head.frames == 0) continue;
    if (chunk != nullptr && c.head.first_time > time) break;
    chunk = &c;
  }
  if (!s.check(*chunk)) return s.bad_chunk(*chunk);
  found = chunk->head.first_frame;
  for (uint64_t f = found; f < chunk->head.first_frame + chunk->head.frames; ++f) {
    if (s.entry(*chunk, f).time <= time) found = f;
  }
  return found;
}

Result<FrameInfo> Replay::frame_info(uint64_t index) {
  State& s = *state_;
  THRONG_ASSERT(index < s.frames);
  Chunk& chunk = s.chunk_of(index);
  if (!s.check(chunk)) return s.bad_chunk(chunk);
  const record::FrameEntry entry = s.entry(chunk, index);
  return FrameInfo{entry.step, entry.time, entry.avatars};
}

Result<void> Replay::read(uint64_t index, RecordedFrame& frame) {
  State& s = *state_;
  THRONG_ASSERT(index < s.frames);
  if (auto ok = s.decode_to(index); !ok) return ok;
  const Chunk& chunk = s.chunk_of(index);
  const record::FrameEntry entry = s.entry(chunk, index);
  frame.time = entry.time;
  frame.step = entry.step;
  frame.state_hash = 0;
  for (uint64_t k = 0; k < chunk.head.hashes; ++k) {
    const auto now = s.load<StepHash>(State::hashes_at(chunk), k);
    if (now.step == entry.step) frame.state_hash = now.state_hash;
  }
  const std::span<const record::Track> tracks = s.decoder.tracks();
  frame.resize(tracks.size());
  frame.up_vectors.resize(s.info.leans ? tracks.size() : 0);
  for (size_t i = 0; i < tracks.size(); ++i) {
    const record::Track& t = tracks[i];
    frame.ids[i] = t.id;
    frame.classes[i] = t.avatar_class;
    // Summed in whole millimetres: the result is the double nearest to the sum.
    const auto metres = [&](size_t axis) {
      return static_cast<double>(s.origin[axis] * 1000 + t.at[axis]) / 1000.0;
    };
    frame.positions[i] = {metres(0), metres(1), metres(2)};
    frame.radii[i] = static_cast<float>(t.radius) / 1000.0F;
    frame.headings[i] = record::heading_of(t.heading);
    if (s.info.leans) frame.up_vectors[i] = record::up_of(t.up);
    if (t.avatar_class >= s.info.classes.size()) return s.bad_chunk(chunk);
  }
  return {};
}

Result<std::vector<StepHash>> Replay::step_hashes() {
  State& s = *state_;
  std::vector<StepHash> all;
  for (Chunk& chunk : s.chunks) {
    if (!s.check(chunk)) return s.bad_chunk(chunk);
    for (uint64_t k = 0; k < chunk.head.hashes; ++k) {
      all.push_back(s.load<StepHash>(State::hashes_at(chunk), k));
    }
  }
  return all;
}

void RecordedFrame::resize(size_t avatars) {
  ids.resize(avatars);
  classes.resize(avatars);
  positions.resize(avatars);
  radii.resize(avatars);
  headings.resize(avatars);
}

FrameView RecordedFrame::view() const {
  return {time, step, state_hash, ids, classes, positions, radii, headings, up_vectors};
}

}  // namespace throng
