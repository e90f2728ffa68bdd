// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "core/files/config_file.h"
#include "import/scene_config.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* bytes, size_t size) {
  const std::string text(reinterpret_cast<const char*>(bytes), size);
  const auto root = throng::parse_config(text, "fuzz");
  if (!root) return 0;
  const auto read = throng::importer::read_scene_config(*root, "fuzz", "");
  return read || !read.error().message.empty() ? 0 : -1;
}
