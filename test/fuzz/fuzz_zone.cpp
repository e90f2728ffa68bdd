// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cstdlib>

#include "world/ground.h"

// A zone that passes the checks must answer every query of a look-up, a move, a crowd or a
// picture without reading past its bytes.
namespace throng {
namespace {

uint32_t ask_values(const uint64_t* words) {
  uint16_t values[world::kBlocks * 64];
  world::unpack_values(words, values);
  uint32_t sum = 0;
  for (int32_t c = 0; c < 4096; ++c) {
    const uint16_t value = world::value_at(words, c % 64, c / 64);
    if (value != values[c]) std::abort();
    sum += value;
  }
  return sum;
}

uint32_t ask_set(const uint64_t* words) {
  world::CellRows rows;
  world::unpack_bits(words, rows);
  uint32_t count = 0;
  for (int32_t c = 0; c < 4096; ++c) {
    const bool has = world::bit_at(words, c % 64, c / 64);
    if (has != ((rows[static_cast<size_t>(c / 64)] >> (c % 64) & 1) != 0)) std::abort();
    count += has ? 1 : 0;
  }
  if (count != world::count_bits(words)) std::abort();
  if (count > 0 && world::nth_bit(words, count - 1) > 4095) std::abort();
  return count;
}

uint32_t ask_level(const world::Zone& zone, uint32_t index) {
  const format::Level& level = zone.level(index);
  const world::LevelView view = zone.view(index);
  uint32_t sum = 0;
  if (view.floor != nullptr) sum += ask_values(view.floor);
  if (view.present != nullptr) sum += ask_set(view.present);
  if (level.ceiling_kind() == format::HeightKind::Blocks) {
    sum += ask_values(zone.words(level.ceiling_offset()));
  }
  if (level.area_kind() == format::CellsKind::Blocks) {
    sum += ask_values(zone.words(level.area_offset()));
  }
  for (int32_t c = 0; c < 4096; c += 5) {
    sum += static_cast<uint32_t>(view.feet(c % 64, c / 64, c % 2048, (c * 7) % 2048));
  }
  for (uint32_t c = 0; c < std::min(zone.root().class_count(), 16u); ++c) {
    const format::Clearance& clearance = zone.clearance(index, c);
    if (clearance.kind() != format::CellsKind::Blocks) continue;
    const uint64_t* words = zone.words(clearance.offset());
    if (ask_set(words) != clearance.legal_cells()) std::abort();
    for (int32_t set = 1; set < 4; ++set) {
      words += world::bit_words(words);
      sum += ask_set(words);
    }
  }
  return sum;
}

}  // namespace
}  // namespace throng

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* bytes, size_t size) {
  auto* copy = new uint8_t[size];
  std::copy_n(bytes, size, copy);
  const auto zone = throng::world::Zone::from_bytes(
      flatbuffers::DetachedBuffer(nullptr, false, copy, size, copy, size), "fuzz");
  if (!zone) return 0;
  static volatile uint32_t sum = 0;
  for (uint32_t i = 0; i < std::min((*zone)->level_count(), 100u); ++i) {
    sum = sum + throng::ask_level(**zone, i);
  }
  return 0;
}
