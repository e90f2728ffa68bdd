// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "whole_graph.h"

#include <algorithm>
#include <map>
#include <utility>

#include "core/access.h"

// Links tile by tile with the library's TileRegions, components by floods over regions.
namespace throng::test {
namespace {

struct Tiles {
  int32_t wide = 0, deep = 0;
  std::vector<graph::TileParts> parts;
  std::vector<uint32_t> base;  // per tile: its first region of the world
};

Tiles find_tiles(const world::WorldData& world, const graph::TileRegions& finder) {
  Tiles tiles;
  graph::TileScratch scratch;
  tiles.wide = world.summary.tiles_x;
  tiles.deep = world.summary.tiles_z;
  std::vector<uint32_t> of_level(world.level_count + 1, 0);
  for (int32_t z = 0; z < tiles.deep; ++z) {
    for (int32_t x = 0; x < tiles.wide; ++x) {
      tiles.parts.push_back(finder.linked_parts(x, z, scratch));
      const graph::TileParts& tile = tiles.parts.back();
      for (uint32_t l = 0; l < tile.levels; ++l) {
        of_level[tile.first_level + l + 1] = tile.first[l + 1] - tile.first[l];
      }
    }
  }
  for (size_t l = 0; l < world.level_count; ++l) of_level[l + 1] += of_level[l];
  for (const graph::TileParts& tile : tiles.parts) {
    tiles.base.push_back(tile.levels > 0 ? of_level[tile.first_level] : 0);
  }
  return tiles;
}

// Floods from region to region, class by class, over lists of neighbours.
void find_components(WholeGraph& graph, const std::vector<std::map<uint32_t, uint32_t>>& cells) {
  for (size_t c = 0; c < cells.size(); ++c) {
    std::vector<std::vector<uint32_t>> next(graph.regions.size());
    for (const graph::RegionLink& link : graph.links) {
      if ((link.classes >> c & 1) == 0) continue;
      next[link.a].push_back(link.b);
      next[link.b].push_back(link.a);
    }
    std::vector<int64_t> of(graph.regions.size(), -1);
    std::vector<WholeGraph::Component> found;
    for (const auto& [start, unused] : cells[c]) {
      if (of[start] >= 0) continue;
      const auto name = static_cast<int64_t>(found.size());
      found.push_back({0, 0, start});
      std::vector<uint32_t> open{start};
      of[start] = name;
      while (!open.empty()) {
        const uint32_t r = open.back();
        open.pop_back();
        found.back().cells += cells[c].at(r);
        ++found.back().regions;
        for (const uint32_t n : next[r]) {
          if (of[n] >= 0) continue;
          of[n] = name;
          open.push_back(n);
        }
      }
    }
    std::vector<size_t> order(found.size());
    for (size_t i = 0; i < order.size(); ++i) order[i] = i;
    std::stable_sort(order.begin(), order.end(),
                     [&](size_t a, size_t b) { return found[a].cells > found[b].cells; });
    std::vector<int64_t> rank(found.size());
    graph.components.emplace_back();
    for (size_t i = 0; i < order.size(); ++i) {
      rank[order[i]] = static_cast<int64_t>(i);
      graph.components.back().push_back(found[order[i]]);
    }
    for (int64_t& name : of) name = name < 0 ? name : rank[static_cast<size_t>(name)];
    graph.component.push_back(std::move(of));
  }
}

}  // namespace

WholeGraph whole_graph(const World& of_world) {
  const world::WorldData& world = *data_of(of_world);
  const graph::TileRegions finder(world);
  const Tiles tiles = find_tiles(world, finder);
  const size_t classes = world.summary.classes.size();
  WholeGraph graph;
  std::map<std::pair<uint32_t, uint32_t>, uint32_t> links;
  std::vector<std::map<uint32_t, uint32_t>> cells(classes);  // per class: cells of a region
  const auto add = [&](const std::vector<graph::RegionLink>& found, uint32_t a, uint32_t b) {
    for (const graph::RegionLink& link : found) {
      const uint32_t from = link.a + a, to = link.b + b;
      links[{std::min(from, to), std::max(from, to)}] |= link.classes;
    }
  };
  graph::TileScratch scratch;
  for (size_t t = 0; t < tiles.parts.size(); ++t) {
    const graph::TileParts& tile = tiles.parts[t];
    if (tile.levels == 0) continue;
    const uint32_t base = tiles.base[t];
    graph.regions.resize(std::max(graph.regions.size(), base + tile.regions.size()));
    std::copy(tile.regions.begin(), tile.regions.end(), graph.regions.begin() + base);
    for (size_t i = 0; i < tile.classes.size(); ++i) {
      for (uint32_t p = tile.classes[i].first; p < tile.classes[i].last; ++p) {
        cells[i % classes][base + tile.parts[p].region] = tile.parts[p].cells;
      }
    }
    const auto x = static_cast<int32_t>(t) % tiles.wide, z = static_cast<int32_t>(t) / tiles.wide;
    const size_t south = t + static_cast<size_t>(tiles.wide);
    add(tile.links, base, base);
    if (x + 1 < tiles.wide) {
      add(finder.border(x, z, graph::kEast, tile, tiles.parts[t + 1], scratch), base,
          tiles.base[t + 1]);
    }
    if (z + 1 < tiles.deep) {
      add(finder.border(x, z, graph::kSouth, tile, tiles.parts[south], scratch), base,
          tiles.base[south]);
    }
  }
  for (const auto& [ends, bits] : links) graph.links.push_back({ends.first, ends.second, bits});
  find_components(graph, cells);
  return graph;
}

}  // namespace throng::test
