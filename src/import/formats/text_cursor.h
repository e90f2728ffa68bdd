// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <charconv>
#include <string_view>

/// Reads numbers from text, with the same result on every machine and in every locale.
namespace throng::importer {

/// A position in a text, which advances as tokens are read.
class TextCursor {
 public:
  explicit TextCursor(std::string_view text) : at_(text.data()), end_(text.data() + text.size()) {}

  [[nodiscard]] bool at_end() const { return at_ == end_; }
  [[nodiscard]] char peek() const { return at_ == end_ ? '\0' : *at_; }
  void skip() { at_ += at_ == end_ ? 0 : 1; }
  void skip_space() {
    while (at_ != end_ && is_space(*at_)) ++at_;
  }
  [[nodiscard]] std::string_view rest() const { return {at_, static_cast<size_t>(end_ - at_)}; }

  /// Takes a number after any space; stays in place if there is none.
  bool take(double& value) {
    const char* from = number_start();
    const auto [stop, failure] = std::from_chars(from, end_, value);
    if (failure == std::errc::result_out_of_range)
      value = 1e308;  // Dropped later as non-finite.
    else if (failure != std::errc())
      return false;
    at_ = stop;
    return true;
  }
  bool take(long long& value) {
    const char* from = number_start();
    const auto [stop, failure] = std::from_chars(from, end_, value);
    if (failure != std::errc()) return false;
    at_ = stop;
    return true;
  }
  /// Takes the text up to the next space.
  std::string_view take_word() {
    skip_space();
    const char* from = at_;
    while (at_ != end_ && !is_space(*at_)) ++at_;
    return {from, static_cast<size_t>(at_ - from)};
  }
  /// Takes all that is left, without the space around it.
  std::string_view take_rest() {
    skip_space();
    std::string_view left = rest();
    while (!left.empty() && is_space(left.back())) left.remove_suffix(1);
    at_ = end_;
    return left;
  }
  static bool is_space(char c) {
    return c == ' ' || c == '\t' || c == '\n' || c == '\r' || c == '\f' || c == '\v';
  }

 private:
  const char* number_start() {
    skip_space();
    return at_ + 1 < end_ && *at_ == '+' && at_[1] != '-' ? at_ + 1 : at_;
  }

  const char* at_;
  const char* end_;
};

}  // namespace throng::importer
