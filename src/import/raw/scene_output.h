// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/files/part_file.h"
#include "throng/base.h"
#include "throng/scene.h"

/// What the writers of scenes share.
namespace throng::importer {

/// A PartFile that gathers what is written.
class SceneOutput {
 public:
  explicit SceneOutput(std::string path);

  template <class T>
  void put(const T& value) {
    put_bytes(&value, sizeof value);
  }
  void put_text(std::string_view text) { put_bytes(text.data(), text.size()); }
  void put_bytes(const void* data, size_t size);
  /// Writes the rest and gives the file its name. Fails with kIo.
  Result<void> close();

 private:
  static constexpr size_t kBuffer = 1 << 20;
  void flush();

  PartFile file_;
  std::vector<char> buffer_;
};

/// Fails with kBadInput if there are no triangles, or one that has no three finite corners.
Result<void> check_scene(const Scene& scene, const std::string& path);

}  // namespace throng::importer
