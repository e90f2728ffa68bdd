// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "throng/base.h"

namespace throng {

/// The lock of a folder, to hold while writing in it: exclusive, or shared with others that write
/// side by side. The system releases it when the process ends, however it ends, and nothing is
/// written for it.
class FolderLock {
 public:
  enum class Kind { kAlone, kShared };

  FolderLock() = default;  ///< Holds nothing.
  FolderLock(FolderLock&& other) noexcept;
  FolderLock& operator=(FolderLock&& other) noexcept;
  ~FolderLock();

  /// Takes the folder that is at `path` now, also if it gets another name later. Never waits: fails
  /// with kIo and a sentence about `world` if another lock is on it, in this process or another.
  /// Holds nothing where no folder is, or on a file system that cannot lock.
  static Result<FolderLock> take(const std::string& path, Kind kind, const std::string& world);
  /// Makes the folder if it is not there, and takes it alone.
  static Result<FolderLock> create(const std::string& path, const std::string& world);
  /// Lets others in that share.
  void share();
  [[nodiscard]] bool holds() const { return file_ >= 0; }

 private:
  int file_ = -1;
};

}  // namespace throng
