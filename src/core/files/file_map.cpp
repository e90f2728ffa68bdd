// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "core/files/file_map.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "core/files/part_file.h"

// Maps files read-only, and writes files whole: to NAME.part, then renamed.
namespace throng {
namespace {

Error io_error(const std::string& path, const char* what) {
  return {Errc::kIo, path + ": cannot be " + what + ": " + std::strerror(errno)};
}

}  // namespace

FileMap::~FileMap() {
  if (!data_.empty()) munmap(const_cast<uint8_t*>(data_.data()), data_.size());
}

void FileMap::give_back() const {
  if (!data_.empty()) madvise(const_cast<uint8_t*>(data_.data()), data_.size(), MADV_DONTNEED);
}

Result<FileMap> FileMap::open(const std::string& path) {
  const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (file < 0) return io_error(path, "opened");
  struct stat info {};
  if (fstat(file, &info) != 0) {
    Error error = io_error(path, "read");
    close(file);
    return error;
  }
  if (S_ISDIR(info.st_mode)) {
    close(file);
    return Error{Errc::kIo, path + ": is a folder, a file was expected"};
  }
  FileMap map;
  const auto size = static_cast<size_t>(info.st_size);
  if (size > 0) {
    void* data = mmap(nullptr, size, PROT_READ, MAP_PRIVATE, file, 0);
    if (data == MAP_FAILED) {
      Error error = io_error(path, "mapped");
      close(file);
      return error;
    }
    map.data_ = {static_cast<const uint8_t*>(data), size};
  }
  close(file);
  return map;
}

Result<void> write_file(const std::string& path, std::span<const uint8_t> bytes) {
  PartFile file(path);
  file.write(bytes.data(), bytes.size());
  return file.close();
}

}  // namespace throng
