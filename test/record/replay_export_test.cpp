// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>

#include "core/random.h"
#include "scratch_folder.h"
#include "throng/recording.h"

namespace throng {
namespace {

// Frames at uneven steps: 4, 10, 13, 22 ... each with some of five avatars.
std::vector<RecordedFrame> uneven_run() {
  std::vector<RecordedFrame> run;
  uint64_t step = 4;
  for (uint64_t f = 0; f < 20; ++f) {
    RecordedFrame frame;
    frame.step = step;
    frame.time = static_cast<double>(step) * 0.05;
    for (uint64_t id = 0; id < 5; ++id) {
      if (random_below(1, f, id, 4) == 0) continue;
      frame.ids.push_back(id);
      frame.classes.push_back(static_cast<uint8_t>(id % 2));
      frame.positions.push_back({random_unit(2, f, id) * 90 - 45, static_cast<double>(id) * 2.5,
                                 random_unit(3, f, id) * 9});
      frame.radii.push_back(id % 2 == 0 ? 0.25F : 0.18F);
      frame.headings.push_back({1, 0});
    }
    run.push_back(frame);
    step += f == 0 ? 6 : 3 + 3 * random_below(1, 99, f, 3);
  }
  return run;
}

Replay recorded(const test::ScratchFolder& folder, const std::vector<RecordedFrame>& run,
                Vec3d origin = {}) {
  const std::string path = folder.path() + "/run.replay";
  auto recorder = Recorder::create(
      path, {.world = "x",
             .world_hash = 0,
             .dt = 0.05,
             .classes = {{.name = "adult"}, {.name = "child", .height = 1.1, .radius = 0.18}},
             .model = "",
             .settings = "",
             .origin = origin});
  EXPECT_TRUE(recorder);
  for (const RecordedFrame& frame : run) EXPECT_TRUE(recorder->append(frame.view()));
  EXPECT_TRUE(recorder->finish());
  return *Replay::open(path);
}

TEST(ReplayExport, TheFilmTakesTheWidestEvenSpacing) {
  const test::ScratchFolder folder;
  auto run = uneven_run();
  Replay replay = recorded(folder, run);
  const auto film = film_rate(replay);
  ASSERT_TRUE(film);
  EXPECT_EQ(film->first_step, 4u);
  EXPECT_EQ(film->steps, 3u);
  EXPECT_DOUBLE_EQ(film->rate, 1 / 0.15);
  for (const RecordedFrame& frame : run) EXPECT_EQ(film->frame_of(frame.step) * 3 + 4, frame.step);
  run.resize(1);
  Replay one = recorded(folder, run);
  EXPECT_EQ(film_rate(one)->steps, 1u);
  EXPECT_DOUBLE_EQ(film_rate(one)->rate, 20);
}

TEST(ReplayExport, TheFilmOfADamagedRecordingIsRefusedAndNamed) {
  const test::ScratchFolder folder;
  const std::string path = folder.path() + "/run.replay";
  auto recorder = Recorder::create(
      path, {.dt = 0.05, .classes = {{.name = "adult"}, {.name = "child"}}}, {.chunk_frames = 4});
  ASSERT_TRUE(recorder) << recorder.error().message;
  for (const RecordedFrame& frame : uneven_run()) ASSERT_TRUE(recorder->append(frame.view()));
  ASSERT_TRUE(recorder->finish());
  std::ifstream file(path, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(file), {}};
  size_t refused = 0;
  for (size_t at = 0; at < bytes.size(); at += 7) {
    std::string damaged = bytes;
    damaged[at] = static_cast<char>(damaged[at] ^ 0x20);
    auto replay =
        Replay::from_bytes({reinterpret_cast<const uint8_t*>(damaged.data()), damaged.size()}, "a");
    if (!replay) continue;
    bool is_whole = true;
    RecordedFrame frame;
    for (uint64_t f = 0; f < replay->frame_count(); ++f) {
      is_whole &= static_cast<bool>(replay->read(f, frame));
    }
    const auto film = film_rate(*replay);
    EXPECT_EQ(static_cast<bool>(film), is_whole) << "as read() does: byte " << at;
    if (film) continue;
    EXPECT_EQ(film.error().code, Errc::kBadFile);
    EXPECT_NE(film.error().message.find("a: the chunk at byte"), std::string::npos)
        << film.error().message;
    ++refused;
  }
  EXPECT_GT(refused, 20u);
}

TEST(ReplayExport, ARecordingWithoutFramesHasTheRateOfItsSteps) {
  const test::ScratchFolder folder;
  Replay replay = recorded(folder, {});
  ASSERT_EQ(replay.frame_count(), 0u);
  const auto film = film_rate(replay);
  ASSERT_TRUE(film) << film.error().message;
  EXPECT_EQ(film->steps, 1u);
  EXPECT_DOUBLE_EQ(film->rate, 20);
}

TEST(ReplayExport, ARecordingWithoutFramesIsRefusedAndNothingIsWritten) {
  const test::ScratchFolder folder;
  Replay replay = recorded(folder, {});
  Context context;
  const std::string path = folder.path() + "/a.csv";
  for (const auto& done :
       {export_csv(replay, path, {}, context), export_juelich(replay, path, {}, context)}) {
    ASSERT_FALSE(done);
    EXPECT_EQ(done.error().code, Errc::kBadFile);
    EXPECT_NE(done.error().message.find("holds no frame"), std::string::npos);
  }
  EXPECT_FALSE(std::ifstream(path).good());
  EXPECT_FALSE(std::ifstream(path + ".part").good());
}

// Of a run whose positions are moved by `origin`.
void expect_texts_to_the_millimetre(Vec3d origin) {
  const test::ScratchFolder folder;
  auto run = uneven_run();
  for (RecordedFrame& frame : run) {
    for (Vec3d& p : frame.positions) p = p + origin;
  }
  Replay replay = recorded(folder, run, origin);
  Context context;
  const std::string csv = folder.path() + "/a.csv", txt = folder.path() + "/a.txt";
  ASSERT_TRUE(export_csv(replay, csv, {}, context));
  ASSERT_TRUE(export_juelich(replay, txt, {.lowest = 2, .highest = 7.6}, context));
  std::ifstream csv_file(csv), txt_file(txt);
  std::string line;
  std::getline(csv_file, line);
  EXPECT_EQ(line, "step,id,class,x,y,z,radius");
  // As PedPy reads it: the rate is the first number of a '#' line with "framerate".
  std::getline(txt_file, line);
  EXPECT_EQ(line.substr(0, 13), "# framerate: ");
  EXPECT_NEAR(std::stod(line.substr(13)), 1 / 0.15, 1e-9);
  std::getline(txt_file, line);
  EXPECT_EQ(line, "# id frame x/m y/m z/m");
  for (const RecordedFrame& frame : run) {
    for (size_t i = 0; i < frame.size(); ++i) {
      const Vec3d& p = frame.positions[i];
      ASSERT_TRUE(std::getline(csv_file, line));
      unsigned long long step = 0, id = 0;
      char name[20];
      double x = 0, y = 0, z = 0, radius = 0;
      ASSERT_EQ(std::sscanf(line.c_str(), "%llu,%llu,%19[^,],%lf,%lf,%lf,%lf", &step, &id, name, &x,
                            &y, &z, &radius),
                7);
      EXPECT_EQ(step, frame.step);
      EXPECT_EQ(id, frame.ids[i]);
      EXPECT_EQ(std::string(name), id % 2 == 0 ? "adult" : "child");
      EXPECT_NEAR(x, p.x, 0.00051);
      EXPECT_NEAR(y, p.y, 0.00051);
      EXPECT_NEAR(z, p.z, 0.00051);
      EXPECT_FLOAT_EQ(static_cast<float>(radius), frame.radii[i]);
      if (p.y < 2 || p.y > 7.6) continue;
      uint64_t film_id = 0, film_frame = 0;
      ASSERT_TRUE(txt_file >> film_id >> film_frame >> x >> z >> y);
      EXPECT_EQ(film_id, frame.ids[i]);
      EXPECT_EQ(film_frame, (frame.step - 4) / 3);
      EXPECT_NEAR(x, p.x, 0.00051);
      EXPECT_NEAR(y, p.y, 0.00051);
      EXPECT_NEAR(z, p.z, 0.00051);
    }
  }
  EXPECT_FALSE(std::getline(csv_file, line));
  EXPECT_FALSE(txt_file >> line);
}

TEST(ReplayExport, TextsHoldEachPositionToTheMillimetre) { expect_texts_to_the_millimetre({}); }

TEST(ReplayExport, TextsHoldEachPositionToTheMillimetreFarFromTheCoordinateOrigin) {
  expect_texts_to_the_millimetre({678015, 0, -5403515});
  expect_texts_to_the_millimetre({-1e7, 0, 1e7});
}

TEST(ReplayExport, TablesHaveColumnsForAxesOnlyIfAvatarsMayLean) {
  const test::ScratchFolder folder;
  const std::string path = folder.path() + "/run.replay", csv = folder.path() + "/a.csv";
  RecordedFrame frame;
  frame.resize(2);
  frame.ids = {3, 4};
  frame.radii = {0.25F, 0.25F};
  frame.up_vectors = {{0, 1, 0}, {0.6, 0, -0.8}};
  auto recorder = Recorder::create(path, {.classes = {{.name = "climber"}}, .leans = true});
  ASSERT_TRUE(recorder);
  ASSERT_TRUE(recorder->append(frame.view()));
  ASSERT_TRUE(recorder->finish());
  auto replay = Replay::open(path);
  ASSERT_TRUE(replay);
  Context context;
  ASSERT_TRUE(export_csv(*replay, csv, {}, context));
  std::ifstream file(csv);
  std::string line;
  std::getline(file, line);
  EXPECT_EQ(line, "step,id,class,x,y,z,radius,up_x,up_y,up_z");
  std::getline(file, line);
  EXPECT_EQ(line, "0,3,climber,0.0000,0.0000,0.0000,0.2500,0.0000,1.0000,0.0000");
  std::getline(file, line);
  double x = 0, y = 0, z = 0;
  ASSERT_EQ(
      std::sscanf(line.c_str(), "0,4,climber,0.0000,0.0000,0.0000,0.2500,%lf,%lf,%lf", &x, &y, &z),
      3);
  EXPECT_NEAR(x, 0.6, 0.0011);
  EXPECT_NEAR(y, 0, 0.0011);
  EXPECT_NEAR(z, -0.8, 0.0011);
}

TEST(ReplayExport, LeavesNoFileIfItFails) {
  const test::ScratchFolder folder;
  Replay replay = recorded(folder, uneven_run());
  Context context;
  EXPECT_EQ(export_csv(replay, folder.path() + "/no/a.csv", {}, context).error().code, Errc::kIo);
  context.cancel = true;
  const auto cancelled = export_juelich(replay, folder.path() + "/a.txt", {}, context);
  ASSERT_FALSE(cancelled);
  EXPECT_EQ(cancelled.error().code, Errc::kCancelled);
  EXPECT_FALSE(std::filesystem::exists(folder.path() + "/a.txt"));
  EXPECT_FALSE(std::filesystem::exists(folder.path() + "/a.txt.part"));
}

}  // namespace
}  // namespace throng
