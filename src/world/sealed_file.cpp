// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "world/sealed_file.h"

#include "core/hash.h"
#include "world/zone_file.h"

// Appends an XXH3 sum to a file's bytes, and checks it.
namespace throng::world {
namespace {

constexpr size_t kSum = 8;  // bytes

}  // namespace

std::vector<uint8_t> sealed(std::span<const uint8_t> content) {
  std::vector<uint8_t> file(content.begin(), content.end());
  const uint64_t sum = hash_span(content);
  for (size_t i = 0; i < kSum; ++i) file.push_back(static_cast<uint8_t>(sum >> (8 * i)));
  return file;
}

Result<std::span<const uint8_t>> unsealed(std::span<const uint8_t> file, const std::string& name) {
  if (file.size() >= kSum) {
    const auto content = file.first(file.size() - kSum), last = file.last(kSum);
    uint64_t sum = 0;
    for (size_t i = 0; i < kSum; ++i) sum |= uint64_t{last[i]} << (8 * i);
    if (sum == hash_span(content)) return content;
  }
  return bad_file(name, "its checksum is wrong, or it was written when files had none");
}

}  // namespace throng::world
