// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "crowd/walk/step_exchange.h"
#include "crowd/walk/step_units.h"

/// What a rank shows a neighbour, in few bytes. docs/design/019-ranks.md.
namespace throng::crowd {

/// Ghosts as differences from what their last ones make likely. One on each side of a border, which
/// have had the same ghosts in the same order; Body::slot is the name.
class GhostCodec {
 public:
  /// Appends what `decode` of the other side reads. `ghosts`: by name.
  void encode(std::span<const Ghost> ghosts, StepUnits units, std::vector<uint8_t>& bytes);
  /// Reads them from `at` on. False: no codec wrote this.
  bool decode(std::span<const uint8_t> bytes, size_t& at, StepUnits units,
              std::vector<Ghost>& ghosts);
  /// Both sides forget what they had.
  void reset() { last_.clear(); }

 private:
  static constexpr size_t kWords = 35;
  using Words = std::array<uint32_t, kWords>;
  [[nodiscard]] static Words words_of(const Ghost& ghost);
  [[nodiscard]] static Ghost ghost_of(const Words& words);
  /// The last ghost of a name if it is next, from a place that only moves forward.
  [[nodiscard]] const Ghost* find_last(uint32_t name, size_t& from) const;
  [[nodiscard]] static Words likely(const Ghost* last, uint32_t name, StepUnits units);
  static void expect_velocity(const Ghost* last, StepUnits units, const Words& seen, Words& likely);

  std::vector<Ghost> last_;  // by name
};

// Moves of a round, and names, both in order of name, of those that are shown to a neighbour.
void encode_moves(std::span<const GhostMove> moves, std::span<const Ghost> shown,
                  std::vector<uint8_t>& bytes);
bool decode_moves(std::span<const uint8_t> bytes, std::span<const Ghost> shown,
                  std::vector<GhostMove>& moves);
void encode_names(std::span<const uint32_t> names, std::span<const Ghost> shown,
                  std::vector<uint8_t>& bytes);
bool decode_names(std::span<const uint8_t> bytes, std::vector<uint32_t>& names);

}  // namespace throng::crowd
