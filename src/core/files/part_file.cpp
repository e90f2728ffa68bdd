// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "core/files/part_file.h"

#include <cerrno>
#include <cstring>
#include <utility>

// Writes a file under the name NAME.part and renames it when it is whole.
namespace throng {

PartFile::PartFile(std::string path)
    : path_(std::move(path)), part_(path_ + ".part"), file_(std::fopen(part_.c_str(), "wb")) {
  if (file_ == nullptr) reason_ = errno;
}

PartFile::~PartFile() {
  if (file_ == nullptr) return;
  std::fclose(file_);
  std::remove(part_.c_str());
}

void PartFile::write(const void* data, size_t size) {
  if (reason_ != 0 || size == 0) return;
  if (std::fwrite(data, 1, size, file_) != size) reason_ = errno != 0 ? errno : EIO;
}

Result<void> PartFile::close() {
  const bool was_open = file_ != nullptr;
  const auto note = [&](bool done) {
    if (!done && reason_ == 0) reason_ = errno != 0 ? errno : EIO;
  };
  if (was_open) note(std::fclose(std::exchange(file_, nullptr)) == 0);
  if (reason_ == 0) note(std::rename(part_.c_str(), path_.c_str()) == 0);
  if (reason_ == 0) return {};
  if (was_open) std::remove(part_.c_str());
  return Error{Errc::kIo, path_ + ": cannot write: " + std::strerror(reason_) +
                              "; check the folder, its rights and the free space"};
}

}  // namespace throng
