// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <cstdio>

#include "core/random.h"
#include "support/counted_allocations.h"
#include "throng/recording.h"

// A program of its own, because it counts every allocation: a warm recorder makes none, while
// avatars walk, turn, enter and leave and chunks and keys are written.
int main(int, char** arguments) {
  using namespace throng;
  const std::string path = std::string(arguments[0]) + ".replay";
  Recorder recorder = need(Recorder::create(
      path, {.dt = 0.1, .classes = {{.name = "adult"}}, .model = "test"}, {.key_frames = 64}));
  RecordedFrame frame;
  uint64_t warm = 0;
  constexpr uint64_t kFrames = 1000, kWarm = 300, kAvatars = 400;
  for (uint64_t f = 0; f < kFrames; ++f) {
    // A moving window of ids: as many enter as leave; in descending order, so that they are sorted.
    frame.resize(kAvatars);
    frame.time = 0.1 * static_cast<double>(f);
    frame.step = f;
    for (uint64_t i = 0; i < kAvatars; ++i) {
      const uint64_t id = f / 3 + kAvatars - i;
      frame.ids[i] = id;
      frame.positions[i] = {0.13 * static_cast<double>(f) + random_unit(1, f, id) * 0.2, 0,
                            static_cast<double>(id)};
      frame.radii[i] = 0.25F;
      frame.headings[i] = {1, static_cast<float>(random_unit(2, f / 7, id))};
    }
    if (f == kWarm) warm = g_allocations;
    if (const auto ok = recorder.append(frame.view()); !ok) {
      return std::fprintf(stderr, "%s\n", ok.error().message.c_str()), 1;
    }
  }
  const uint64_t late = g_allocations - warm;
  std::printf("%llu allocations until frame %llu, %llu after it\n",
              static_cast<unsigned long long>(warm), static_cast<unsigned long long>(kWarm),
              static_cast<unsigned long long>(late));
  const bool finished = static_cast<bool>(recorder.finish());
  std::remove(path.c_str());
  return finished && warm > 0 && late == 0 ? 0 : 1;
}
