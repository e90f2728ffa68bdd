// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "crowd/share/rank_share.h"

#include <algorithm>

// What ranks give each other. Columns are assigned in time linear in the columns, and the bodies.
namespace throng::crowd {

RankShare::RankShare(RankGroup& group, int32_t width, int32_t depth)
    : group_(group), owners_(width, depth, group.rank()) {
  assign_columns({});
}

uint64_t RankShare::sum(uint64_t mine) {
  uint64_t sum = 0;
  for (const uint64_t one : gather(std::span<const uint64_t>(&mine, 1))) sum += one;
  return sum;
}

std::span<const RankGroup::Bytes> RankShare::gather_bytes(std::span<const uint8_t> mine) {
  if (size() > 1) sent_bytes_ += mine.size();
  return group_.gather(mine);
}

std::span<const RankGroup::Bytes> RankShare::exchange_bytes(std::span<const RankGroup::Bytes> to) {
  for (const RankGroup::Bytes& bytes : to) sent_bytes_ += bytes.size();
  return group_.exchange(owners_.neighbours(), to);
}

float RankShare::largest(float mine) {
  const std::vector<float> all = gather(std::span<const float>(&mine, 1));
  return *std::max_element(all.begin(), all.end());
}

// Columns without bodies count a little, so that they are shared out, too.
void RankShare::assign_columns(std::span<const Body> bodies) {
  constexpr float kEmpty = 1.0f / 64;  // of a body
  struct Count {
    uint32_t column = 0, bodies = 0;
  };
  std::vector<uint32_t> counts(owners_.columns(), 0);
  for (const Body& body : bodies) ++counts[owners_.column_of(body.x, body.z)];
  std::vector<Count> own;
  for (uint32_t column = 0; column < counts.size(); ++column) {
    if (counts[column] > 0) own.push_back({column, counts[column]});
  }
  std::fill(counts.begin(), counts.end(), 0);
  for (const Count& one : gather(std::span<const Count>(own))) counts[one.column] += one.bodies;
  std::vector<RankGroup::Weight> points;
  points.reserve(counts.size());
  for (uint32_t column = 0; column < counts.size(); ++column) {
    const world::GroundPoint middle = owners_.middle_of(column);
    points.push_back({.x = static_cast<double>(middle.x),
                      .z = static_cast<double>(middle.z),
                      .weight = kEmpty + static_cast<float>(counts[column])});
  }
  owners_.set_owners(group_.divide(points));
}

}  // namespace throng::crowd
