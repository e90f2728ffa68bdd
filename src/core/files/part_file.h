// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdio>
#include <string>

#include "throng/base.h"

namespace throng {

/// A file that is NAME.part until it is whole. Remembers the first failure.
class PartFile {
 public:
  explicit PartFile(std::string path);
  PartFile(const PartFile&) = delete;
  PartFile& operator=(const PartFile&) = delete;
  ~PartFile();  ///< Not closed: nothing is left.

  void write(const void* data, size_t size);
  /// Gives the file its name. Fails with kIo and the system's reason; then nothing is left.
  [[nodiscard]] Result<void> close();

 private:
  std::string path_, part_;
  std::FILE* file_;
  int reason_ = 0;  // errno of the first failure
};

}  // namespace throng
