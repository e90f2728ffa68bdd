// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "core/files/scratch_file.h"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <system_error>
#include <utility>

// Removed as soon as it is open, where the system permits that.
namespace throng {
namespace fs = std::filesystem;
namespace {

#ifdef _WIN32
constexpr const char* kMode = "w+bxD";  // removed when it is closed, also if the process is killed
#else
constexpr const char* kMode = "w+bx";
#endif

bool seek(std::FILE* file, uint64_t byte) {
#ifdef _WIN32
  return _fseeki64(file, static_cast<int64_t>(byte), SEEK_SET) == 0;
#else
  return fseeko(file, static_cast<off_t>(byte), SEEK_SET) == 0;
#endif
}

}  // namespace

Result<ScratchFile> ScratchFile::create(const std::string& folder, const std::string& name) {
  constexpr int kMaxFiles = 1000;
  std::error_code error;
  fs::create_directories(folder, error);
  for (int n = 0;; ++n) {
    std::string path = (fs::path(folder) / (name + "." + std::to_string(n) + ".tmp")).string();
    errno = 0;
    std::FILE* file = std::fopen(path.c_str(), kMode);
    if (file == nullptr && errno == EEXIST && n < kMaxFiles) continue;
    if (file == nullptr) {
      return Error{Errc::kIo, path + ": cannot be written: " + std::strerror(errno)};
    }
#ifndef _WIN32
    fs::remove(path, error);
#endif
    return ScratchFile(std::move(path), file);
  }
}

ScratchFile::ScratchFile(ScratchFile&& other) noexcept
    : path_(std::move(other.path_)), file_(std::exchange(other.file_, nullptr)) {}

ScratchFile::~ScratchFile() {
  if (file_ == nullptr) return;
  std::fclose(file_);
}

bool ScratchFile::write(uint64_t offset, const void* data, size_t bytes) const {
  const std::lock_guard lock(mutex_);
  errno = 0;
  return seek(file_, offset) && std::fwrite(data, 1, bytes, file_) == bytes;
}

bool ScratchFile::read(uint64_t offset, void* data, size_t bytes) const {
  const std::lock_guard lock(mutex_);
  errno = 0;
  return seek(file_, offset) && std::fread(data, 1, bytes, file_) == bytes;
}

}  // namespace throng
