// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "import/scene_output.h"

#include <fmt/format.h>

#include <cmath>
#include <utility>

namespace throng {

SceneOutput::SceneOutput(std::string path)
    : path_(std::move(path)),
      part_(path_ + ".part"),
      file_(std::fopen(part_.c_str(), "wb")),
      good_(file_ != nullptr) {
  buffer_.reserve(kBuffer);
}

SceneOutput::~SceneOutput() {
  if (file_ == nullptr) return;
  std::fclose(file_);
  std::remove(part_.c_str());
}

void SceneOutput::put_bytes(const void* data, size_t size) {
  if (buffer_.size() + size > kBuffer) flush();
  const auto* bytes = static_cast<const char*>(data);
  buffer_.insert(buffer_.end(), bytes, bytes + size);
}

void SceneOutput::flush() {
  if (buffer_.empty()) return;
  if (good_ && std::fwrite(buffer_.data(), 1, buffer_.size(), file_) != buffer_.size())
    good_ = false;
  buffer_.clear();
}

Result<void> SceneOutput::close() {
  flush();
  if (file_ != nullptr && std::fclose(file_) != 0) good_ = false;
  file_ = nullptr;
  if (good_ && std::rename(part_.c_str(), path_.c_str()) == 0) return {};
  std::remove(part_.c_str());
  return Error{Errc::kIo,
               fmt::format("{}: cannot be written; check the folder and the free space", path_)};
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

}  // namespace throng
