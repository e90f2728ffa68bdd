// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "world/zone_data.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/hash.h"
#include "world/cell_blocks.h"

// Opens and checks zone files, and keeps those in memory that are in use: a clock removes others at
// their second pass.
namespace throng::world {
namespace {

constexpr uint32_t kArea = 4096;
// [mm]: more than is baked, differences fit 32 bits
constexpr int32_t kHeightBound = 1'050'000'000;
constexpr int32_t kMaxSideCells = 1 << 20;  // along a side

// Legal cells of a class on a level, or none if its sets do not lie within `words`.
std::optional<uint32_t> legal_cells(const format::Clearance& entry,
                                    std::span<const uint64_t> words) {
  if (entry.kind() == format::CellsKind::None) return 0;
  if (entry.kind() == format::CellsKind::All) return kArea;
  if (entry.kind() != format::CellsKind::Blocks) return std::nullopt;
  uint64_t at = entry.offset();
  for (int32_t set = 0; set < 4; ++set) {
    const auto end = end_of_bits(words, at);
    if (!end) return std::nullopt;
    at = *end;
  }
  return count_bits(&words[entry.offset()]);
}

}  // namespace

// The verifier proves that every vector lies within the file; the rest proves that every offset in
// the records lies within its vector and that counts are true, so that look-ups need no checks.
Result<void> Zone::attach(const std::string& name) {
  flatbuffers::Verifier verifier(bytes().data(), bytes().size());
  if (bytes().size() < 8 || !format::ZoneBufferHasIdentifier(bytes().data()) ||
      !format::VerifyZoneBuffer(verifier)) {
    return bad_file(name, "not a zone file, or truncated");
  }
  root_ = format::GetZone(bytes().data());
  if (root_->version() != kZoneVersion) {
    return bad_file(name, "zone version " + std::to_string(root_->version()) +
                              ", this program reads " + std::to_string(kZoneVersion));
  }
  const auto* first = root_->tile_first();
  const auto* levels = root_->levels();
  const auto* clearance = root_->clearance();
  if (!first || !levels || !clearance || !root_->words()) {
    return bad_file(name, "an array is missing");
  }
  const uint64_t side = root_->tiles_per_side();
  class_count_ = root_->class_count();
  level_count_ = levels->size();
  if (!is_aligned(*root_->words()) || side == 0 || side > 255 || first->size() != side * side + 1 ||
      first->Get(0) != 0 || first->Get(first->size() - 1) != level_count_ || class_count_ == 0 ||
      clearance->size() != uint64_t{level_count_} * class_count_) {
    return bad_file(name, "its arrays do not fit together");
  }
  const std::span<const uint64_t> words(root_->words()->data(), root_->words()->size());
  for (uint32_t tile = 0; tile + 1 < first->size(); ++tile) {
    const uint32_t begin = first->Get(tile), end = first->Get(tile + 1);
    if (begin > end || end > level_count_) return bad_file(name, "its tiles are out of order");
    for (uint32_t i = begin; i < end; ++i) {
      const format::Level& level = *levels->Get(i);
      const auto gentle = [](int32_t slope) { return slope > -kMaxSlope && slope < kMaxSlope; };
      const auto in_world = [](int32_t height) {
        return height > -kHeightBound && height < kHeightBound;
      };
      const bool floor_ok = level.floor_kind() == format::HeightKind::Constant ||
                            (level.floor_kind() == format::HeightKind::Plane &&
                             gentle(level.slope_x()) && gentle(level.slope_z())) ||
                            (level.floor_kind() == format::HeightKind::Blocks &&
                             values_fit(words, level.floor_offset()));
      const bool ceiling_ok = level.ceiling_kind() == format::HeightKind::None ||
                              level.ceiling_kind() == format::HeightKind::Constant ||
                              (level.ceiling_kind() == format::HeightKind::Blocks &&
                               values_fit(words, level.ceiling_offset()));
      const bool present_ok = level.present_kind() == format::CellsKind::All ||
                              (level.present_kind() == format::CellsKind::Blocks &&
                               end_of_bits(words, level.present_offset()));
      const bool area_ok = level.area_kind() == format::CellsKind::All ||
                           (level.area_kind() == format::CellsKind::Blocks &&
                            values_fit(words, level.area_offset()));
      if (!in_world(level.floor_base()) || !in_world(level.ceiling_base())) {
        return bad_file(name, "level " + std::to_string(i) + " lies out of this world");
      }
      if (level.area_value() > kLastAreaKind) {
        return bad_file(name, "level " + std::to_string(i) + " is of an area kind that is none");
      }
      if (level.tile() != tile || !floor_ok || !ceiling_ok || !present_ok || !area_ok) {
        return bad_file(name, "level " + std::to_string(i) + " points outside the file");
      }
    }
  }
  for (uint32_t i = 0; i < clearance->size(); ++i) {
    const format::Clearance& entry = *clearance->Get(i);
    const auto cells = legal_cells(entry, words);
    if (!cells) {
      return bad_file(name, "clearance " + std::to_string(i) + " points outside the file");
    }
    if (entry.legal_cells() != *cells) {
      return bad_file(name, "clearance " + std::to_string(i) + " miscounts its cells");
    }
  }
  tile_first_ = first->data();
  levels_ = reinterpret_cast<const format::Level*>(levels->Data());
  clearance_ = reinterpret_cast<const format::Clearance*>(clearance->Data());
  words_ = words.data();
  return {};
}

LevelView Zone::view(uint32_t index) const {
  const format::Level& level = levels_[index];
  LevelView view;
  view.record = &level;
  view.floor_base = level.floor_base();
  if (level.floor_kind() == format::HeightKind::Blocks) view.floor = words(level.floor_offset());
  if (level.floor_kind() == format::HeightKind::Plane) {
    view.floor_part = level.floor_part();
    view.slope_x = level.slope_x();
    view.slope_z = level.slope_z();
  }
  if (level.present_kind() == format::CellsKind::Blocks) {
    view.present = words(level.present_offset());
  }
  return view;
}

void WorldData::open_zone(const Slot& entry) const {
  if (entry.zone || path.empty()) return;
  const format::ZoneEntry& listed = entry.entry;
  entry.open({.name = path + "/" + zone_file_name(listed.x(), listed.z()),
              .bytes = listed.bytes(),
              .hash = listed.hash(),
              .whose = "the manifest's"},
             [&](const Zone& zone) {
               const format::Zone& root = zone.root();
               return root.tiles_per_side() == tiles_per_zone &&
                      root.class_count() == summary.classes.size() &&
                      zone.level_count() == listed.levels() && root.x() == listed.x() &&
                      root.z() == listed.z();
             });
}

// The slow path of zone(): the zone is not loaded, or the clock's hand has passed it.
const Zone* WorldData::touch(size_t slot) const {
  const Slot& entry = *slots[slot];
  std::call_once(entry.once, [&] { open_zone(entry); });
  if (!entry.zone) return nullptr;
  if (budget == 0 || path.empty()) {
    entry.use.store(Use::kUsed, std::memory_order_release);
    return entry.zone.get();
  }
  Use idle = Use::kIdle;
  if (entry.use.compare_exchange_strong(idle, Use::kUsed)) return entry.zone.get();
  const std::lock_guard lock(residency);
  if (entry.use.load() == Use::kAway) {
    resident_bytes += entry.entry.bytes();
    ++resident_zones;
    entry.use.store(Use::kUsed, std::memory_order_release);
    make_room(slot);
  }
  return entry.zone.get();
}

// Unloads zones that were not used since the clock's hand last passed, until the rest fits. A
// thread that holds such a zone reads on: its pages come back one by one.
void WorldData::make_room(size_t for_slot) const {
  for (size_t steps = 2 * slots.size(); resident_bytes > budget && steps > 0; --steps) {
    hand = (hand + 1) % slots.size();
    const Slot& entry = *slots[hand];
    if (hand == for_slot) continue;
    Use used = Use::kUsed, idle = Use::kIdle;
    if (entry.use.compare_exchange_strong(used, Use::kIdle)) continue;
    if (!entry.use.compare_exchange_strong(idle, Use::kAway)) continue;
    entry.zone->give_back();
    resident_bytes -= entry.entry.bytes();
    --resident_zones;
  }
}

size_t WorldData::slot_of_level(uint32_t level) const {
  const auto after = std::upper_bound(slots.begin(), slots.end(), level,
                                      [](uint32_t l, const auto& s) { return l < s->first_level; });
  return static_cast<size_t>(after - slots.begin()) - 1;
}

WorldData::TileLevels WorldData::tile_levels(int32_t tile_x, int32_t tile_z) const {
  const auto per_zone = static_cast<int32_t>(tiles_per_zone);
  if (tile_x < 0 || tile_z < 0) return {};
  const int32_t zx = tile_x / per_zone, zz = tile_z / per_zone;
  if (zx >= zones_x || zz >= zones_z) return {};
  const int32_t slot = slot_of_zone[static_cast<size_t>(zz * zones_x + zx)];
  if (slot < 0) return {};
  const Zone* found = zone(static_cast<size_t>(slot));
  if (found == nullptr) return {};
  const auto tile =
      static_cast<uint32_t>((tile_z - zz * per_zone) * per_zone + tile_x - zx * per_zone);
  const auto [first, last] = found->tile_levels(tile);
  const uint32_t base = slots[static_cast<size_t>(slot)]->first_level;
  return {found, base + first, base + last, first};
}

std::string zone_file_name(int32_t x, int32_t z) {
  return "zone_" + std::to_string(x) + "_" + std::to_string(z) + ".thz";
}

Result<std::shared_ptr<WorldData>> read_manifest(std::span<const uint8_t> bytes,
                                                 const std::string& name) {
  flatbuffers::Verifier verifier(bytes.data(), bytes.size());
  if (bytes.size() < 8 || !format::ManifestBufferHasIdentifier(bytes.data()) ||
      !format::VerifyManifestBuffer(verifier)) {
    return bad_file(name, "not a manifest, or truncated");
  }
  const format::Manifest& root = *format::GetManifest(bytes.data());
  if (root.version() != kManifestVersion) {
    return bad_file(name, "manifest version " + std::to_string(root.version()) +
                              ", this program reads " + std::to_string(kManifestVersion));
  }
  const auto* bounds = root.bounds();
  const bool sound = root.zones() && root.classes() && bounds && bounds->size() == 6 &&
                     is_aligned(*root.zones()) && is_aligned(*bounds) &&
                     root.classes()->size() >= 1 && root.classes()->size() <= kMaxAvatarClasses &&
                     root.cell() >= 0.02 && root.cell() <= 5 && std::isfinite(root.resolution()) &&
                     std::fabs(root.origin_x()) < 1e12 && std::fabs(root.origin_z()) < 1e12 &&
                     root.width() > 0 && root.depth() > 0 && root.width() <= kMaxSideCells &&
                     root.depth() <= kMaxSideCells && root.tiles_per_zone() > 0 &&
                     root.tiles_per_zone() < 256;
  if (!sound) return bad_file(name, "its numbers make no sense");
  for (uint32_t i = 0; i < 6; ++i) {
    const double limit = i % 3 == 1 ? kMaxHeight : 1e12;
    if (!(std::fabs(bounds->Get(i)) <= limit) || bounds->Get(i) < bounds->Get(i % 3)) {
      return bad_file(name, "its bounds make no sense");
    }
  }

  auto world = std::make_shared<WorldData>();
  WorldSummary& summary = world->summary;
  summary.cell = root.cell();
  summary.resolution = root.resolution();
  summary.origin = {root.origin_x(), 0, root.origin_z()};
  summary.bounds.min = {bounds->Get(0), bounds->Get(1), bounds->Get(2)};
  summary.bounds.max = {bounds->Get(3), bounds->Get(4), bounds->Get(5)};
  summary.source_triangles = root.source_triangles();
  world->width = root.width();
  world->depth = root.depth();
  world->tiles_per_zone = root.tiles_per_zone();
  const auto tiles = [](int32_t cells) { return (cells + 63) / 64; };
  summary.tiles_x = tiles(root.width());
  summary.tiles_z = tiles(root.depth());
  const auto per_zone = static_cast<int32_t>(root.tiles_per_zone());
  world->zones_x = (summary.tiles_x + per_zone - 1) / per_zone;
  world->zones_z = (summary.tiles_z + per_zone - 1) / per_zone;
  if (int64_t{world->zones_x} * world->zones_z > (1 << 26))
    return bad_file(name, "its grid is absurd");
  world->slot_of_zone.assign(
      static_cast<size_t>(world->zones_x) * static_cast<size_t>(world->zones_z), -1);
  for (uint32_t c = 0; c < root.classes()->size(); ++c) {
    const format::ClassEntry& entry = *root.classes()->Get(c);
    summary.classes.push_back({.name = entry.name() ? entry.name()->str() : "",
                               .height = entry.height(),
                               .radius = entry.radius(),
                               .step_height = entry.step(),
                               .max_slope = entry.max_slope(),
                               .speed = entry.speed(),
                               .climb_slope = entry.climb_slope(),
                               .max_drop = entry.max_drop(),
                               .turning_radius = entry.turning_radius()});
    summary.walkable_area.push_back(entry.walkable_area());
    world->class_index.push_back(std::make_unique<ClassIndex>());
  }
  if (auto ok = check_classes(summary.classes); !ok) return bad_file(name, ok.error().message);
  uint64_t level_count = 0;
  int64_t last_place = -1;
  for (uint32_t i = 0; i < root.zones()->size(); ++i) {
    auto slot = std::make_unique<WorldData::Slot>();
    slot->entry = *root.zones()->Get(i);
    const int32_t x = slot->entry.x(), z = slot->entry.z();
    if (x < 0 || z < 0 || x >= world->zones_x || z >= world->zones_z) {
      return bad_file(name, "zone " + std::to_string(i) + " lies outside the grid");
    }
    const auto place = int64_t{z} * world->zones_x + x;
    if (place <= last_place) return bad_file(name, "its zones are out of order");
    last_place = place;
    if (slot->entry.levels() * sizeof(format::Level) > slot->entry.bytes()) {
      return bad_file(name, "zone " + std::to_string(i) + " has more levels than bytes");
    }
    slot->first_level = static_cast<uint32_t>(level_count);
    level_count += slot->entry.levels();
    summary.bytes += slot->entry.bytes();
    world->slot_of_zone[static_cast<size_t>(z * world->zones_x + x)] = static_cast<int32_t>(i);
    world->slots.push_back(std::move(slot));
  }
  if (level_count >= UINT32_MAX) return bad_file(name, "more than 2^32 levels");
  if (root.inputs() != nullptr && is_aligned(*root.inputs())) {
    for (const format::ZoneInput* input : *root.inputs()) world->inputs.push_back(*input);
  }
  world->level_count = static_cast<uint32_t>(level_count);
  summary.zones = world->slots.size();
  summary.level_tiles = level_count;
  return world;
}

std::vector<uint8_t> write_manifest(const WorldData& world) {
  flatbuffers::FlatBufferBuilder builder;
  std::vector<flatbuffers::Offset<format::ClassEntry>> classes;
  const WorldSummary& s = world.summary;
  for (size_t c = 0; c < s.classes.size(); ++c) {
    const AvatarClass& a = s.classes[c];
    classes.push_back(format::CreateClassEntryDirect(
        builder, a.name.c_str(), a.height, a.radius, a.step_height, a.max_slope, a.speed,
        s.walkable_area[c], a.climb_slope, a.max_drop, a.turning_radius));
  }
  std::vector<format::ZoneEntry> zones;
  for (const auto& slot : world.slots) zones.push_back(slot->entry);
  const std::vector<double> bounds{s.bounds.min.x, s.bounds.min.y, s.bounds.min.z,
                                   s.bounds.max.x, s.bounds.max.y, s.bounds.max.z};
  builder.Finish(
      format::CreateManifestDirect(builder, kManifestVersion, s.cell, s.resolution, s.origin.x,
                                   s.origin.z, world.width, world.depth, world.tiles_per_zone,
                                   &bounds, s.source_triangles, &zones, &classes, &world.inputs),
      format::ManifestIdentifier());
  return {builder.GetBufferPointer(), builder.GetBufferPointer() + builder.GetSize()};
}

}  // namespace throng::world
