// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cstdlib>
#include <vector>

#include "papers/slices/slice_file.h"

// Slices that pass the checks can be drawn and walked on. The checksum would stop the fuzzer, so it
// is left out: the checks behind it must not rely on it.
extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace throng;
  // A copy of the exact size, so that the sanitizer detects a read past its end.
  const std::vector<uint8_t> bytes(data, data + size);
  auto stored = papers::decode_slices(bytes, "fuzz");
  if (!stored) {
    if (stored.error().message.empty()) std::abort();
    return 0;
  }
  const DepthSlices& slices = stored->slices;
  static volatile uint64_t sum = 0;
  sum = sum + papers::sum_of(slices);
  if (!papers::is_sound(slices)) return 0;
  sum = sum + draw_slice(slices, slices.slices.size() - 1).rgb.size();
  const auto avatars = static_cast<uint32_t>(std::min<uint64_t>(slices.bytes() / 64, 5));
  const SliceWanderConfig config{.groups = {{AvatarClass{}, avatars}}, .workers = 1};
  auto crowd = SliceWanderers::create(stored->slices, config);
  for (int step = 0; crowd && step < 3; ++step) sum = sum + crowd->step().moved;
  return 0;
}
