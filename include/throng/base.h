// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <atomic>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

/// Macros for exports and assertions. Symbols without THRONG_API are hidden.
#if defined(_WIN32) && defined(THRONG_SHARED)
#ifdef THRONG_BUILDING
#define THRONG_API __declspec(dllexport)
#else
#define THRONG_API __declspec(dllimport)
#endif
#elif defined(__GNUC__)
#define THRONG_API __attribute__((visibility("default")))
#else
#define THRONG_API
#endif

/// Asserts against misuse by the calling code (bad data gives a Result). Checked in debug builds
/// only.
#define THRONG_ASSERT(condition) assert(condition)

/// What every header uses: results and errors, progress and cancel, vectors, prisms.
namespace throng {

// ----
// Results and errors: how the library reports failures of data, files and limits.

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

/// A failure as one sentence: file, place, what is wrong, what to do about it.
struct Error {
  Errc code = Errc::kOk;
  std::string message;  ///< One sentence, without a full stop.
};

/// A value or an Error. Test before use: `if (!r) return r.error();`
template <class T>
class [[nodiscard]] Result {
 public:
  Result(T value) : state_(std::move(value)) {}      // NOLINT: a value is a result
  Result(Error error) : state_(std::move(error)) {}  // NOLINT: so is an error

  /// Is it a value?
  [[nodiscard]] explicit operator bool() const { return state_.index() == 0; }
  /// The value. There must be one.
  [[nodiscard]] T& operator*() & { return std::get<0>(state_); }
  [[nodiscard]] const T& operator*() const& { return std::get<0>(state_); }
  [[nodiscard]] T&& operator*() && { return std::get<0>(std::move(state_)); }
  [[nodiscard]] T* operator->() { return &std::get<0>(state_); }
  [[nodiscard]] const T* operator->() const { return &std::get<0>(state_); }
  /// The error. There must be one.
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

  /// Is it a success?
  [[nodiscard]] explicit operator bool() const { return !error_.has_value(); }
  /// The error. There must be one.
  [[nodiscard]] const Error& error() const { return *error_; }

 private:
  std::optional<Error> error_;
};

// ----
// Progress and cancel for long calls. One Context may serve several calls, from several threads.

/// How far a long call has come. `total` is 0 while it is unknown.
struct Progress {
  std::string_view stage;  ///< "read", "bake", "verify" ...: valid during the callback only.
  uint64_t done = 0;       ///< Of `total`, in units of the stage: bytes, zones, samples.
  uint64_t total = 0;
};

/// Connects a long call to its caller. With a default Context it runs silently to the end.
struct Context {
  /// Called from time to time, never by two threads at once. May set `cancel`.
  std::function<void(const Progress&)> on_progress;
  /// Set from any thread (or a signal handler) to stop: the call returns Errc::kCancelled.
  std::atomic<bool> cancel{false};
};

// ----
// Small vectors in metres. Y is up, right-handed.

/// A point or vector.
struct Vec3d {
  double x = 0, y = 0, z = 0;
  friend bool operator==(const Vec3d&, const Vec3d&) = default;
  friend Vec3d operator+(Vec3d a, Vec3d b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
  friend Vec3d operator-(Vec3d a, Vec3d b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
  friend Vec3d operator*(Vec3d a, double s) { return {a.x * s, a.y * s, a.z * s}; }
};

/// The dot product, the cross product (right-handed) and the Euclidean length.
inline double dot(Vec3d a, Vec3d b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline Vec3d cross(Vec3d a, Vec3d b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline double length(Vec3d a) { return std::sqrt(dot(a, a)); }

/// An axis-aligned box; empty until a point is added.
struct Box3d {
  Vec3d min{std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity(),
            std::numeric_limits<double>::infinity()};
  Vec3d max{-std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity(),
            -std::numeric_limits<double>::infinity()};
  [[nodiscard]] bool empty() const { return !(min.x <= max.x); }
  /// Grows it to hold a point.
  void add(Vec3d p) {
    min = {p.x < min.x ? p.x : min.x, p.y < min.y ? p.y : min.y, p.z < min.z ? p.z : min.z};
    max = {p.x > max.x ? p.x : max.x, p.y > max.y ? p.y : max.y, p.z > max.z ? p.z : max.z};
  }
};

/// An affine map, row-major 3 x 4: out = m[r][0..2] * in + m[r][3] in row r.
struct Transform {
  std::array<std::array<double, 4>, 3> m{{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}};
  /// The image of a point.
  [[nodiscard]] Vec3d operator()(Vec3d p) const {
    return {m[0][0] * p.x + m[0][1] * p.y + m[0][2] * p.z + m[0][3],
            m[1][0] * p.x + m[1][1] * p.y + m[1][2] * p.z + m[1][3],
            m[2][0] * p.x + m[2][1] * p.y + m[2][2] * p.z + m[2][3]};
  }
};

// ----
// Prisms: simple volumes for obstacles and areas.

/// A vertical prism over a convex polygon: a crate, a barrier, a door leaf, a marked zone.
struct Prism {
  std::vector<std::array<double, 2>> corners;  ///< (x, z), in either order. [m, 3 to 64]
  double low = 0, high = 0;                    ///< Y of bottom and top. [m, low < high]

  [[nodiscard]] static Prism box(Vec3d low, Vec3d high) {
    return {{{low.x, low.z}, {high.x, low.z}, {high.x, high.z}, {low.x, high.z}}, low.y, high.y};
  }
  /// Is (x, z) inside its polygon, border included? [m]
  [[nodiscard]] THRONG_API bool covers(double x, double z) const;
  /// Is a height of feet within [low, high], widened by kFeetTolerance on both sides? [m]
  [[nodiscard]] bool covers_height(double y) const {
    return y >= low - kFeetTolerance && y <= high + kFeetTolerance;
  }
  /// Does an avatar with its feet at this point stand in the prism? [m]
  [[nodiscard]] bool contains(Vec3d feet) const {
    return covers_height(feet.y) && covers(feet.x, feet.z);
  }
  /// By how much heights of feet and floors may differ, because of rounding. [m]
  static constexpr double kFeetTolerance = 0.05;
  /// A prism that contains an upright cylinder; `middle` is the centre of the cylinder's bottom.
  /// With 16 corners these lie 2 % of the radius outside of it. [m, radius > 0, height > 0, corners
  /// 3 to 64]
  [[nodiscard]] THRONG_API static Prism circle(Vec3d middle, double radius, double height,
                                               int corners = 16);
};

/// Checks that a prism is convex and within its limits. Fails with kBadInput and the reason.
[[nodiscard]] THRONG_API Result<void> check_prism(const Prism& prism);

}  // namespace throng
