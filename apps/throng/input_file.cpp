// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "input_file.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>

#include "throng/papers.h"

// Reads whole files. Not with streams: one that is opened on a folder is good, and its first read
// throws.
namespace throng::app {

namespace {

Error unreadable(const std::string& path, int reason, const std::string& remedy) {
  const std::string what = reason == EISDIR
                               ? std::string("is a folder, not a file")
                               : fmt::format("cannot be read: {}", std::strerror(reason));
  return {reason == ENOENT ? Errc::kNotFound : Errc::kBadFile,
          fmt::format("{}: {}; {}", path, what, remedy)};
}

}  // namespace

Result<void> check_file(const std::string& path, const std::string& remedy) {
  std::error_code failed;
  const bool is_folder = std::filesystem::is_directory(path, failed);
  const int reason = is_folder ? EISDIR : access(path.c_str(), R_OK) == 0 ? 0 : errno;
  return reason == 0 ? Result<void>() : unreadable(path, reason, remedy);
}

Result<std::string> read_file(const std::string& path, const std::string& remedy) {
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rb"),
                                                             &std::fclose);
  if (file == nullptr) return unreadable(path, errno, remedy);
  std::string text;
  char block[1 << 14];
  while (const size_t count = std::fread(block, 1, sizeof block, file.get())) {
    text.append(block, count);
  }
  if (std::ferror(file.get()) != 0) return unreadable(path, errno, remedy);
  return text;
}

bool names_slices(const std::string& path) {
  std::error_code failed;
  if (std::filesystem::is_directory(path, failed)) return false;
  return path.ends_with(".slices") || is_slice_file(path);
}

Result<void> check_has_frames(const Replay& replay, const std::string& file) {
  if (replay.frame_count() > 0) return {};
  return Error{Errc::kBadFile, file + ": holds no frame; record the run again"};
}

}  // namespace throng::app
