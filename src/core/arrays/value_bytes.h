// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <cstring>
#include <span>
#include <type_traits>
#include <vector>

/// Values as the bytes of messages between ranks, which run the same program.
namespace throng {

/// As many values as the bytes hold.
template <class T>
void append_values(std::span<const uint8_t> bytes, std::vector<T>& values) {
  static_assert(std::is_trivially_copyable_v<T>);
  const size_t begin = values.size(), count = bytes.size() / sizeof(T);
  values.resize(begin + count);
  if (count > 0) std::memcpy(values.data() + begin, bytes.data(), count * sizeof(T));
}

template <class T>
std::span<const uint8_t> bytes_of_span(std::span<const T> values) {
  static_assert(std::is_trivially_copyable_v<T>);
  return {reinterpret_cast<const uint8_t*>(values.data()), values.size_bytes()};
}

}  // namespace throng
