// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <utility>

#include "throng/base.h"

/// Files: mapped for reading, written whole or not at all.
namespace throng {

/// A file mapped read-only; empty files map to an empty span.
class FileMap {
 public:
  FileMap() = default;
  FileMap(FileMap&& other) noexcept : data_(std::exchange(other.data_, {})) {}
  FileMap& operator=(FileMap&& other) noexcept {
    std::swap(data_, other.data_);
    return *this;
  }
  ~FileMap();

  /// Fails with kIo and the system's reason.
  static Result<FileMap> open(const std::string& path);
  [[nodiscard]] std::span<const uint8_t> bytes() const { return data_; }
  /// Lets the system take the memory back. The bytes stay where they are and can be read at any
  /// moment, from any thread: they come from the file again.
  void give_back() const;

 private:
  std::span<const uint8_t> data_;
};

/// Writes `path`.part and renames it to `path`. Fails with kIo; then nothing is left behind.
Result<void> write_file(const std::string& path, std::span<const uint8_t> bytes);

}  // namespace throng
