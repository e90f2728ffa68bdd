// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <mutex>
#include <string>

#include "throng/base.h"

/// A file for what memory does not hold, which goes with the object.
namespace throng {

/// From several threads at a time.
class ScratchFile {
 public:
  /// A new file in a folder, which is made if it is not there. A killed process leaves none behind.
  /// Fails with kIo.
  static Result<ScratchFile> create(const std::string& folder, const std::string& name);
  ScratchFile(ScratchFile&& other) noexcept;
  ScratchFile& operator=(ScratchFile&&) = delete;
  ~ScratchFile();

  /// False if it cannot be done; errno says why. `offset`: where it begins. [bytes]
  [[nodiscard]] bool write(uint64_t offset, const void* data, size_t bytes) const;
  [[nodiscard]] bool read(uint64_t offset, void* data, size_t bytes) const;
  [[nodiscard]] const std::string& path() const { return path_; }

 private:
  ScratchFile(std::string path, std::FILE* file) : path_(std::move(path)), file_(file) {}

  std::string path_;
  std::FILE* file_ = nullptr;
  mutable std::mutex mutex_;  // of the file's position
};

}  // namespace throng
