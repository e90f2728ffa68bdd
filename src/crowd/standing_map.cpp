// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "crowd/standing_map.h"

#include <algorithm>
#include <bit>

#include "core/random.h"
#include "crowd/walk/step_units.h"

// A hash table of squares with a list of bodies each. Constant time for each body unless a square
// is crowded.
namespace throng::crowd {

StandingMap::StandingMap(std::span<const Body> bodies, int32_t widest, size_t more)
    : width_(std::max(1, 2 * widest)) {
  first_.assign(std::bit_ceil(2 * (bodies.size() + more) + 64), kEnd);
  entries_.reserve(bodies.size() + more);
  for (const Body& body : bodies) add(body);
}

size_t StandingMap::square(int64_t x, int64_t z) const {
  return mix64(static_cast<uint64_t>(x) << 32 ^ static_cast<uint64_t>(z)) & (first_.size() - 1);
}

void StandingMap::add(const Body& body) {
  if (2 * entries_.size() >= first_.size()) grow();
  uint32_t& first = first_[square(body.x / width_, body.z / width_)];
  entries_.push_back({body.x, body.z, body.y, body.radius, body.height, first});
  first = static_cast<uint32_t>(entries_.size() - 1);
}

// Which bodies touch does not depend on the table's size.
void StandingMap::grow() {
  first_.assign(2 * first_.size(), kEnd);
  for (size_t n = 0; n < entries_.size(); ++n) {
    Entry& entry = entries_[n];
    uint32_t& first = first_[square(entry.x / width_, entry.z / width_)];
    entry.next = first;
    first = static_cast<uint32_t>(n);
  }
}

bool StandingMap::is_clear(const Body& body) const {
  for (int64_t dz = -1; dz <= 1; ++dz) {
    for (int64_t dx = -1; dx <= 1; ++dx) {
      uint32_t n = first_[square(body.x / width_ + dx, body.z / width_ + dz)];
      for (; n != kEnd; n = entries_[n].next) {
        const Entry& other = entries_[n];
        if (nearer_than(other.x - body.x, other.z - body.z, int64_t{body.radius} + other.radius) &&
            body.y < other.y + other.height && other.y < body.y + body.height) {
          return false;
        }
      }
    }
  }
  return true;
}

bool StandingMap::add_if_clear(const Body& body) {
  if (!is_clear(body)) return false;
  add(body);
  return true;
}

}  // namespace throng::crowd
