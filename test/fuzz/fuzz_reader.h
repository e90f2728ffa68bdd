// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdlib>

#include "import/raw/clean.h"
#include "import/raw/raw_scene.h"

/// What all targets for readers do: read, cut patches, clean, check the result's order.
namespace throng {

inline int fuzz_reader(Result<importer::RawScene> (*read)(std::string_view,
                                                          const importer::ReadOptions&, Context&),
                       const uint8_t* bytes, size_t size) {
  Context context;
  importer::ReadOptions options;
  options.name = "fuzz";
  auto raw = read({reinterpret_cast<const char*>(bytes), size}, options, context);
  if (!raw) return 0;
  if (const PatchSet& patches = raw->scene.patches; !patches.empty()) {
    const TessellationConfig config{.tolerance = 10, .workers = 1, .max_triangles = 1'000'000};
    const auto mesh = tessellate_patches(patches, config, context);
    if (mesh && mesh->first.size() != patches.size() + 1) std::abort();
    if (!mesh && mesh.error().message.empty()) std::abort();
  }
  if (!importer::clean_scene(raw->scene, "fuzz", context)) return 0;
  const Scene& scene = raw->scene;
  if (scene.area.size() != scene.triangles.size()) std::abort();
  for (const auto& corners : scene.triangles) {
    for (const uint32_t corner : corners) {
      if (corner >= scene.positions.size()) std::abort();
    }
  }
  return 0;
}

}  // namespace throng
