// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "patch_bytes.h"

#include <gtest/gtest.h>

#include "core/random.h"
#include "throng/scene.h"

// Prefixes and single changed bytes of a file of patches.
namespace throng::test {

Result<importer::RawScene> PatchReader::read(const std::string& bytes) const {
  Context context;
  importer::ReadOptions options;
  options.name = name;
  return read_bytes(bytes, options, context);
}

std::string PatchReader::fault_of(const std::string& bytes) const {
  const auto raw = read(bytes);
  EXPECT_FALSE(raw);
  if (raw) return "";
  EXPECT_EQ(raw.error().code, Errc::kBadFile);
  return raw.error().message;
}

uint64_t PatchReader::survive(const std::string& whole, const std::string& where, size_t stride,
                              uint64_t seed, uint64_t count) const {
  uint64_t kept = 0;
  const auto use = [&](const std::string& bytes) {
    const auto raw = read(bytes);
    if (!raw) {
      EXPECT_EQ(raw.error().message.rfind(where, 0), 0u) << raw.error().message;
      return;
    }
    Context context;
    const auto mesh = tessellate_patches(raw->scene.patches, {.tolerance = 1}, context);
    EXPECT_TRUE(mesh || !mesh.error().message.empty());
    ++kept;
  };
  for (size_t size = 0; size + 1 < whole.size(); size += stride) use(whole.substr(0, size));
  for (uint64_t i = 0; i < count; ++i) {
    std::string bytes = whole;
    bytes[random_below(seed, i, 0, bytes.size())] = static_cast<char>(
        i % 2 == 0 ? random_below(seed, i, 1, 256) : '0' + random_below(seed, i, 1, 10));
    use(bytes);
  }
  return kept;
}

}  // namespace throng::test
