// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "output_file.h"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>

// A text file written as PATH.part and renamed when it is complete.
namespace throng::app {

Error OutputFile::error(const char* what) const {
  return {Errc::kIo,
          fmt::format("{}: cannot {}: {}; check the folder, its rights and the free space", path_,
                      what, std::strerror(errno))};
}

OutputFile::~OutputFile() {
  if (file_ == nullptr) return;
  std::fclose(file_);
  std::remove(part_.c_str());
}

Result<void> OutputFile::open(const std::string& path) {
  path_ = path;
  part_ = path + ".part";
  file_ = std::fopen(part_.c_str(), "wb");
  if (file_ == nullptr) return error("write");
  return {};
}

void OutputFile::write(std::string_view text) {
  failed_ |= std::fwrite(text.data(), 1, text.size(), file_) != text.size();
}

Result<void> OutputFile::finish() {
  failed_ |= std::fflush(file_) != 0;
  failed_ |= std::fclose(file_) != 0;
  file_ = nullptr;
  if (!failed_ && std::rename(part_.c_str(), path_.c_str()) == 0) return {};
  const Error result = error("write");
  std::remove(part_.c_str());
  return result;
}

}  // namespace throng::app
