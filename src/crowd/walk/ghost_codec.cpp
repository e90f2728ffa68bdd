// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "crowd/walk/ghost_codec.h"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstring>
#include <utility>

#include "core/files/var_number.h"

// A body that repeats its move takes three bytes: its name, less the one before, and that nothing
// differs. Linear in the ghosts.
namespace throng::crowd {
namespace {

// Words of Body that are read here.
constexpr size_t kX = 0, kZ = 1, kVelocityX = 4, kVelocityZ = 5, kSlot = 13;
static_assert(offsetof(Body, x) == 4 * kX && offsetof(Body, z) == 4 * kZ &&
              offsetof(Body, velocity) == 4 * kVelocityX && offsetof(Body, slot) == 4 * kSlot);

int32_t difference(uint32_t a, uint32_t b) { return static_cast<int32_t>(a - b); }

StepUnits units_of(const Body& body, StepUnits units) {
  if (body.steps > 1) units.dt *= static_cast<float>(body.steps);
  return units;
}

// The place of a name among ghosts in order of name.
const Ghost* find(std::span<const Ghost> ghosts, uint32_t name) {
  const auto at =
      std::lower_bound(ghosts.begin(), ghosts.end(), name,
                       [](const Ghost& ghost, uint32_t of) { return ghost.body.slot < of; });
  return at != ghosts.end() && at->body.slot == name ? &*at : nullptr;
}

}  // namespace

GhostCodec::Words GhostCodec::words_of(const Ghost& ghost) {
  static_assert(sizeof(Body) + sizeof(QueueProgress) + sizeof(RoomRequest) + sizeof(float) ==
                sizeof(Words));
  Words words;
  auto* at = reinterpret_cast<uint8_t*>(words.data());
  const auto put = [&](const auto& value) {
    std::memcpy(at, &value, sizeof value);
    at += sizeof value;
  };
  put(ghost.body);
  put(ghost.progress);
  put(ghost.request);
  put(ghost.level_speed);
  return words;
}

Ghost GhostCodec::ghost_of(const Words& words) {
  Ghost ghost;
  const auto* at = reinterpret_cast<const uint8_t*>(words.data());
  const auto take = [&](auto& value) {
    std::memcpy(&value, at, sizeof value);
    at += sizeof value;
  };
  take(ghost.body);
  take(ghost.progress);
  take(ghost.request);
  take(ghost.level_speed);
  return ghost;
}

const Ghost* GhostCodec::find_last(uint32_t name, size_t& from) const {
  while (from < last_.size() && last_[from].body.slot < name) ++from;
  return from < last_.size() && last_[from].body.slot == name ? &last_[from] : nullptr;
}

// It moves on as it did.
GhostCodec::Words GhostCodec::likely(const Ghost* last, uint32_t name, StepUnits units) {
  if (last == nullptr) {
    Words words{};
    words[kSlot] = name;
    return words;
  }
  Ghost ghost = *last;
  const StepUnits own = units_of(last->body, units);
  ghost.body.x += own.displacement(last->body.velocity.x);
  ghost.body.z += own.displacement(last->body.velocity.z);
  return words_of(ghost);
}

// Its velocity is what its move was, as CrowdEngine::settle_all finds it.
void GhostCodec::expect_velocity(const Ghost* last, StepUnits units, const Words& seen,
                                 Words& likely) {
  if (last == nullptr) return;
  const StepUnits own = units_of(last->body, units);
  const int32_t x = difference(seen[kX], static_cast<uint32_t>(last->body.x));
  const int32_t z = difference(seen[kZ], static_cast<uint32_t>(last->body.z));
  const bool moved = x != 0 || z != 0;
  likely[kVelocityX] = std::bit_cast<uint32_t>(moved ? own.velocity(x) : 0.0f);
  likely[kVelocityZ] = std::bit_cast<uint32_t>(moved ? own.velocity(z) : 0.0f);
}

void GhostCodec::encode(std::span<const Ghost> ghosts, StepUnits units,
                        std::vector<uint8_t>& bytes) {
  put_number(bytes, ghosts.size());
  uint32_t before = 0;
  size_t from = 0;
  for (const Ghost& ghost : ghosts) {
    const uint32_t name = ghost.body.slot;
    put_number(bytes, name - before);
    before = name;
    const Ghost* const last = find_last(name, from);
    const Words seen = words_of(ghost);
    Words expected = likely(last, name, units);
    expect_velocity(last, units, seen, expected);
    uint64_t changed = 0;
    for (size_t w = 0; w < kWords; ++w) changed |= uint64_t{seen[w] != expected[w]} << w;
    put_number(bytes, changed);
    for (; changed != 0; changed &= changed - 1) {
      const auto w = static_cast<size_t>(std::countr_zero(changed));
      put_number(bytes, folded(difference(seen[w], expected[w])));
    }
  }
  last_.assign(ghosts.begin(), ghosts.end());
}

bool GhostCodec::decode(std::span<const uint8_t> bytes, size_t& at, StepUnits units,
                        std::vector<Ghost>& ghosts) {
  const auto count = take_number(bytes, at);
  if (!count || *count > bytes.size()) return false;
  std::vector<Ghost> now;
  now.reserve(*count);
  uint64_t name = 0;
  size_t from = 0;
  for (uint64_t n = 0; n < *count; ++n) {
    const auto more = take_number(bytes, at), changed = take_number(bytes, at);
    if (!more || !changed || *changed >> kWords != 0) return false;
    name += *more;
    if (name >= UINT32_MAX || (n > 0 && *more == 0)) return false;
    const Ghost* const last = find_last(static_cast<uint32_t>(name), from);
    Words words = likely(last, static_cast<uint32_t>(name), units);
    bool has_velocity = false;
    for (uint64_t left = *changed; left != 0; left &= left - 1) {
      const auto w = static_cast<size_t>(std::countr_zero(left));
      if (w > kZ && !has_velocity) {
        expect_velocity(last, units, words, words);
        has_velocity = true;
      }
      const auto by = take_number(bytes, at);
      if (!by) return false;
      words[w] += static_cast<uint32_t>(unfolded(*by));
    }
    if (!has_velocity) expect_velocity(last, units, words, words);
    if (words[kSlot] != name) return false;
    now.push_back(ghost_of(words));
  }
  last_ = std::move(now);
  ghosts.insert(ghosts.end(), last_.begin(), last_.end());
  return true;
}

void encode_moves(std::span<const GhostMove> moves, std::span<const Ghost> shown,
                  std::vector<uint8_t>& bytes) {
  uint32_t before = 0;
  for (const GhostMove& move : moves) {
    const Ghost* const of = find(shown, move.name);
    if (of == nullptr) continue;
    const Body& body = of->body;
    put_number(bytes, move.name - before);
    before = move.name;
    const bool same_level = move.place.level == body.level;
    put_number(bytes, uint64_t{move.round} << 1 | (same_level ? 0 : 1));
    put_number(bytes, folded(int64_t{move.place.x} - body.x));
    put_number(bytes, folded(int64_t{move.place.z} - body.z));
    put_number(bytes, folded(int64_t{move.place.y} - body.y));
    if (!same_level) put_number(bytes, move.place.level);
  }
}

bool decode_moves(std::span<const uint8_t> bytes, std::span<const Ghost> shown,
                  std::vector<GhostMove>& moves) {
  uint64_t name = 0;
  for (size_t at = 0; at < bytes.size();) {
    const auto more = take_number(bytes, at), round = take_number(bytes, at);
    const auto x = take_number(bytes, at), z = take_number(bytes, at), y = take_number(bytes, at);
    if (!more || !round || !x || !z || !y) return false;
    name += *more;
    const Ghost* const of = name < UINT32_MAX ? find(shown, static_cast<uint32_t>(name)) : nullptr;
    if (of == nullptr) return false;
    const Body& body = of->body;
    GhostMove move{.name = static_cast<uint32_t>(name),
                   .round = static_cast<uint32_t>(*round >> 1),
                   .place = {static_cast<int32_t>(body.x + unfolded(*x)),
                             static_cast<int32_t>(body.z + unfolded(*z)),
                             static_cast<int32_t>(body.y + unfolded(*y)), body.level}};
    if ((*round & 1) != 0) {
      const auto level = take_number(bytes, at);
      if (!level) return false;
      move.place.level = static_cast<uint32_t>(*level);
    }
    moves.push_back(move);
  }
  return true;
}

void encode_names(std::span<const uint32_t> names, std::span<const Ghost> shown,
                  std::vector<uint8_t>& bytes) {
  uint32_t before = 0;
  for (const uint32_t name : names) {
    if (find(shown, name) != nullptr) put_number(bytes, name - std::exchange(before, name));
  }
}

bool decode_names(std::span<const uint8_t> bytes, std::vector<uint32_t>& names) {
  uint64_t name = 0;
  for (size_t at = 0; at < bytes.size();) {
    const auto more = take_number(bytes, at);
    if (!more || (name += *more) >= UINT32_MAX) return false;
    names.push_back(static_cast<uint32_t>(name));
  }
  return true;
}

}  // namespace throng::crowd
