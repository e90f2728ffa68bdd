// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "path/ground/mesh.h"

#include <algorithm>
#include <array>
#include <optional>
#include <tuple>
#include <utility>

#include "core/parallel.h"
#include "graph/ground_parts.h"
#include "path/ground/baked_cells.h"
#include "path/ground/mesh_border.h"
#include "path/ground/rects.h"
#include "world/place.h"

// Cuts all level tiles into rectangles, then finds their portals, corners and components. Linear in
// the cells, parallel by level tile.
namespace throng::path {
namespace {

class Builder {
 public:
  Builder(const world::WorldData& world, int32_t avatar_class)
      : ground_{{world, avatar_class}},
        step_(world::step_mm(world.summary.classes[static_cast<size_t>(avatar_class)])) {}

  [[nodiscard]] int32_t step() const { return step_; }

  [[nodiscard]] std::vector<MeshRect> find_rects(uint32_t level) const {
    const world::GroundLevel ground = ground_.level(level);
    const world::CellRows legal = graph::legal_rows(ground);
    const auto cuts = graph::step_cuts(ground, legal, step_);
    const auto [tile_x, tile_z] = world::tile_of(ground_.world, *ground.zone, *ground.view.record);
    std::vector<MeshRect> rects;
    for (const CellRect& r : tile_with_rects(legal, cuts ? &*cuts : nullptr)) {
      rects.push_back({level, tile_x * kTileCells + r.x0, tile_z * kTileCells + r.z0, r.x1 - r.x0,
                       r.z1 - r.z0, 0});
    }
    return rects;
  }

  // Of all cells where the class may stand, bit by kind.
  [[nodiscard]] uint64_t find_kinds(uint32_t level) const {
    const world::GroundLevel ground = ground_.level(level);
    const world::CellRows legal = graph::legal_rows(ground);
    uint64_t found = 0;
    const format::Level& record = *ground.view.record;
    if (record.area_kind() != format::CellsKind::Blocks) {
      const bool is_any =
          std::any_of(legal.begin(), legal.end(), [](auto row) { return row != 0; });
      return is_any ? uint64_t{1} << record.area_value() : 0;
    }
    const std::array<uint8_t, 4096> kinds = baked_kinds(ground);
    for (size_t c = 0; c < kinds.size(); ++c) {
      if ((legal[c / 64] >> (c % 64) & 1) != 0) found |= uint64_t{1} << kinds[c];
    }
    return found;
  }

  void find_portals(const PathMesh& mesh, const MeshRect& rect,
                    std::vector<FoundPortal>& portals) const {
    const world::GroundLevel level = ground_.level(rect.level);
    const MeshBorder border(ground_.world, ground_, step_);
    const auto rect_at = [&](const world::GroundLevel& of, int32_t x, int32_t z) {
      return mesh.rect_at(of.world_level, x, z);
    };
    const size_t before = portals.size();
    border.find_portals(level, rect, rect_at, portals);
    for (size_t p = before; p < portals.size(); ++p) border.find_corners(level, rect, portals[p]);
  }

 private:
  BakedGround ground_;
  int32_t step_;
};

// Numbers each connected component by its first rectangle.
void find_components(PathMesh& mesh) {
  const auto count = static_cast<uint32_t>(mesh.rects.size() - 1);
  std::vector<uint32_t> queue;
  for (uint32_t r = 0; r < count; ++r) mesh.rects[r].component = kNoRect;
  for (uint32_t r = 0; r < count; ++r) {
    if (mesh.rects[r].component != kNoRect) continue;
    queue.assign(1, r);
    mesh.rects[r].component = r;
    for (size_t i = 0; i < queue.size(); ++i) {
      const uint32_t end = mesh.rects[queue[i] + 1].first_portal;
      for (uint32_t p = mesh.rects[queue[i]].first_portal; p < end; ++p) {
        const uint32_t beyond = mesh.portals[p].rect;
        if (mesh.rects[beyond].component != kNoRect) continue;
        mesh.rects[beyond].component = r;
        queue.push_back(beyond);
      }
    }
  }
}

// The rectangles around each corner: every two of them share a portal that ends there.
void gather_corner_rects(PathMesh& mesh) {
  std::vector<std::pair<uint32_t, uint32_t>> around;  // corner, rectangle
  for (uint32_t r = 0; r + 1 < mesh.rects.size(); ++r) {
    for (uint32_t p = mesh.rects[r].first_portal; p < mesh.rects[r + 1].first_portal; ++p) {
      const MeshPortal& portal = mesh.portals[p];
      for (const uint32_t corner : {portal.from_corner, portal.to_corner}) {
        if (corner == kNoCorner) continue;
        around.push_back({corner, r});
        around.push_back({corner, portal.rect});
      }
    }
  }
  std::sort(around.begin(), around.end());
  around.erase(std::unique(around.begin(), around.end()), around.end());
  mesh.corners.emplace_back();
  for (const auto& [corner, rect] : around) {
    ++mesh.corners[corner + 1].first_rect;
    mesh.corner_rects.push_back(rect);
  }
  for (size_t c = 1; c < mesh.corners.size(); ++c)
    mesh.corners[c].first_rect += mesh.corners[c - 1].first_rect;
}

}  // namespace

uint32_t PathMesh::rect_at(uint32_t level, int32_t x, int32_t z) const {
  for (uint32_t r = first[level]; r < first[level + 1]; ++r) {
    const MeshRect& rect = rects[r];
    if (x >= rect.x && x < rect.x + rect.width && z >= rect.z && z < rect.z + rect.depth) return r;
  }
  return kNoRect;
}

MeshRect PathMesh::block(uint32_t rect, uint32_t n) const {
  MeshRect block = rects[rect];
  const int32_t across = (block.width + block_side - 1) / block_side;
  const int32_t x = static_cast<int32_t>(n) % across * block_side;
  const int32_t z = static_cast<int32_t>(n) / across * block_side;
  block.x += x;
  block.z += z;
  block.width = std::min(block_side, block.width - x);
  block.depth = std::min(block_side, block.depth - z);
  return block;
}

uint32_t cut_into_blocks(PathMesh& mesh, int32_t side) {
  mesh.block_side = side;
  uint32_t blocks = 0;
  for (MeshRect& rect : mesh.rects) {
    rect.first_block = blocks;
    blocks +=
        static_cast<uint32_t>((rect.width + side - 1) / side * ((rect.depth + side - 1) / side));
  }
  return blocks;
}

uint64_t PathMesh::bytes() const {
  return first.size() * sizeof(first[0]) + rects.size() * sizeof(MeshRect) +
         portals.size() * sizeof(MeshPortal) + corners.size() * sizeof(MeshCorner) +
         corner_rects.size() * sizeof(uint32_t);
}

Result<PathMesh> build_mesh(const world::WorldData& world, int32_t avatar_class, int32_t workers,
                            Context& context) {
  const Builder builder(world, avatar_class);
  PathMesh mesh;
  mesh.avatar_class = avatar_class;
  mesh.step = builder.step();
  constexpr size_t kGrain = 16;  // levels

  std::vector<std::vector<MeshRect>> rects(world.level_count);
  std::vector<uint64_t> kinds(world.level_count, 0);
  parallel_ranges(rects.size(), kGrain, workers, [&](size_t begin, size_t end) {
    for (size_t l = begin; l < end && !context.cancel; ++l) {
      rects[l] = builder.find_rects(static_cast<uint32_t>(l));
      kinds[l] = builder.find_kinds(static_cast<uint32_t>(l));
    }
  });
  for (const uint64_t of_level : kinds) mesh.kinds |= of_level;
  mesh.first.push_back(0);
  for (const auto& of_level : rects) {
    mesh.rects.insert(mesh.rects.end(), of_level.begin(), of_level.end());
    mesh.first.push_back(static_cast<uint32_t>(mesh.rects.size()));
  }

  std::vector<std::vector<FoundPortal>> portals(world.level_count);  // of a level's rectangles
  parallel_ranges(portals.size(), kGrain, workers, [&](size_t begin, size_t end) {
    for (size_t l = begin; l < end && !context.cancel; ++l) {
      for (uint32_t r = mesh.first[l]; r < mesh.first[l + 1]; ++r) {
        MeshRect& rect = mesh.rects[r];
        const size_t before = portals[l].size();
        builder.find_portals(mesh, rect, portals[l]);
        rect.first_portal = static_cast<uint32_t>(portals[l].size() - before);  // count, for now
      }
    }
  });
  if (context.cancel) return Error{Errc::kCancelled, "path: cancelled"};

  std::vector<CornerKey> keys;
  for (const auto& of_level : portals) {
    for (const FoundPortal& found : of_level) {
      if (found.from_corner) keys.push_back(*found.from_corner);
      if (found.to_corner) keys.push_back(*found.to_corner);
    }
  }
  std::sort(keys.begin(), keys.end());
  keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
  for (const CornerKey& key : keys) mesh.corners.push_back({key.x, key.z, key.away_x, key.away_z});
  const auto number = [&](const std::optional<CornerKey>& key) {
    if (!key) return kNoCorner;
    return static_cast<uint32_t>(std::lower_bound(keys.begin(), keys.end(), *key) - keys.begin());
  };
  uint32_t next = 0;
  for (MeshRect& rect : mesh.rects) next += std::exchange(rect.first_portal, next);
  mesh.rects.push_back({.first_portal = next});
  mesh.portals.reserve(next);
  for (const auto& of_level : portals) {
    for (const FoundPortal& found : of_level) {
      MeshPortal portal = found.portal;
      portal.from_corner = number(found.from_corner);
      portal.to_corner = number(found.to_corner);
      mesh.portals.push_back(portal);
    }
  }
  gather_corner_rects(mesh);
  find_components(mesh);
  constexpr uint32_t kMaxBlocks = 1 << 17;
  if (cut_into_blocks(mesh, kSmallBlock) > kMaxBlocks) cut_into_blocks(mesh, kLargeBlock);
  return mesh;
}

}  // namespace throng::path
