// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <cstdint>
#include <cstdlib>

#include "import/formats/movingai.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* bytes, size_t size) {
  const auto cells =
      throng::importer::read_grid_map({reinterpret_cast<const char*>(bytes), size}, "fuzz");
  if (!cells) {
    if (cells.error().message.empty()) std::abort();
    return 0;
  }
  const auto area = static_cast<size_t>(cells->width) * static_cast<size_t>(cells->depth);
  if (cells->passable.size() != area) std::abort();
  return 0;
}
