// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "world/air_data.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <filesystem>
#include <system_error>

#include "core/hash.h"
#include "world/zone_data.h"

// Reads and checks files of air, and queries them: is a cell free, and may a body be in it.
namespace throng::world {
namespace {

constexpr const char* kAirZoneIdentifier = "THAZ";
constexpr const char* kManifestIdentifier = "THAM";
uint64_t sum_of(uint64_t input, const AirTree& tree) {
  const uint64_t head[] = {input, static_cast<uint64_t>(tree.side),
                           static_cast<uint64_t>(tree.base), tree.roots};
  return hash_span(tree.leaves, hash_span(tree.nodes, hash_span(std::span<const uint64_t>(head))));
}

}  // namespace

flatbuffers::DetachedBuffer air_zone_bytes(int32_t x, int32_t z, uint64_t input,
                                           const AirTreeData& tree) {
  flatbuffers::FlatBufferBuilder builder(tree.nodes.size() * 4 + tree.leaves.size() * 8 + 256);
  const auto nodes = builder.CreateVector(tree.nodes);
  const auto leaves = builder.CreateVector(tree.leaves);
  builder.Finish(
      format::CreateAirZone(builder, kAirVersion, x, z, input, sum_of(input, tree.view()),
                            tree.side, tree.base, tree.roots, nodes, leaves),
      kAirZoneIdentifier);
  return builder.Release();
}

Result<void> AirZone::attach(const std::string& name) {
  flatbuffers::Verifier verifier(bytes().data(), bytes().size());
  if (bytes().size() < 8 || !flatbuffers::BufferHasIdentifier(bytes().data(), kAirZoneIdentifier) ||
      !verifier.VerifyBuffer<format::AirZone>(kAirZoneIdentifier)) {
    return bad_file(name, "not an air file, or truncated");
  }
  root_ = flatbuffers::GetRoot<format::AirZone>(bytes().data());
  if (root_->version() != kAirVersion) {
    return bad_file(name, "air version " + std::to_string(root_->version()) +
                              ", this program reads " + std::to_string(kAirVersion));
  }
  const auto* nodes = root_->nodes();
  const auto* leaves = root_->leaves();
  if (!nodes || !leaves || !is_aligned(*leaves)) return bad_file(name, "an array is missing");
  tree_ = {root_->side(),
           root_->base(),
           root_->roots(),
           {reinterpret_cast<const uint32_t*>(nodes->Data()), nodes->size()},
           {reinterpret_cast<const uint64_t*>(leaves->Data()), leaves->size()}};
  const bool in_world = tree_.base >= -kMaxAirLayers && tree_.base <= kMaxAirLayers &&
                        int64_t{tree_.side} * tree_.roots <= 4 * int64_t{kMaxAirLayers};
  if (!in_world) {
    return bad_file(name, "its layers lie out of this world");
  }
  if (const std::string fault = tree_.fault(); !fault.empty()) return bad_file(name, fault);
  if (root_->sum() != sum_of(root_->input(), tree_)) return bad_file(name, "its checksum is wrong");
  return {};
}

AirData::ZoneAir AirData::zone(int32_t x, int32_t z) const {
  const int32_t slot = slot_of_zone[static_cast<size_t>(z * zones_x + x)];
  if (slot == kNotThere) return {};
  if (slot < 0) return {true, nullptr};
  const Slot& entry = *slots[static_cast<size_t>(slot)];
  std::call_once(entry.once, [&] {
    if (entry.zone || path.empty()) return;
    const format::AirEntry& listed = entry.entry;
    entry.open({.name = path + "/" + air_file_name(listed.x(), listed.z()),
                .bytes = listed.bytes(),
                .hash = listed.hash(),
                .whose = "the air manifest's"},
               [&](const AirZone& zone) {
                 return zone.root().x() == listed.x() && zone.root().z() == listed.z() &&
                        zone.tree().side >= zone_side;
               });
  });
  if (entry.zone == nullptr) return {};
  return {true, &entry.zone->tree()};
}

bool AirData::is_free(int32_t x, int32_t y, int32_t z) const {
  if (x < 0 || z < 0 || x >= width || z >= depth || y < shape.floor) return false;
  if (y >= shape.ceiling) return true;
  const int32_t zx = x / zone_side, zz = z / zone_side;
  const ZoneAir air = zone(zx, zz);
  if (!air.usable) return false;
  if (air.tree == nullptr) return true;
  const AirTree& tree = *air.tree;
  const int64_t up = int64_t{y} - tree.base;
  if (up < 0 || up >= int64_t{tree.side} * tree.roots) return true;
  return tree.is_free(x - zx * zone_side, y, z - zz * zone_side);
}

bool AirData::is_legal(const AirBody& body, int32_t x, int32_t y, int32_t z) const {
  if (x < 0 || z < 0 || x >= width || z >= depth || y < shape.floor || y >= shape.ceiling) {
    return false;
  }
  const int32_t zx = x / zone_side, zz = z / zone_side;
  const ZoneAir air = zone(zx, zz);
  if (air.usable && air.tree != nullptr) {
    // An air box with clearance around it answers at once.
    const auto place = air.tree->find(x - zx * zone_side, y, z - zz * zone_side);
    if (air_kind(place.word) == AirKind::kFree) {
      const AirClearance clearance = air_clearance(air_number(place.word));
      if (clearance.width >= body.reach && clearance.height >= body.up) return true;
    }
  }
  for (int32_t dy = 0; dy <= body.up; ++dy) {
    for (int32_t dz = -body.reach; dz <= body.reach; ++dz) {
      const int32_t half = body.half_width[static_cast<size_t>(std::abs(dz))];
      for (int32_t dx = -half; dx <= half; ++dx) {
        if (!is_free(x + dx, y + dy, z + dz)) return false;
      }
    }
  }
  return true;
}

void AirData::fit(const WorldData& world) {
  zone_side = static_cast<int32_t>(world.tiles_per_zone) * 64 / shape.multiple;
  width = (world.width + shape.multiple - 1) / shape.multiple;
  depth = (world.depth + shape.multiple - 1) / shape.multiple;
  zones_x = world.zones_x;
  zones_z = world.zones_z;
  slot_of_zone.assign(static_cast<size_t>(zones_x) * static_cast<size_t>(zones_z), -1);
}

// The distance between two cells is how much nearer the feet may be than their cells' numbers say:
// a cell `d` away may be `d - 1` cells away. What is nearer than the radius must be free.
AirBody air_body(const AvatarClass& avatar, const AirShape& shape) {
  AirBody body;
  body.half_width = {0};
  if (shape.points) return body;
  const double cell = shape.cell * 1e-3, radius = avatar.radius / cell;
  body.reach = static_cast<int32_t>(std::ceil(radius));
  body.up = static_cast<int32_t>(std::ceil(avatar.height / cell));
  body.half_width.clear();
  for (int32_t dz = 0; dz <= body.reach; ++dz) {
    const double gap = std::max(dz - 1, 0), rest = radius * radius - gap * gap;
    body.half_width.push_back(rest > 0 ? static_cast<int32_t>(std::ceil(std::sqrt(rest))) : 0);
  }
  return body;
}

std::string air_file_name(int32_t x, int32_t z) {
  return "zone_" + std::to_string(x) + "_" + std::to_string(z) + ".tha";
}

Result<std::shared_ptr<AirData>> read_air_manifest(std::span<const uint8_t> bytes,
                                                   const std::string& name, const WorldData& world,
                                                   uint64_t world_hash) {
  flatbuffers::Verifier verifier(bytes.data(), bytes.size());
  if (bytes.size() < 8 || !flatbuffers::BufferHasIdentifier(bytes.data(), kManifestIdentifier) ||
      !verifier.VerifyBuffer<format::AirManifest>(kManifestIdentifier)) {
    return bad_file(name, "not an air manifest, or truncated");
  }
  const auto& root = *flatbuffers::GetRoot<format::AirManifest>(bytes.data());
  if (root.version() != kAirVersion) {
    return bad_file(name, "air version " + std::to_string(root.version()) +
                              ", this program reads " + std::to_string(kAirVersion));
  }
  if (root.world() != world_hash) return bad_file(name, "belongs to another bake of this world");
  const int32_t multiple = root.multiple();
  const bool sound = root.zones() != nullptr && is_aligned(*root.zones()) && multiple >= 1 &&
                     multiple <= 16 && std::has_single_bit(static_cast<uint32_t>(multiple)) &&
                     root.cell() >= 1 && root.cell() <= 80000 && root.floor() < root.ceiling() &&
                     root.origin_y() >= -root.cell() && root.origin_y() <= root.cell() &&
                     root.floor() > -kMaxAirLayers && root.ceiling() < kMaxAirLayers &&
                     root.flies() >> world.summary.classes.size() == 0;
  if (!sound) return bad_file(name, "its numbers make no sense");
  auto air = std::make_shared<AirData>();
  air->shape = {.multiple = multiple,
                .cell = root.cell(),
                .origin_y = root.origin_y(),
                .floor = root.floor(),
                .ceiling = root.ceiling(),
                .flies = root.flies(),
                .points = root.points()};
  air->fit(world);
  int64_t last = -1;
  for (uint32_t i = 0; i < root.zones()->size(); ++i) {
    const format::AirEntry& entry = *root.zones()->Get(i);
    if (entry.x() < 0 || entry.z() < 0 || entry.x() >= air->zones_x || entry.z() >= air->zones_z) {
      return bad_file(name, "zone " + std::to_string(i) + " lies outside the grid");
    }
    const auto place = int64_t{entry.z()} * air->zones_x + entry.x();
    if (place <= last) return bad_file(name, "its zones are out of order");
    last = place;
    air->slot_of_zone[static_cast<size_t>(place)] = static_cast<int32_t>(i);
    air->slots.push_back(std::make_unique<AirData::Slot>());
    air->slots.back()->entry = entry;
    air->bytes += entry.bytes();
  }
  return air;
}

Result<void> check_air_index(const WorldData& world) {
  if (world.air != nullptr || world.path.empty()) return {};
  for (const format::ZoneInput& zone : world.inputs) {
    const std::string file = air_file_name(zone.x(), zone.z());
    std::error_code error;
    if (!std::filesystem::exists(world.path + "/" + file, error)) continue;
    return bad_file(world.path + "/" + kAirManifest, "is missing, though " + file + " is there");
  }
  return {};
}

std::vector<uint8_t> write_air_manifest(const AirData& air, uint64_t world_hash) {
  flatbuffers::FlatBufferBuilder builder;
  std::vector<format::AirEntry> zones;
  for (const auto& slot : air.slots) zones.push_back(slot->entry);
  const AirShape& s = air.shape;
  builder.Finish(
      format::CreateAirManifestDirect(builder, kAirVersion, world_hash, s.multiple, s.cell,
                                      s.origin_y, s.floor, s.ceiling, s.flies, s.points, &zones),
      kManifestIdentifier);
  return {builder.GetBufferPointer(), builder.GetBufferPointer() + builder.GetSize()};
}

}  // namespace throng::world
