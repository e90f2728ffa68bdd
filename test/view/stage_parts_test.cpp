// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include "scratch_folder.h"
#include "throng_view/viewer.h"

// Recordings and figures as parts of a stage.
namespace throng {
namespace {

constexpr int32_t kWidth = 480, kHeight = 320;

Scene floor_scene() {
  Scene scene;
  scene.add_box({0, -0.3, 0}, {20, 0, 20});
  return scene;
}

AtlasConfig figure_config() {
  AtlasConfig config;
  config.clips = {"Walk", "Idle"};
  config.frames = 4;
  config.pixels = 32;
  return config;
}

const Atlas& people() {
  static const Atlas atlas = [] {
    Context context;
    auto built = create_atlas(built_in_character(), figure_config(), context);
    return *std::move(built);
  }();
  return atlas;
}

FigureModel model_of(const AtlasConfig& config) {
  Context context;
  auto model = create_figure_model(built_in_character(), config, context);
  EXPECT_TRUE(model) << model.error().message;
  return *std::move(model);
}

Viewer loaded(const LoadStage& load) {
  Result<Drawing> drawing = Drawing::create();
  EXPECT_TRUE(drawing) << drawing.error().message;
  Result<Viewer> viewer =
      Viewer::create(*std::move(drawing), {.settings = {}, .font = {}, .panel = false});
  EXPECT_TRUE(viewer) << viewer.error().message;
  viewer->load("stage", load);
  viewer->wait_until_loaded();
  return *std::move(viewer);
}

Image picture(Viewer& viewer, double now = 0) {
  auto image = viewer.picture(now, kWidth, kHeight);
  EXPECT_TRUE(image) << image.error().message;
  return *std::move(image);
}

size_t pixels_that_differ(const Image& a, const Image& b) {
  size_t count = 0;
  for (size_t i = 0; i < a.rgb.size(); i += 3) {
    count += std::abs(a.rgb[i] - b.rgb[i]) + std::abs(a.rgb[i + 1] - b.rgb[i + 1]) > 24 ? 1 : 0;
  }
  return count;
}

void press(Viewer& viewer, Key key) {
  ViewEvent event{.kind = ViewEventKind::kKeyDown};
  event.key = key;
  viewer.handle(event);
  event.kind = ViewEventKind::kKeyUp;
  viewer.handle(event);
}

// Avatars side by side that walk along x, 10 frames a second from 5 s on.
std::string recording(const test::ScratchFolder& folder, uint64_t frames, size_t avatars = 3) {
  const std::string path = folder.path() + "/run.replay";
  auto recorder = Recorder::create(path, {.classes = {{.name = "adult"}, {.name = "child"}}},
                                   {.chunk_frames = 4, .key_frames = 4});
  EXPECT_TRUE(recorder) << recorder.error().message;
  for (uint64_t f = 0; f < frames; ++f) {
    RecordedFrame frame;
    frame.step = 50 + f;
    frame.time = 5 + 0.1 * static_cast<double>(f);
    frame.resize(avatars);
    for (size_t i = 0; i < avatars; ++i) {
      frame.ids[i] = i;
      frame.classes[i] = static_cast<uint8_t>(i % 2);
      frame.positions[i] = {4 + 0.13 * static_cast<double>(f), 0, 8 + static_cast<double>(i)};
      frame.radii[i] = 0.25F;
      frame.headings[i] = {1, 0};
    }
    EXPECT_TRUE(recorder->append(frame.view()));
  }
  EXPECT_TRUE(recorder->finish());
  return path;
}

LoadStage stage_of(const std::string& path) {
  return [path](StageParts& parts, Context&) -> Result<void> {
    if (auto ok = parts.set_scene(floor_scene()); !ok) return ok;
    parts.set_atlases({{people()}});
    auto replay = Replay::open(path);
    if (!replay) return replay.error();
    parts.set_replay(*std::move(replay));
    return {};
  };
}

TEST(StageParts, ARecordingIsShownFromItsFirstFrameToItsLast) {
  const test::ScratchFolder folder;
  Viewer viewer = loaded(stage_of(recording(folder, 31)));
  viewer.look_at({10, 4, 18}, {7, 0.5, 9});
  viewer.play_for(0);
  const Image first = picture(viewer);
  EXPECT_EQ(viewer.status().error, "");
  EXPECT_EQ(viewer.status().avatars, 3U);
  EXPECT_EQ(viewer.status().drawn, 3U);
  EXPECT_NEAR(viewer.status().time, 5, 1e-9);
  EXPECT_NEAR(viewer.status().last_time, 8, 1e-9);
  viewer.play_for(1.5);
  const Image later = picture(viewer);
  EXPECT_NEAR(viewer.status().time, 6.5, 1e-9);
  EXPECT_GT(pixels_that_differ(first, later), 200U) << "they have walked";
  viewer.play_for(100);
  (void)picture(viewer);
  EXPECT_NEAR(viewer.status().time, 8, 1e-9);
  EXPECT_EQ(viewer.status().avatars, 3U);
}

TEST(StageParts, ARecordingWithoutFramesShowsNoAvatar) {
  const test::ScratchFolder folder;
  Viewer viewer = loaded(stage_of(recording(folder, 0)));
  viewer.look_at({10, 4, 18}, {7, 0.5, 9});
  const Image empty = picture(viewer);
  for (const Key key : {Key::kSpace, Key::kSpace, Key::kPeriod, Key::kComma, Key::kHome, Key::kEnd,
                        Key::kLeft, Key::kRight}) {
    press(viewer, key);
    viewer.play_for(0.3);
    (void)picture(viewer, 1);
  }
  EXPECT_EQ(viewer.status().error, "");
  EXPECT_EQ(viewer.status().avatars, 0U);
  EXPECT_EQ(viewer.status().last_time, 0);
  viewer.look_at({10, 4, 18}, {7, 0.5, 9});
  EXPECT_EQ(pixels_that_differ(picture(viewer, 2), empty), 0U);
}

// How many frames of a recording of `frames` cannot be read; all of them if it is cut short.
uint64_t frames_lost(const std::string& path, uint64_t frames) {
  auto replay = Replay::open(path);
  if (!replay || replay->frame_count() != frames) return frames;
  RecordedFrame frame;
  uint64_t lost = 0;
  for (uint64_t f = 0; f < frames; ++f) lost += replay->read(f, frame) ? 0 : 1;
  return lost;
}

TEST(StageParts, FramesOfACorruptChunkAreLeftOut) {
  const test::ScratchFolder folder;
  const std::string path = recording(folder, 31);
  std::ifstream file(path, std::ios::binary);
  const std::string whole{std::istreambuf_iterator<char>(file), {}};
  file.close();
  // In the contents of a chunk in the middle, not in its head.
  for (size_t at = whole.size() / 2; frames_lost(path, 31) != 4; ++at) {
    ASSERT_LT(at, whole.size());
    std::string bytes = whole;
    bytes[at] = static_cast<char>(bytes[at] ^ 4);
    folder.write("run.replay", bytes);
  }
  Viewer viewer = loaded(stage_of(path));
  for (int32_t k = 0; k < 40; ++k) {
    viewer.play_for(0.1);
    (void)picture(viewer);
    EXPECT_EQ(viewer.status().avatars, 3U) << k;
  }
  EXPECT_NEAR(viewer.status().time, 8, 1e-9);
}

// Looks at the same frame of a recording with figures of one kind and another.
struct Looks {
  Image near, far;
  std::string error;
};

Looks looks_of(const std::string& path, const std::vector<std::vector<ViewFigure>>& figures) {
  Viewer viewer = loaded([&](StageParts& parts, Context&) -> Result<void> {
    if (auto ok = parts.set_scene(floor_scene()); !ok) return ok;
    parts.set_figures(figures);
    auto replay = Replay::open(path);
    if (!replay) return replay.error();
    parts.set_replay(*std::move(replay));
    return {};
  });
  viewer.play_for(0);
  viewer.look_at({7, 1.7, 9}, {4, 1, 9});
  Looks out{.near = picture(viewer), .far = {}, .error = {}};
  viewer.look_at({60, 20, 70}, {4, 1, 9});
  out.far = picture(viewer);
  out.error = viewer.status().error;
  return out;
}

TEST(StageParts, FiguresAreMeshesNearTheEyeAndAtlasesFarFromIt) {
  const test::ScratchFolder folder;
  const std::string path = recording(folder, 8);
  const Looks flat = looks_of(path, {{{.atlas = people()}}});
  const Looks meshes = looks_of(path, {{{.atlas = people(), .model = model_of(figure_config())}}});
  EXPECT_EQ(flat.error + meshes.error, "");
  EXPECT_GT(pixels_that_differ(flat.near, meshes.near), 300U);
  EXPECT_EQ(flat.far.rgb, meshes.far.rgb);
  // The last entry serves all further classes.
  const Looks each = looks_of(path, {{{.atlas = people(), .model = model_of(figure_config())}},
                                     {{.atlas = people(), .model = model_of(figure_config())}}});
  EXPECT_EQ(each.near.rgb, meshes.near.rgb);
}

TEST(StageParts, AFigureWithOtherClipsThanItsAtlasIsNamedAndShownWithoutMesh) {
  const test::ScratchFolder folder;
  const std::string path = recording(folder, 8);
  const Looks flat = looks_of(path, {{{.atlas = people()}}});
  AtlasConfig config = figure_config();
  config.clips = {"Walk"};
  const Looks other = looks_of(path, {{{.atlas = people(), .model = model_of(config)}}});
  EXPECT_NE(other.error.find("clips"), std::string::npos) << other.error;
  EXPECT_EQ(other.near.rgb, flat.near.rgb);
  const Looks none = looks_of(path, {});
  EXPECT_EQ(none.error, "");
  EXPECT_GT(pixels_that_differ(none.near, flat.near), 300U) << "without figures no avatar";
  EXPECT_EQ(looks_of(path, {{}, {}}).near.rgb, none.near.rgb);
  EXPECT_EQ(looks_of(path, {{}, {{.atlas = people()}}}).error, "");
}

}  // namespace
}  // namespace throng
