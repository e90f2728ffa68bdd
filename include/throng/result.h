// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <variant>

#include "throng/base.h"

/// Results and errors: how the library reports failures of data, files and limits.
namespace throng {

/// The kind of a failure. The message has the details.
enum class Errc {
  kOk = 0,
  kBadConfig,  ///< A setting is out of its documented limits.
  kBadInput,   ///< A model, plan or table cannot be used as it is.
  kBadFile,    ///< A file is missing, truncated, corrupt, of another format, world or version.
  kIo,         ///< The system refused to read or write.
  kNotFound,   ///< The requested thing does not exist (class, level, place).
  kLimit,      ///< More than a limit; the message says how much fits.
  kCancelled,  ///< The caller's Context requested a stop; no partial result is left.
};

/// A failure as one sentence: file, place, what is wrong, how to mend it.
struct Error {
  Errc code = Errc::kOk;
  std::string message;
};

/// A value or an Error. Test before use: `if (!r) return r.error();`
template <class T>
class [[nodiscard]] Result {
 public:
  Result(T value) : state_(std::move(value)) {}      // NOLINT: a value is a result
  Result(Error error) : state_(std::move(error)) {}  // NOLINT: so is an error

  [[nodiscard]] explicit operator bool() const { return state_.index() == 0; }
  [[nodiscard]] T& operator*() & { return std::get<0>(state_); }
  [[nodiscard]] const T& operator*() const& { return std::get<0>(state_); }
  [[nodiscard]] T&& operator*() && { return std::get<0>(std::move(state_)); }
  [[nodiscard]] T* operator->() { return &std::get<0>(state_); }
  [[nodiscard]] const T* operator->() const { return &std::get<0>(state_); }
  [[nodiscard]] const Error& error() const { return std::get<1>(state_); }

 private:
  std::variant<T, Error> state_;
};

/// Success without a value, or an Error.
template <>
class [[nodiscard]] Result<void> {
 public:
  Result() = default;
  Result(Error error) : error_(std::move(error)) {}  // NOLINT: an error is a result

  [[nodiscard]] explicit operator bool() const { return !error_.has_value(); }
  [[nodiscard]] const Error& error() const { return *error_; }

 private:
  std::optional<Error> error_;
};

}  // namespace throng
