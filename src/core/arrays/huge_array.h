// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <type_traits>

/// Large tables that are read here and there.
namespace throng {

/// How the system should back an array.
enum class Pages : uint8_t {
  kSmall,  ///< 4 KiB: memory is taken only around what is touched.
  kHuge,   ///< 2 MiB where the system has them: fewer misses of the address cache.
};

struct UnmapPages {
  size_t bytes = 0;
  void operator()(void* p) const;
};

/// Zeroed memory straight from the system; it is taken when first touched.
class ZeroedBytes {
 public:
  ZeroedBytes() = default;
  ZeroedBytes(size_t bytes, Pages pages);
  [[nodiscard]] void* data() const { return data_.get(); }
  /// Gives the memory of whole pages back, which are zero from then on.
  void give_back(size_t first, size_t bytes) const;

 private:
  std::unique_ptr<void, UnmapPages> data_;
};

/// An array of fixed size that starts as zeros.
template <class T>
class HugeArray {
  static_assert(std::is_trivially_copyable_v<T> && std::is_trivially_destructible_v<T>);

 public:
  HugeArray() = default;
  explicit HugeArray(size_t size, Pages pages = Pages::kHuge)
      : bytes_(size * sizeof(T), pages), size_(size) {}

  [[nodiscard]] T* data() const { return static_cast<T*>(bytes_.data()); }
  [[nodiscard]] size_t size() const { return size_; }
  [[nodiscard]] std::span<T> span() const { return {data(), size_}; }
  [[nodiscard]] T& operator[](size_t i) const { return data()[i]; }
  /// What lies in whole pages of these is zero from now on, and takes no memory.
  void give_back(size_t first, size_t count) const {
    bytes_.give_back(first * sizeof(T), count * sizeof(T));
  }

 private:
  ZeroedBytes bytes_;
  size_t size_ = 0;
};

}  // namespace throng
