// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <cstdlib>
#include <span>

#include "impostor/atlas_file.h"

// An atlas that passes the checks can be converted and drawn without reading past its arrays.
extern "C" int LLVMFuzzerTestOneInput(const uint8_t* bytes, size_t size) {
  const auto atlas = throng::impostor::read_atlas(std::span(bytes, size), "fuzz");
  if (!atlas || atlas->mask.size() > (1 << 20)) return 0;
  const auto plain = throng::convert_atlas(*atlas, throng::AtlasFormat::kRgba8, 1);
  if (plain.colour.size() != plain.mask.size() * 4) std::abort();
  static volatile uint32_t sum = 0;
  for (const uint8_t value : throng::draw_atlas(plain, 0).rgb) sum = sum + value;
  return 0;
}
