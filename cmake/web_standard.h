// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

// What Emscripten 3.1.6's standard library lacks of C++20 and this code uses: included before every
// file of the build for browsers, and by nothing else.
#include <version>

#ifndef __cpp_lib_bit_cast
#include <algorithm>
#include <bit>
#include <cerrno>
#include <charconv>
#include <cstdlib>
#include <iterator>
#include <memory>
#include <string>
#include <string_view>
#include <type_traits>

namespace std {

template <class To, class From>
[[nodiscard]] constexpr To bit_cast(const From& from) noexcept {
  return __builtin_bit_cast(To, from);
}

template <class T>
[[nodiscard]] unique_ptr<T> make_unique_for_overwrite() {
  return unique_ptr<T>(new T);
}

template <class T>
requires is_unbounded_array_v<T>
[[nodiscard]] unique_ptr<T> make_unique_for_overwrite(size_t count) {
  return unique_ptr<T>(new remove_extent_t<T>[count]);
}

namespace ranges {
template <class A, class B>
[[nodiscard]] constexpr bool equal(const A& a, const B& b) {
  return std::equal(std::begin(a), std::end(a), std::begin(b), std::end(b));
}
template <class Range, class Predicate>
[[nodiscard]] constexpr bool all_of(const Range& range, Predicate is_so) {
  return std::all_of(std::begin(range), std::end(range), is_so);
}
template <class Range, class Predicate>
[[nodiscard]] constexpr bool any_of(const Range& range, Predicate is_so) {
  return std::any_of(std::begin(range), std::end(range), is_so);
}
template <class Range, class Predicate>
[[nodiscard]] constexpr bool none_of(const Range& range, Predicate is_so) {
  return std::none_of(std::begin(range), std::end(range), is_so);
}
}  // namespace ranges

// strtod wants an end of its own, and would take a plus sign, spaces and hexadecimals.
inline from_chars_result from_chars(const char* from, const char* end, double& value) {
  constexpr string_view kLetters = "0123456789.-+eEinfatyINFATY";
  const char* stop = from;
  while (stop != end && kLetters.find(*stop) != string_view::npos) ++stop;
  const string text(from, stop);
  if (text.empty() || text.front() == '+') return {from, errc::invalid_argument};
  char* after = nullptr;
  errno = 0;
  const double read = strtod(text.c_str(), &after);
  if (after == text.c_str()) return {from, errc::invalid_argument};
  stop = from + (after - text.c_str());
  if (errno == ERANGE && (read == 0 || read > 1 || read < -1)) {
    return {stop, errc::result_out_of_range};
  }
  value = read;
  return {stop, errc()};
}

}  // namespace std
#endif
