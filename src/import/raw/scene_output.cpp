// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "import/raw/scene_output.h"

#include <fmt/format.h>

#include <cmath>
#include <utility>

// Buffers what is written to a scene file, and checks the triangles before.
namespace throng::importer {

SceneOutput::SceneOutput(std::string path) : file_(std::move(path)) { buffer_.reserve(kBuffer); }

void SceneOutput::put_bytes(const void* data, size_t size) {
  if (buffer_.size() + size > kBuffer) flush();
  const auto* bytes = static_cast<const char*>(data);
  buffer_.insert(buffer_.end(), bytes, bytes + size);
}

void SceneOutput::flush() {
  file_.write(buffer_.data(), buffer_.size());
  buffer_.clear();
}

Result<void> SceneOutput::close() {
  flush();
  return file_.close();
}

Result<void> check_scene(const Scene& scene, const std::string& path) {
  if (scene.triangles.empty()) {
    return Error{Errc::kBadInput, fmt::format("{}: the scene has no triangles to write", path)};
  }
  for (size_t t = 0; t < scene.triangles.size(); ++t) {
    for (const uint32_t corner : scene.triangles[t]) {
      if (corner >= scene.positions.size()) {
        return Error{Errc::kBadInput,
                     fmt::format("{}: triangle {} uses corner {} of {}; give it corners that exist",
                                 path, t, corner, scene.positions.size())};
      }
      const Vec3d& p = scene.positions[corner];
      if (!(std::fabs(p.x) < 1e30 && std::fabs(p.y) < 1e30 && std::fabs(p.z) < 1e30)) {
        return Error{
            Errc::kBadInput,
            fmt::format("{}: corner {} is not a finite place; drop triangle {}", path, corner, t)};
      }
    }
  }
  return {};
}

}  // namespace throng::importer
