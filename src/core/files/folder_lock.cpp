// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "core/files/folder_lock.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <system_error>
#include <utility>

// The folder itself is locked, not a file in it or beside it: a lock on it goes with it when it
// gets another name, and no file is left to clear away.
namespace throng {
namespace {

bool is_at(int file, const std::string& path) {
  struct stat held {};
  struct stat there {};
  return fstat(file, &held) == 0 && stat(path.c_str(), &there) == 0 &&
         held.st_dev == there.st_dev && held.st_ino == there.st_ino;
}

}  // namespace

FolderLock::FolderLock(FolderLock&& other) noexcept : file_(std::exchange(other.file_, -1)) {}

FolderLock& FolderLock::operator=(FolderLock&& other) noexcept {
  std::swap(file_, other.file_);
  return *this;
}

FolderLock::~FolderLock() {
  if (file_ >= 0) close(file_);
}

Result<FolderLock> FolderLock::take(const std::string& path, Kind kind, const std::string& world) {
  while (true) {
    FolderLock lock;
    lock.file_ = open(path.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (lock.file_ < 0) return lock;
    if (flock(lock.file_, (kind == Kind::kAlone ? LOCK_EX : LOCK_SH) | LOCK_NB) != 0) {
      if (errno != EWOULDBLOCK) return FolderLock();
      return Error{Errc::kIo, world +
                                  ": another bake is writing it; wait until that has ended, or "
                                  "write into another folder"};
    }
    // Between the two calls it may have got another name, or have been removed.
    if (is_at(lock.file_, path)) return lock;
  }
}

// Another process may have removed the folder before it was locked: then it is made again.
Result<FolderLock> FolderLock::create(const std::string& path, const std::string& world) {
  while (true) {
    std::error_code error;
    std::filesystem::create_directories(path, error);
    if (error) return Error{Errc::kIo, path + ": cannot be created: " + error.message()};
    auto lock = take(path, Kind::kAlone, world);
    if (!lock || lock->holds() || std::filesystem::exists(path, error)) return lock;
  }
}

void FolderLock::share() {
  if (file_ >= 0) flock(file_, LOCK_SH | LOCK_NB);
}

}  // namespace throng
