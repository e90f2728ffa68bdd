// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "window/user_files.h"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include "input_file.h"

// Files in the XDG folders of a user.
namespace throng::app {

namespace fs = std::filesystem;

std::string user_file(UserFolder folder, const std::string& name) {
  const bool config = folder == UserFolder::kConfig;
  const char* base = std::getenv(config ? "XDG_CONFIG_HOME" : "XDG_CACHE_HOME");
  // The rule: what is not absolute counts as not set.
  if (base != nullptr && base[0] == '/') return (fs::path(base) / "throng" / name).string();
  const char* home = std::getenv("HOME");
  if (home == nullptr || home[0] != '/') return {};
  return (fs::path(home) / (config ? ".config" : ".cache") / "throng" / name).string();
}

bool make_folder_of(const std::string& file) {
  std::error_code error;
  fs::create_directories(fs::path(file).parent_path(), error);
  return !error;
}

std::string read_text(const std::string& file) {
  const auto text = read_file(file, "");
  return text ? *text : std::string();
}

bool write_text(const std::string& file, const std::string& text) {
  if (!make_folder_of(file)) return false;
  const std::string beside = file + ".new";
  {
    std::ofstream out(beside, std::ios::binary);
    out << text;
    if (!out.flush()) return false;
  }
  std::error_code error;
  fs::rename(beside, file, error);
  return !error;
}

}  // namespace throng::app
