// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <cstdint>
#include <cstdlib>

#include "import/formats/movingai.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* bytes, size_t size) {
  const auto cells =
      throng::importer::read_voxel_map({reinterpret_cast<const char*>(bytes), size}, "fuzz");
  if (!cells) {
    if (cells.error().message.empty()) std::abort();
    return 0;
  }
  for (const auto& c : cells->filled) {
    if (c.x < 0 || c.y < 0 || c.z < 0 || c.x >= cells->width || c.y >= cells->height ||
        c.z >= cells->depth) {
      std::abort();
    }
  }
  return 0;
}
