// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "throng/recording.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "core/random.h"
#include "record/frame_codec.h"
#include "record/replay_file.h"
#include "record/replay_generated.h"
#include "scratch_folder.h"

namespace throng {
namespace {

using test::ScratchFolder;

RecordingInfo two_classes() {
  return {.world = "garage.throng",
          .world_hash = 77,
          .dt = 0.1,
          .classes = {{.name = "adult"}, {.name = "child", .height = 1.1, .radius = 0.2}},
          .model = "test",
          .settings = "{\"seed\": 1}"};
}

// Avatars that walk, stand or jump, enter and leave, in no order of id.
std::vector<RecordedFrame> random_run(uint64_t seed, size_t frames, size_t max_avatars) {
  std::vector<RecordedFrame> run;
  std::vector<uint64_t> here;
  struct Body {
    Vec3d at, by;
  };
  std::vector<Body> bodies(4 * max_avatars);
  uint64_t counter = 0;
  const auto unit = [&] { return random_unit(seed, 1, counter++); };
  for (size_t f = 0; f < frames; ++f) {
    std::erase_if(here, [&](uint64_t) { return unit() < 0.03; });
    for (uint64_t id = 0; id < bodies.size() && here.size() < max_avatars; ++id) {
      if (unit() > 0.1 || std::count(here.begin(), here.end(), id) > 0) continue;
      here.push_back(id);
      bodies[id].at = {unit() * 100 - 50, unit() * 9, unit() * 2e6 - 1e6};
      bodies[id].by = {unit() * 0.3 - 0.15, 0, unit() * 0.3 - 0.15};
    }
    if (!here.empty()) std::rotate(here.begin(), here.begin() + counter % here.size(), here.end());
    RecordedFrame frame;
    frame.time = 0.1 * static_cast<double>(3 * f);
    frame.step = 3 * f;
    frame.state_hash = random_u64(seed, 2, f);
    frame.resize(here.size());
    for (size_t i = 0; i < here.size(); ++i) {
      const uint64_t id = here[i];
      Body& body = bodies[id];
      if (unit() < 0.02) body.by = {unit() - 0.5, unit() - 0.5, 0};
      if (unit() < 0.005) body.at = {unit() * 3e6 - 1.5e6, unit() * 3e6 - 1.5e6, 0};
      if (id % 3 != 0) body.at = body.at + body.by;
      frame.ids[i] = id * 1'000'003 * (id % 5 == 0 ? 1'000'000'007 : 1);
      frame.classes[i] = static_cast<uint8_t>((id + (unit() < 0.01 ? 1 : 0)) % 2);
      frame.positions[i] = body.at;
      frame.radii[i] = static_cast<float>(0.2 + 0.001 * static_cast<double>((id + f / 25) % 100));
      frame.headings[i] = {static_cast<float>(body.by.x), static_cast<float>(body.by.z)};
    }
    run.push_back(std::move(frame));
  }
  return run;
}

// The frame read back is in order of id, equal to the millimetre.
void expect_same(const RecordedFrame& wrote, const RecordedFrame& read) {
  EXPECT_EQ(wrote.time, read.time);
  EXPECT_EQ(wrote.step, read.step);
  EXPECT_EQ(wrote.state_hash, read.state_hash);
  ASSERT_EQ(wrote.size(), read.size());
  std::vector<size_t> order(wrote.size());
  for (size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::sort(order.begin(), order.end(),
            [&](size_t a, size_t b) { return wrote.ids[a] < wrote.ids[b]; });
  for (size_t k = 0; k < order.size(); ++k) {
    const size_t i = order[k];
    ASSERT_EQ(wrote.ids[i], read.ids[k]);
    EXPECT_EQ(wrote.classes[i], read.classes[k]);
    EXPECT_NEAR(wrote.radii[i], read.radii[k], 0.00051);
    EXPECT_NEAR(wrote.positions[i].x, read.positions[k].x, 0.000501);
    EXPECT_NEAR(wrote.positions[i].y, read.positions[k].y, 0.000501);
    EXPECT_NEAR(wrote.positions[i].z, read.positions[k].z, 0.000501);
    const Heading a = wrote.headings[i], b = read.headings[k];
    const double size = std::hypot(a.x, a.z);
    if (size == 0) continue;
    EXPECT_GT((a.x * b.x + a.z * b.z) / size, std::cos(0.91 * 3.14159265 / 180));
  }
}

void record(const std::string& path, const std::vector<RecordedFrame>& run,
            const RecorderConfig& config = {}) {
  auto recorder = Recorder::create(path, two_classes(), config);
  ASSERT_TRUE(recorder) << recorder.error().message;
  for (const RecordedFrame& frame : run) {
    const auto ok = recorder->append(frame.view());
    ASSERT_TRUE(ok) << ok.error().message;
  }
  EXPECT_EQ(recorder->frames(), run.size());
  ASSERT_TRUE(recorder->finish());
  EXPECT_EQ(recorder->bytes(), std::filesystem::file_size(path));
}

std::string bytes_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

std::span<const uint8_t> span_of(const std::string& bytes) {
  return {reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size()};
}

TEST(Recording, GivesBackWhatWasWrittenInAnyOrderOfReading) {
  const ScratchFolder folder;
  const std::string path = folder.path() + "/run.replay";
  for (uint64_t seed = 1; seed <= 20; ++seed) {
    const auto run = random_run(seed, 90, seed % 4 == 0 ? 3 : 40);
    record(path, run,
           {.chunk_frames = static_cast<uint32_t>(1 + seed % 9),
            .chunk_bytes = seed % 2 == 0 ? 300u : 1u << 18,
            .key_frames = static_cast<uint32_t>(1 + seed * 7 % 40)});
    auto replay = Replay::open(path);
    ASSERT_TRUE(replay) << replay.error().message;
    EXPECT_EQ(replay->damage(), "");
    EXPECT_EQ(replay->bytes(), std::filesystem::file_size(path));
    EXPECT_EQ(replay->info().classes, two_classes().classes);
    EXPECT_EQ(replay->info().settings, "{\"seed\": 1}");
    EXPECT_EQ(replay->info().world_hash, 77u);
    ASSERT_EQ(replay->frame_count(), run.size());
    RecordedFrame frame;
    for (uint64_t f = 0; f < run.size(); ++f) {
      ASSERT_TRUE(replay->read(f, frame));
      expect_same(run[f], frame);
    }
    for (uint64_t k = 0; k < 60; ++k) {
      const uint64_t f = random_below(seed, 9, k, run.size());
      const auto ok = replay->read(f, frame);
      ASSERT_TRUE(ok) << ok.error().message;
      expect_same(run[f], frame);
      const auto about = replay->frame_info(f);
      ASSERT_TRUE(about);
      EXPECT_EQ(about->avatars, run[f].size());
      EXPECT_EQ(about->step, run[f].step);
    }
  }
}

// A random run in which some avatars lean; a part of these turn in every frame.
std::vector<RecordedFrame> leaning_run(uint64_t seed, size_t frames, size_t max_avatars) {
  auto run = random_run(seed, frames, max_avatars);
  for (RecordedFrame& frame : run) {
    for (const uint64_t id : frame.ids) {
      const auto axis = [&](uint64_t n) { return 2 * random_unit(seed, id, 3 * n) - 1; };
      const uint64_t turns = id % 4 == 1 ? frame.step / 12 : frame.step;
      const Vec3d up{axis(turns), axis(turns + 1000000), axis(turns + 2000000)};
      frame.up_vectors.push_back(id % 4 == 0 ? Vec3d{0, 2, 0} : up);
    }
  }
  return run;
}

void expect_same_axes(const RecordedFrame& wrote, const RecordedFrame& read) {
  ASSERT_EQ(read.up_vectors.size(), wrote.size());
  for (size_t i = 0; i < wrote.size(); ++i) {
    const auto at = std::lower_bound(read.ids.begin(), read.ids.end(), wrote.ids[i]);
    const Vec3d a = wrote.up_vectors[i] * (1 / length(wrote.up_vectors[i])),
                b = read.up_vectors[at - read.ids.begin()];
    EXPECT_NEAR(length(b), 1, 1e-12);
    EXPECT_LT(length(a - b), 0.06 * 3.14159265 / 180) << a.x << ' ' << a.y << ' ' << a.z;
    EXPECT_EQ(record::up_of(record::up_code(wrote.up_vectors[i])),
              b);  // What was written, to the bit.
    if (wrote.ids[i] % 4 == 0) {
      EXPECT_EQ(b, (Vec3d{0, 1, 0}));
    }
  }
}

TEST(Recording, KeepsTheAxesOfLeaningAvatars) {
  const ScratchFolder folder;
  const std::string path = folder.path() + "/run.replay";
  RecordingInfo info = two_classes();
  info.leans = true;
  for (uint64_t seed = 1; seed <= 10; ++seed) {
    const auto run = leaning_run(seed, 60, seed % 4 == 0 ? 3 : 40);
    auto recorder = Recorder::create(path, info,
                                     {.chunk_frames = static_cast<uint32_t>(1 + seed % 9),
                                      .key_frames = static_cast<uint32_t>(1 + seed * 7 % 40)});
    ASSERT_TRUE(recorder);
    for (const RecordedFrame& frame : run) {
      const auto ok = recorder->append(frame.view());
      ASSERT_TRUE(ok) << ok.error().message;
    }
    ASSERT_TRUE(recorder->finish());
    auto replay = Replay::open(path);
    ASSERT_TRUE(replay) << replay.error().message;
    EXPECT_TRUE(replay->info().leans);
    RecordedFrame frame;
    for (uint64_t k = 0; k < 2 * run.size(); ++k) {
      const uint64_t f = k < run.size() ? k : random_below(seed, 9, k, run.size());
      const auto ok = replay->read(f, frame);
      ASSERT_TRUE(ok) << ok.error().message;
      expect_same(run[f], frame);
      expect_same_axes(run[f], frame);
    }
  }
}

// A run without leaning avatars has the bytes of version 1. Without RecordingInfo::leans, a frame
// with a leaning avatar is refused.
TEST(Recording, WithoutLeaningAvatarsHasTheBytesOfVersion1) {
  const ScratchFolder folder;
  const std::string path = folder.path() + "/run.replay", other = folder.path() + "/other.replay";
  auto run = random_run(4, 40, 20);
  record(path, run);
  for (RecordedFrame& frame : run) frame.up_vectors.assign(frame.size(), Vec3d{0, 1, 0});
  record(other, run);
  EXPECT_EQ(bytes_of(path), bytes_of(other));
  EXPECT_EQ(bytes_of(path).size(), 5096u);
  auto replay = Replay::open(path);
  ASSERT_TRUE(replay);
  EXPECT_FALSE(replay->info().leans);
  RecordedFrame frame;
  ASSERT_TRUE(replay->read(30, frame));
  EXPECT_TRUE(frame.up_vectors.empty());

  RecordingInfo info = two_classes();
  auto upright = Recorder::create(path, info);
  info.leans = true;
  auto leans = Recorder::create(other, info);
  ASSERT_TRUE(upright && leans);
  run[5].up_vectors[0] = {1, 0, 0};
  const auto refused = [](Recorder& recorder, const RecordedFrame& bad, const char* word) {
    const auto ok = recorder.append(bad.view());
    ASSERT_FALSE(ok) << word;
    EXPECT_EQ(ok.error().code, Errc::kBadInput);
    EXPECT_NE(ok.error().message.find(word), std::string::npos) << ok.error().message;
  };
  refused(*upright, run[5], "leans; set RecordingInfo::leans");
  for (const Vec3d& none : {Vec3d{}, Vec3d{NAN, 1, 0}, Vec3d{0, INFINITY, 0}}) {
    run[5].up_vectors[0] = none;
    refused(*leans, run[5], "has no axis");
  }
  run[5].up_vectors.pop_back();
  refused(*leans, run[5], "as many axes as ids");
  EXPECT_TRUE(leans->append(run[6].view()));
}

// The file without its first chunk, the settings.
std::string frames_of(const std::string& bytes) {
  record::ChunkHead head;
  std::memcpy(&head, bytes.data(), sizeof head);
  return bytes.substr(sizeof head + head.bytes);
}

// Wherever the recording's origin is, frames are the same millimetres, in the same bytes.
TEST(Recording, KeepsTheMillimetreFarFromTheCoordinateOrigin) {
  const ScratchFolder folder;
  const std::string near_path = folder.path() + "/near.replay",
                    path = folder.path() + "/run.replay";
  for (uint64_t seed = 1; seed <= 12; ++seed) {
    const auto coordinate = [&](uint64_t axis) {
      const double far = seed % 3 == 0 ? 1e9 : 1e7;
      if (seed <= 4) return seed % 2 == 0 ? far : -far;
      return std::floor((2 * random_unit(seed, 5, axis) - 1) * far);
    };
    RecordingInfo info = two_classes();
    info.leans = seed % 4 == 0;
    auto run = info.leans ? leaning_run(seed, 40, 30) : random_run(seed, 40, 30);
    for (RecordedFrame& frame : run) {
      // Steps of 1/1024 m: exact in all places.
      for (Vec3d& p : frame.positions) {
        p = {std::floor(p.x * 1024) / 1024, std::floor(p.y * 1024) / 1024,
             std::floor(p.z * 1024) / 1024};
      }
    }
    const auto write = [&](const std::string& to) {
      auto recorder = Recorder::create(to, info, {.chunk_frames = 7, .key_frames = 14});
      ASSERT_TRUE(recorder) << recorder.error().message;
      for (RecordedFrame frame : run) {
        for (Vec3d& p : frame.positions) p = p + info.origin;
        const auto ok = recorder->append(frame.view());
        ASSERT_TRUE(ok) << ok.error().message;
      }
      ASSERT_TRUE(recorder->finish());
    };
    write(near_path);
    info.origin = {coordinate(0), coordinate(1), coordinate(2)};
    write(path);
    EXPECT_EQ(frames_of(bytes_of(path)), frames_of(bytes_of(near_path)));

    auto replay = Replay::open(path), near = Replay::open(near_path);
    ASSERT_TRUE(replay) << replay.error().message;
    ASSERT_TRUE(near) << near.error().message;
    EXPECT_EQ(replay->info().origin, info.origin);
    EXPECT_EQ(replay->info().leans, info.leans);
    EXPECT_EQ(replay->info().classes, info.classes);
    EXPECT_EQ(near->info().origin, Vec3d{});
    RecordedFrame frame, near_frame;
    for (uint64_t k = 0; k < 2 * run.size(); ++k) {
      const uint64_t f = k < run.size() ? k : random_below(seed, 9, k, run.size());
      ASSERT_TRUE(replay->read(f, frame));
      ASSERT_TRUE(near->read(f, near_frame));
      RecordedFrame wrote = run[f];
      for (Vec3d& p : wrote.positions) p = p + info.origin;
      expect_same(wrote, frame);
      if (info.leans) expect_same_axes(wrote, frame);
      for (size_t i = 0; i < frame.size(); ++i) {
        const Vec3d off = frame.positions[i] - info.origin - near_frame.positions[i];
        EXPECT_LT(length(off), 4e-7);  // [m] The resolution of doubles at 10^9 m.
      }
    }
  }
}

TEST(Recording, ReadsThePositionNextToTheMillimetre) {
  const ScratchFolder folder;
  const std::string path = folder.path() + "/run.replay";
  RecordingInfo info = two_classes();
  info.origin = {678015, 0, -5403515};
  RecordedFrame frame;
  frame.resize(1);
  frame.positions[0] = {678012.3454, 370.1236, -5403500.1238};
  auto recorder = Recorder::create(path, info);
  ASSERT_TRUE(recorder);
  ASSERT_TRUE(recorder->append(frame.view()));
  ASSERT_TRUE(recorder->finish());
  auto replay = Replay::open(path);
  ASSERT_TRUE(replay);
  ASSERT_TRUE(replay->read(0, frame));
  EXPECT_EQ(frame.positions[0], (Vec3d{678012.345, 370.124, -5403500.124}));  // To the bit.
}

TEST(Recording, TakesWholeMetresWithinReachAsItsOrigin) {
  const ScratchFolder folder;
  const std::string path = folder.path() + "/run.replay";
  RecordingInfo info = two_classes();
  for (const double bad : {0.5, -1e7 - 0.25, 1.1e9, -1.1e9, double{NAN}, double{INFINITY}}) {
    for (const Vec3d& origin : {Vec3d{bad, 0, 0}, Vec3d{0, bad, 0}, Vec3d{0, 0, bad}}) {
      info.origin = origin;
      const auto refused = Recorder::create(path, info);
      ASSERT_FALSE(refused) << bad;
      EXPECT_EQ(refused.error().code, Errc::kBadConfig);
      EXPECT_EQ(refused.error().message,
                "recording: the origin must be whole metres within 1 000 000 km");
    }
  }
  info.origin = {0, 0, -1e7};
  auto recorder = Recorder::create(path, info);
  ASSERT_TRUE(recorder);
  RecordedFrame frame;
  frame.resize(1);
  for (const double z : {0.0, -7.99e6, -1.201e7, 1e7}) {
    frame.positions[0] = {0, 0, z};
    const auto far = recorder->append(frame.view());
    ASSERT_FALSE(far) << z;
    EXPECT_EQ(far.error().message,
              "recording: avatar 0 is nowhere, or farther than 2000 km from the recording's "
              "origin; set RecordingInfo::origin");
  }
  frame.positions[0] = {1.99e6, -1.99e6, -1.19e7};
  EXPECT_TRUE(recorder->append(frame.view()));
}

TEST(Recording, TheOriginOfAWorldReachesAllOfIt) {
  const auto of = [](Vec3d low, Vec3d high) { return recording_origin({low, high}); };
  EXPECT_EQ(recording_origin({}), Vec3d{});
  EXPECT_EQ(of({0, 0, 0}, {30, 3, 30}), Vec3d{});
  EXPECT_EQ(of({-1e6, -1e6, -1e6}, {1e6, 1e6, 1e6}), Vec3d{});
  EXPECT_EQ(of({678000, 370, -5403530}, {678030, 370, -5403500}), (Vec3d{0, 0, -5403515}));
  EXPECT_EQ(of({-1e7, 0, 9999999.4}, {-9999999, 0, 1e7}), (Vec3d{-9999999, 0, 1e7}));
  EXPECT_EQ(of({1e6, 0, -1.5e6}, {2e6 + 1, 0, 1.9e6}), (Vec3d{1500001, 0, 200000}));
  EXPECT_FALSE(std::signbit(of({-2e6, 0, 0}, {2e6, 0, 0}).x));
  for (uint64_t n = 0; n < 1000; ++n) {
    const auto unit = [&](uint64_t k) { return random_unit(3, n, k); };
    const Vec3d low{2e9 * unit(0) - 1e9, 2e6 * unit(1) - 1e6, 2e7 * unit(2) - 1e7};
    const Vec3d size{1e6 * unit(3), 100 * unit(4), 1e6 * unit(5)};
    const Vec3d from = of(low, low + size);
    for (const Vec3d& p : {low - from, low + size - from}) {
      EXPECT_LE(std::max({std::fabs(p.x), std::fabs(p.y), std::fabs(p.z)}), 1e6);
    }
  }
}

// A recording of a later version, or with an origin out of range.
TEST(Recording, RefusesOtherVersionsAndSaysWhatToDo) {
  const auto settings = [](uint32_t version, int64_t origin) {
    flatbuffers::FlatBufferBuilder builder;
    const std::vector<flatbuffers::Offset<format::RecordedClass>> classes{
        format::CreateRecordedClass(builder, builder.CreateString("adult"), 1.75, 0.25)};
    const auto all = builder.CreateVector(classes);
    builder.Finish(
        format::CreateRecording(builder, version, 0, 0, 0.1, all, 0, 0, origin, -origin, 5, true),
        format::RecordingIdentifier());
    std::string bytes(reinterpret_cast<const char*>(builder.GetBufferPointer()), builder.GetSize());
    bytes.resize((bytes.size() + 7) / 8 * 8);
    record::ChunkHead head;
    head.kind = static_cast<uint32_t>(record::ChunkKind::kRun);
    head.bytes = bytes.size();
    head.sum = hash_bytes(bytes.data(), bytes.size());
    head.head_sum = head.own_sum();
    return std::string(reinterpret_cast<const char*>(&head), sizeof head) + bytes;
  };
  for (const uint32_t version : {0u, 4u, 5u, 4000000000u}) {
    const std::string bytes = settings(version, 0);
    const auto replay = Replay::from_bytes(span_of(bytes), "a.replay");
    ASSERT_FALSE(replay);
    EXPECT_EQ(replay.error().code, Errc::kBadFile);
    EXPECT_EQ(replay.error().message, "a.replay: recording version " + std::to_string(version) +
                                          ", this program reads 1 to 3; open it with the program "
                                          "that recorded it");
  }
  for (const int64_t origin : {int64_t{1'000'000'001}, INT64_MAX, INT64_MIN + 1}) {
    const std::string bytes = settings(3, origin);
    const auto replay = Replay::from_bytes(span_of(bytes), "a.replay");
    ASSERT_FALSE(replay);
    EXPECT_EQ(replay.error().message, "a.replay: its settings are corrupt; record the run again");
  }
  // Versions before the third have no origin; the fields are ignored.
  for (const uint32_t version : {1u, 2u, 3u}) {
    const std::string bytes = settings(version, 10'000'000);
    const auto replay = Replay::from_bytes(span_of(bytes), "a.replay");
    ASSERT_TRUE(replay) << replay.error().message;
    EXPECT_EQ(replay->info().leans, version >= 2);
    EXPECT_EQ(replay->info().origin, version == 3 ? (Vec3d{1e7, -1e7, 5}) : Vec3d{});
  }
}

TEST(Recording, KeepsTheOutcomeItWasFinishedWith) {
  const ScratchFolder folder;
  const std::string path = folder.path() + "/run.replay";
  const auto run = random_run(3, 5, 4);
  for (const std::string outcome : {"", "{\"obstacles\": {}}", "12345678"}) {
    auto recorder = Recorder::create(path, two_classes());
    ASSERT_TRUE(recorder);
    for (const RecordedFrame& frame : run) ASSERT_TRUE(recorder->append(frame.view()));
    ASSERT_TRUE(recorder->finish(outcome));
    std::string bytes = bytes_of(path);
    const auto replay = Replay::from_bytes(span_of(bytes), "run");
    ASSERT_TRUE(replay) << replay.error().message;
    EXPECT_EQ(replay->outcome(), outcome);
    EXPECT_EQ(replay->damage(), "");
    if (outcome.empty()) continue;
    bytes.back() = static_cast<char>(bytes.back() ^ 1);
    const auto corrupt = Replay::from_bytes(span_of(bytes), "run");
    ASSERT_TRUE(corrupt);
    EXPECT_EQ(corrupt->frame_count(), run.size());
    EXPECT_EQ(corrupt->outcome(), "");
    EXPECT_NE(corrupt->damage(), "");
  }
}

TEST(Recording, FindsTheFrameOfATime) {
  const ScratchFolder folder;
  const std::string path = folder.path() + "/run.replay";
  const auto run = random_run(3, 50, 5);
  record(path, run, {.chunk_frames = 7});
  auto replay = Replay::open(path);
  ASSERT_TRUE(replay);
  for (double time = -1; time < 20; time += 0.05) {
    uint64_t expected = 0;
    for (uint64_t f = 0; f < run.size(); ++f) {
      if (run[f].time <= time) expected = f;
    }
    const auto found = replay->find(time);
    ASSERT_TRUE(found);
    EXPECT_EQ(*found, expected) << time;
  }
}

TEST(Recording, KeepsTheHashesOfStepsWithoutFrames) {
  const ScratchFolder folder;
  const std::string path = folder.path() + "/run.replay";
  {
    auto recorder = Recorder::create(path, two_classes(), {.chunk_frames = 3, .key_frames = 4});
    ASSERT_TRUE(recorder);
    const auto run = random_run(5, 12, 6);
    for (const RecordedFrame& frame : run) {
      for (uint64_t s = frame.step == 0 ? 0 : frame.step - 2; s < frame.step; ++s) {
        ASSERT_TRUE(recorder->append_hash(s, s * 11));
      }
      if (frame.step == 9) {
        ASSERT_TRUE(recorder->flush());
      }
      ASSERT_TRUE(recorder->append(frame.view()));
    }
    for (uint64_t s = 34; s < 1000; ++s) ASSERT_TRUE(recorder->append_hash(s, s * 11));
    EXPECT_FALSE(recorder->append_hash(999, 1));
    ASSERT_TRUE(recorder->finish());
  }
  auto replay = Replay::open(path);
  ASSERT_TRUE(replay) << replay.error().message;
  EXPECT_EQ(replay->damage(), "");
  const auto hashes = replay->step_hashes();
  ASSERT_TRUE(hashes);
  ASSERT_EQ(hashes->size(), 1000u);
  for (uint64_t s = 0; s < 1000; ++s) {
    EXPECT_EQ((*hashes)[s].step, s);
    EXPECT_EQ((*hashes)[s].state_hash, s % 3 == 0 && s < 34 ? random_u64(5, 2, s / 3) : s * 11);
  }
  RecordedFrame frame;
  for (uint64_t f = 0; f < 12; ++f) ASSERT_TRUE(replay->read(f, frame));
}

TEST(Recording, MayBeginWithHashesAlone) {
  const ScratchFolder folder;
  const std::string path = folder.path() + "/run.replay";
  auto run = random_run(5, 4, 6);
  {
    auto recorder = Recorder::create(path, two_classes());
    ASSERT_TRUE(recorder);
    ASSERT_TRUE(recorder->append_hash(0, 7));
    ASSERT_TRUE(recorder->flush());
    for (size_t f = 1; f < run.size(); ++f) ASSERT_TRUE(recorder->append(run[f].view()));
    ASSERT_TRUE(recorder->finish());
  }
  auto replay = Replay::open(path);
  ASSERT_TRUE(replay);
  EXPECT_EQ(replay->damage(), "");
  ASSERT_EQ(replay->frame_count(), 3u);
  RecordedFrame frame;
  for (uint64_t f = 0; f < 3; ++f) {
    ASSERT_TRUE(replay->read(f, frame));
    expect_same(run[f + 1], frame);
  }
}

// After a crash a chunk's head may be on disk without its bytes: all frames counted are good.
TEST(Recording, DoesNotCountALastChunkWhoseBytesAreLost) {
  const ScratchFolder folder;
  const std::string path = folder.path() + "/run.replay";
  const auto run = random_run(7, 40, 6);
  record(path, run, {.chunk_frames = 4, .key_frames = 8});
  std::string bytes = bytes_of(path);
  bytes.resize(bytes.size() - 64);  // without the chunk that marks the end
  std::fill(bytes.end() - 40, bytes.end(), '\0');
  auto replay = Replay::from_bytes(span_of(bytes), "stopped");
  ASSERT_TRUE(replay);
  EXPECT_EQ(replay->frame_count(), 36u);
  EXPECT_NE(replay->damage().find("stopped is corrupt"), std::string::npos) << replay->damage();
  RecordedFrame frame;
  for (uint64_t f = 0; f < 36; ++f) {
    ASSERT_TRUE(replay->read(f, frame));
    expect_same(run[f], frame);
  }
}

// A process that dies leaves the first bytes of the file: tests every length.
TEST(Recording, OpensFromEveryBeginningOfAFile) {
  const ScratchFolder folder;
  const std::string path = folder.path() + "/run.replay";
  const auto run = random_run(7, 40, 6);
  record(path, run, {.chunk_frames = 4, .key_frames = 8});
  const std::string bytes = bytes_of(path);
  ASSERT_LT(bytes.size(), 30000u);
  uint64_t max_frames = 0, opened = 0;
  for (size_t size = 0; size <= bytes.size(); ++size) {
    const std::string part = bytes.substr(0, size);
    auto replay = Replay::from_bytes(span_of(part), "cut");
    if (!replay) {
      EXPECT_EQ(opened, 0u) << "opened before, at " << size << ": " << replay.error().message;
      EXPECT_EQ(replay.error().code, Errc::kBadFile);
      continue;
    }
    ++opened;
    EXPECT_EQ(replay->damage().empty(), size == bytes.size());
    EXPECT_GE(replay->frame_count(), max_frames) << "fewer frames in more bytes";
    max_frames = replay->frame_count();
    // A chunk of four frames is readable once its last byte is there.
    RecordedFrame frame;
    for (uint64_t f = 0; f < replay->frame_count(); f += size % 50 == 0 ? 1 : 39) {
      ASSERT_TRUE(replay->read(f, frame));
      expect_same(run[f], frame);
    }
  }
  EXPECT_EQ(max_frames, run.size());
}

TEST(Recording, NamesWhatIsCorruptAndReadsTheRest) {
  const ScratchFolder folder;
  const std::string path = folder.path() + "/run.replay";
  const auto run = random_run(8, 40, 6);
  record(path, run, {.chunk_frames = 4, .key_frames = 8});
  const std::string bytes = bytes_of(path);
  uint64_t partly = 0;
  for (size_t at = 0; at < bytes.size(); ++at) {
    std::string damaged = bytes;
    damaged[at] = static_cast<char>(damaged[at] ^ (1 << (at % 8)));
    auto replay = Replay::from_bytes(span_of(damaged), "damaged");
    if (!replay) {
      EXPECT_EQ(replay.error().code, Errc::kBadFile);
      continue;
    }
    uint64_t lost = run.size() - replay->frame_count();
    RecordedFrame frame;
    for (uint64_t f = 0; f < replay->frame_count(); ++f) {
      const auto ok = replay->read(f, frame);
      if (ok) {
        expect_same(run[f], frame);
      } else {
        ++lost;
        EXPECT_NE(ok.error().message.find("damaged: the chunk at byte"), std::string::npos);
      }
    }
    EXPECT_TRUE(lost > 0 || !replay->damage().empty()) << "no error for byte " << at;
    partly += lost > 0 && lost < run.size() ? 1 : 0;
  }
  EXPECT_GT(partly, bytes.size() / 2);
}

TEST(Recording, HeadersOfFramesInACorruptChunkAreRefusedAndOthersRead) {
  const ScratchFolder folder;
  const std::string path = folder.path() + "/run.replay";
  const auto run = random_run(5, 12, 8);
  record(path, run, {.chunk_frames = 4, .key_frames = 4});
  const std::string bytes = bytes_of(path);
  uint64_t refused = 0;
  for (size_t at = 0; at < bytes.size(); at += 5) {
    std::string damaged = bytes;
    damaged[at] = static_cast<char>(damaged[at] ^ 4);
    auto replay = Replay::from_bytes(span_of(damaged), "damaged");
    if (!replay) continue;
    uint64_t failed = 0;
    for (uint64_t f = 0; f < replay->frame_count(); ++f) {
      const auto about = replay->frame_info(f);
      if (about) {
        EXPECT_EQ(about->step, run[f].step) << at;
        EXPECT_EQ(about->time, run[f].time) << at;
        EXPECT_EQ(about->avatars, run[f].size()) << at;
        continue;
      }
      EXPECT_EQ(about.error().code, Errc::kBadFile);
      EXPECT_NE(about.error().message.find("damaged: the chunk at byte"), std::string::npos)
          << about.error().message;
      ++failed;
    }
    EXPECT_TRUE(failed == 0 || failed == 4) << "one chunk: byte " << at;
    refused += failed;
  }
  EXPECT_GT(refused, 40u);
}

TEST(Recording, RefusesInvalidFramesAndContinues) {
  const ScratchFolder folder;
  const std::string path = folder.path() + "/run.replay";
  auto run = random_run(9, 30, 12);
  run.erase(run.begin(), run.begin() + 22);
  for (const RecordedFrame& frame : run) ASSERT_GT(frame.size(), 2u);
  auto recorder = Recorder::create(path, two_classes(), {.chunk_frames = 3, .key_frames = 4});
  ASSERT_TRUE(recorder);
  const auto refused = [&](const FrameView& view, const char* word) {
    const auto bad = recorder->append(view);
    ASSERT_FALSE(bad) << word;
    EXPECT_EQ(bad.error().code, Errc::kBadInput);
    EXPECT_NE(bad.error().message.find(word), std::string::npos) << bad.error().message;
  };
  for (const RecordedFrame& good : run) {
    RecordedFrame bad = good;
    bad.ids[1] = bad.ids[0];
    refused(bad.view(), "is there twice");
    bad = good;
    bad.positions[0].y = NAN;
    refused(bad.view(), "nowhere");
    bad.positions[0] = {0, 0, 2.1e6};
    refused(bad.view(), "2000 km");
    bad = good;
    bad.radii[0] = -1;
    refused(bad.view(), "radius");
    bad = good;
    bad.classes[2] = 2;
    refused(bad.view(), "of class 2 of 2");
    bad = good;
    bad.ids.back() = UINT64_MAX;
    refused(bad.view(), "too large");
    bad = good;
    bad.radii.pop_back();
    refused(bad.view(), "as many");
    bad = good;
    bad.time = NAN;
    refused(bad.view(), "the time");
    ASSERT_TRUE(recorder->append(good.view()));
    refused(good.view(), "the time");
    bad = good;
    bad.time += 1;
    refused(bad.view(), "steps must grow");
  }
  ASSERT_TRUE(recorder->finish());
  auto replay = Replay::open(path);
  ASSERT_TRUE(replay);
  ASSERT_EQ(replay->frame_count(), run.size());
  RecordedFrame frame;
  for (uint64_t f = 0; f < run.size(); ++f) {
    ASSERT_TRUE(replay->read(f, frame));
    expect_same(run[f], frame);
  }
  EXPECT_FALSE(Recorder::create(folder.path() + "/none/x", two_classes()));
  EXPECT_FALSE(Recorder::create(path, {}));
  EXPECT_FALSE(Recorder::create(path, two_classes(), {.chunk_frames = 0}));
  EXPECT_FALSE(Replay::open(folder.path() + "/none"));
  EXPECT_FALSE(Replay::open(folder.write("empty", "")));
  EXPECT_FALSE(Replay::open(folder.write("text", "step,id,class,x,y,z,radius\n")));
}

TEST(Recording, ADestroyedRecorderLeavesAllFrames) {
  const ScratchFolder folder;
  const std::string path = folder.path() + "/run.replay";
  const auto run = random_run(11, 10, 6);
  {
    auto recorder = Recorder::create(path, two_classes());
    for (const RecordedFrame& frame : run) ASSERT_TRUE(recorder->append(frame.view()));
  }
  auto replay = Replay::open(path);
  ASSERT_TRUE(replay);
  EXPECT_EQ(replay->frame_count(), run.size());
  EXPECT_NE(replay->damage().find("was not finished"), std::string::npos) << replay->damage();
}

TEST(Recording, BytesAfterTheEndAreNoPartOfIt) {
  const ScratchFolder folder;
  const std::string path = folder.path() + "/run.replay";
  const auto run = random_run(11, 10, 6);
  record(path, run);
  const std::string bytes = bytes_of(path);
  for (const size_t more : {size_t{1}, size_t{8}, bytes.size()}) {
    auto replay = Replay::open(folder.write("long", bytes + bytes.substr(0, more)));
    ASSERT_TRUE(replay);
    EXPECT_EQ(replay->frame_count(), run.size());
    EXPECT_EQ(replay->bytes(), bytes.size());
    EXPECT_NE(replay->damage().find("goes on after its end"), std::string::npos);
  }
  EXPECT_EQ(Replay::open(path)->damage(), "");
}

TEST(FrameCodec, HeadingsAreTheNearestOf256) {
  for (int32_t k = 0; k < 256; ++k) {
    const Heading h = record::heading_of(static_cast<uint8_t>(k));
    EXPECT_EQ(record::heading_code(h), k);
    EXPECT_NEAR(h.x * h.x + h.z * h.z, 1, 1e-6);
  }
  EXPECT_EQ(record::heading_code({0, 0}), record::heading_code({0, 1}));
  EXPECT_EQ(record::heading_code({NAN, 1}), record::heading_code({0, 1}));
}

// Avatars that walk straight at 1.34 m/s in the direction of their headings, ten frames a second.
TEST(FrameCodec, AWalkerCostsAByteAFrame) {
  record::FrameEncoder encoder;
  std::vector<uint8_t> bytes;
  RecordedFrame frame;
  constexpr size_t kWalkers = 1000, kFrames = 100;
  frame.resize(kWalkers);
  for (size_t f = 0; f < kFrames; ++f) {
    for (size_t i = 0; i < kWalkers; ++i) {
      const double turn = random_unit(1, 1, i) * 6.28;
      const double walked = 0.134 * static_cast<double>(f);
      frame.ids[i] = i;
      frame.positions[i] = {walked * std::cos(turn) + static_cast<double>(i), 0,
                            walked * std::sin(turn)};
      frame.headings[i] = {static_cast<float>(std::cos(turn)), static_cast<float>(std::sin(turn))};
      frame.radii[i] = 0.25F;
    }
    if (f == 1) bytes.clear();
    ASSERT_TRUE(encoder.encode(frame.view(), bytes));
  }
  EXPECT_LT(bytes.size(), kWalkers * (kFrames - 1));
}

}  // namespace
}  // namespace throng
