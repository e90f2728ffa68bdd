// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdio>
#include <string>
#include <string_view>

#include "throng/base.h"

/// A text file that is either complete or not there: written as PATH.part, renamed by finish().
namespace throng::app {

class OutputFile {
 public:
  OutputFile() = default;
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;
  ~OutputFile();  ///< Removes the part file if finish() was not reached.

  /// Fails with kIo and the reason.
  Result<void> open(const std::string& path);
  [[nodiscard]] bool is_open() const { return file_ != nullptr; }
  /// A write that fails is reported by finish().
  void write(std::string_view text);
  Result<void> finish();

 private:
  [[nodiscard]] Error error(const char* what) const;

  std::string path_;
  std::string part_;
  std::FILE* file_ = nullptr;
  bool failed_ = false;
};

}  // namespace throng::app
