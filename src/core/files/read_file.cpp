// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "core/files/read_file.h"

#include <cstdio>
#include <filesystem>
#include <memory>
#include <system_error>

// Reads a whole file into memory.
namespace throng {

Result<std::string> read_file(const std::string& path) {
  std::error_code failure;
  const auto status = std::filesystem::status(path, failure);
  if (!std::filesystem::exists(status)) {
    return Error{Errc::kBadFile, path + ": no such file; check the path"};
  }
  if (std::filesystem::is_directory(status)) {
    return Error{Errc::kBadFile, path + ": is a folder, not a file; name a file inside it"};
  }
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rb"),
                                                             &std::fclose);
  if (!file) return Error{Errc::kIo, path + ": cannot be opened; check its permissions"};

  std::string bytes;
  const auto expected = std::filesystem::file_size(path, failure);
  if (!failure)
    bytes.reserve(expected);  // Pipes have no size: they are read in pieces all the same.
  char piece[1 << 16];
  while (const size_t got = std::fread(piece, 1, sizeof piece, file.get()))
    bytes.append(piece, got);
  if (std::ferror(file.get()) != 0)
    return Error{Errc::kIo, path + ": reading it failed before its end"};
  return bytes;
}

}  // namespace throng
