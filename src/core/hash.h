// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

/// Hashes for files, states and golden tests (XXH3, 64 bit).
namespace throng {

uint64_t hash_bytes(const void* data, size_t size, uint64_t seed = 0);

template <class T>
uint64_t hash_span(std::span<const T> values, uint64_t seed = 0) {
  static_assert(std::has_unique_object_representations_v<T>, "padding would make hashes differ");
  return hash_bytes(values.data(), values.size_bytes(), seed);
}

}  // namespace throng
