// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <type_traits>
#include <vector>

#include "core/hash.h"
#include "crowd/ground/body.h"

/// Arrays as the bytes of a saved crowd, and as what a state's hash is of.
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

/// Continues a hash with the rows of these bodies, in their order; with none if there are no rows.
template <class T>
uint64_t hash_rows(std::span<const Body> bodies, const std::vector<T>& by_slot, uint64_t hash) {
  static_assert(std::is_trivially_copyable_v<T>);
  if (by_slot.empty()) return hash;
  std::vector<T> rows;
  rows.reserve(bodies.size());
  for (const Body& body : bodies) rows.push_back(by_slot[body.slot]);
  return hash_bytes(rows.data(), rows.size() * sizeof(T), hash);
}

}  // namespace throng::crowd
