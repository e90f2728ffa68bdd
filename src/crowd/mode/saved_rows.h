// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <type_traits>
#include <vector>

#include "core/hash.h"

/// Arrays as the bytes of a saved crowd, and their rows as what a state's hash is of.
namespace throng::crowd {

template <class T>
void put_rows(std::vector<uint8_t>& out, const T* values, size_t count) {
  static_assert(std::is_trivially_copyable_v<T>);
  const size_t begin = out.size(), bytes = count * sizeof(T);
  out.resize(begin + bytes);
  if (bytes > 0) std::memcpy(out.data() + begin, values, bytes);
}

/// Returns what is behind the rows.
template <class T>
const uint8_t* take_rows(const uint8_t* saved, size_t count, std::vector<T>& values) {
  static_assert(std::is_trivially_copyable_v<T>);
  values.resize(count);
  const size_t bytes = count * sizeof(T);
  if (bytes > 0) std::memcpy(values.data(), saved, bytes);
  return saved + bytes;
}

/// Continues a hash with a row, if there are rows.
template <class T>
uint64_t hash_row(const std::vector<T>& by_slot, uint32_t slot, uint64_t hash) {
  static_assert(std::is_trivially_copyable_v<T>);
  return by_slot.empty() ? hash : hash_bytes(&by_slot[slot], sizeof(T), hash);
}

}  // namespace throng::crowd
