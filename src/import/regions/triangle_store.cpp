// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "import/regions/triangle_store.h"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <climits>
#include <cmath>
#include <cstring>
#include <limits>

#include "core/arrays/release.h"

// Triangles wait in memory by square and are written together, so that the file has few runs for
// each square: models list what lies together together. A triangle belongs to the square of its
// box's middle, on the lowest level whose squares are as long as it is on both axes. So it reaches
// no farther than half a square beyond its own.
namespace throng::importer {
namespace {

constexpr double kSide = 64;  // of a square of the lowest level [m]
constexpr int32_t kLevels = 32;
constexpr uint64_t kMaxWaiting = 1 << 16;  // triangles
constexpr double kFarthest = 2e9;          // squares from the origin

double side_of(int32_t level) { return std::ldexp(kSide, level); }

int32_t square_of(double at, double side) {
  return static_cast<int32_t>(std::clamp(std::floor(at / side), -kFarthest, kFarthest));
}

Box3d box_of(const std::array<Vec3d, 3>& corners) {
  Box3d box;
  for (const Vec3d& p : corners) box.add(p);
  return box;
}

}  // namespace

Error TriangleStore::failure(const std::string& what) const {
  const std::string why = errno != 0 ? std::strerror(errno) : "it was cut short";
  return {Errc::kIo, file_.path() + ": " + what + ": " + why};
}

Result<std::unique_ptr<TriangleStore>> TriangleStore::create(const std::string& folder) {
  auto file = ScratchFile::create(folder, "triangles");
  if (!file) return file.error();
  return std::unique_ptr<TriangleStore>(new TriangleStore(*std::move(file)));
}

Result<void> TriangleStore::add(const Scene& scene) {
  if (count_ + scene.triangles.size() > UINT32_MAX) {
    return Error{Errc::kLimit, "scene: more than 4.29 thousand million triangles"};
  }
  for (size_t t = 0; t < scene.triangles.size(); ++t) {
    Record record{.corners = {}, .number = static_cast<uint32_t>(count_++), .area = scene.area[t]};
    for (size_t k = 0; k < 3; ++k) record.corners[k] = scene.positions[scene.triangles[t][k]];
    const Box3d box = box_of(record.corners);
    bounds_.add(box.min);
    bounds_.add(box.max);
    Square& square = squares_[place_of(box)];
    ++square.count;
    square.waiting.push_back(record);
    if (++waiting_ < kMaxWaiting) continue;
    if (auto ok = write_waiting(); !ok) return ok;
  }
  return {};
}

Result<void> TriangleStore::write_waiting() {
  for (auto& [place, square] : squares_) {
    const size_t count = square.waiting.size();
    if (count == 0) continue;
    if (!file_.write(written_ * sizeof(Record), square.waiting.data(), count * sizeof(Record))) {
      return failure("cannot be written (80 bytes a triangle)");
    }
    if (!square.runs.empty() && square.runs.back().first + square.runs.back().count == written_) {
      square.runs.back().count += count;
    } else {
      square.runs.push_back({.first = written_, .count = count});
    }
    written_ += count;
    release(square.waiting);
  }
  waiting_ = 0;
  return {};
}

Result<void> TriangleStore::finish() { return write_waiting(); }

TriangleStore::Place TriangleStore::place_of(const Box3d& triangle) {
  const Vec3d size = triangle.max - triangle.min;
  int32_t level = 0;
  while (level < kLevels && std::max(size.x, size.z) > side_of(level)) ++level;
  const Vec3d middle = (triangle.min + triangle.max) * 0.5;
  const double side = side_of(level);
  return {level, square_of(middle.z, side), square_of(middle.x, side)};
}

template <class Visit>
void TriangleStore::for_each_square(const Box3d& box, Visit visit) const {
  for (auto at = squares_.begin(); at != squares_.end();) {
    const int32_t level = at->first.level;
    const double side = side_of(level);
    const double reach = level < kLevels ? side / 2 : std::numeric_limits<double>::infinity();
    const int32_t x0 = square_of(box.min.x - reach, side), x1 = square_of(box.max.x + reach, side);
    const int32_t z0 = square_of(box.min.z - reach, side), z1 = square_of(box.max.z + reach, side);
    at = squares_.lower_bound({level, z0, x0});
    while (at != squares_.end() && at->first.level == level && at->first.z <= z1) {
      const auto [_, z, x] = at->first;
      if (x < x0) {
        at = squares_.lower_bound({level, z, x0});
      } else if (x > x1) {
        at = squares_.lower_bound({level, z + 1, x0});
      } else {
        visit(at->second);
        ++at;
      }
    }
    at = squares_.lower_bound({level + 1, INT32_MIN, INT32_MIN});
  }
}

uint64_t TriangleStore::estimate(const Box3d& box) const {
  uint64_t count = 0;
  for_each_square(box, [&](const Square& square) { count += square.count; });
  return count;
}

Result<void> TriangleStore::append(const Box3d& box, uint32_t /*first_patch*/, SceneRegion& out,
                                   Context& context) const {
  std::vector<Record> found, read;
  bool is_read = true;
  for_each_square(box, [&](const Square& square) {
    for (const Run& run : square.runs) {
      constexpr uint64_t kAtOnce = 1 << 14;
      for (uint64_t done = 0; is_read && !context.cancel && done < run.count;) {
        read.resize(std::min(kAtOnce, run.count - done));
        is_read = file_.read((run.first + done) * sizeof(Record), read.data(),
                             read.size() * sizeof(Record));
        done += read.size();
        for (const Record& record : read) {
          if (touch(box_of(record.corners), box)) found.push_back(record);
        }
      }
    }
  });
  if (!is_read) return failure("cannot be read again");
  if (context.cancel) return Error{Errc::kCancelled, "cancelled while reading"};
  std::sort(found.begin(), found.end(),
            [](const Record& a, const Record& b) { return a.number < b.number; });
  Scene& scene = out.scene;
  scene.positions.reserve(scene.positions.size() + 3 * found.size());
  scene.triangles.reserve(scene.triangles.size() + found.size());
  for (const Record& record : found) {
    scene.add_triangle(record.corners[0], record.corners[1], record.corners[2], record.area);
  }
  if (!scene.patch_of_triangle.empty()) {
    scene.patch_of_triangle.resize(scene.triangles.size(), kNoPatch);
    scene.patch_part.resize(scene.triangles.size());
  }
  return {};
}

}  // namespace throng::importer
