// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>

#include "baked.h"
#include "core/random.h"
#include "patch_nets.h"
#include "throng/surface.h"

// What every world's nodes must be: links lead back, and widths are there. In built-in worlds and,
// where they are, shared ones.
namespace throng {
namespace {

// Walkers and climbers.
std::vector<AvatarClass> many_classes() {
  std::vector<AvatarClass> classes = default_classes();
  classes.push_back({.name = "climber"});
  classes.back().climb_slope = 180;
  classes.push_back({.name = "gecko", .height = 0.5, .radius = 0.15, .step_height = 0.2});
  classes.back().climb_slope = 95;
  return classes;
}

struct Made {
  World world;
  Nodes nodes;
};

Made make(const Scene& scene, double cell, double size) {
  Context context;
  Made made{test::bake(scene, cell, many_classes()), {}};
  const auto nodes = Nodes::create(made.world, scene, {.size = size}, context);
  EXPECT_TRUE(nodes) << nodes.error().message;
  if (nodes) made.nodes = *nodes;
  return made;
}

bool shared_worlds() { return std::filesystem::is_directory(THRONG_SHARED_WORLDS); }

Scene shared_world(const char* model) {
  Context context;
  SceneConfig config;
  config.sources.push_back({.path = std::string(THRONG_SHARED_WORLDS) + "/" + model,
                            .up = {},
                            .scale = {},
                            .transform = {}});
  const auto scene = load_scene(config, context);
  EXPECT_TRUE(scene) << scene.error().message;
  return scene ? *scene : Scene{};
}

// Returns how many hole links there are.
size_t check_arcs(const std::string& name, const Nodes& nodes) {
  size_t arcs = 0, hole_links = 0, one_way = 0;
  for (uint32_t n = 0; n < nodes.node_count(); ++n) {
    const NodeInfo here = nodes.node(n);
    for (const NodeArc& arc : nodes.arcs(n)) {
      EXPECT_LT(arc.to, nodes.node_count()) << name;
      if (arc.to >= nodes.node_count()) return hole_links;
      const NodeInfo there = nodes.node(arc.to);
      EXPECT_EQ(arc.classes & ~here.classes & 0xffff, 0) << name;
      EXPECT_EQ(arc.classes & ~there.classes & 0xffff, 0) << name;
      EXPECT_NE(arc.classes, 0) << name;
      const auto back = nodes.arcs(arc.to);
      one_way += std::none_of(back.begin(), back.end(), [&](const NodeArc& b) {
        return b.to == n && b.kind == arc.kind && b.classes == arc.classes &&
               b.over_hole == arc.over_hole && b.from_s == arc.to_s && b.to_t == arc.from_t;
      });
      ++arcs;
      hole_links += arc.over_hole ? 1 : 0;
    }
  }
  EXPECT_EQ(one_way, 0u) << name;
  EXPECT_GT(arcs, 500u) << name;
  return hole_links;
}

TEST(Nodes, EveryArcLeadsBack) {
  for (const char* name : {"stairs", "garage", "bridge", "church", "powerplant", "maze"}) {
    EXPECT_EQ(check_arcs(name, make(test::builtin({.name = name}), 0.4, 1.5).nodes), 0u) << name;
  }
  check_arcs("city", make(test::builtin({.name = "city", .size = 100}), 0.4, 1.5).nodes);
  const Scene landscape = test::builtin({.name = "landscape", .size = 160});
  EXPECT_GT(check_arcs("landscape", make(landscape, 0.4, 1.5).nodes), 0u);
  check_arcs("net", make(test::net_scene({.side = 3, .cell = 8, .relief = 6}), 0.4, 0.7).nodes);
}

TEST(Nodes, EveryArcLeadsBackInSharedWorlds) {
  if (!shared_worlds()) GTEST_SKIP() << "no shared worlds here";
  for (const char* model : {"recast/dungeon.obj", "quake3/oa_dm5.bsp", "nel/3_AC.zonel"}) {
    check_arcs(model, make(shared_world(model), 0.4, 2).nodes);
  }
}

// A disc around the middle of a node of a level tile may not hold a cell that lacks a class of the
// node, on the node's own level.
size_t check_tile_widths(const std::string& name, const Made& made, uint32_t every) {
  const NodeBins bins = made.nodes.summary().bins;
  const double cell = made.world.summary().cell;
  std::map<uint32_t, LevelTileContent> tiles;
  size_t tested = 0, missing = 0;
  for (uint32_t n = 0; n < made.nodes.node_count(); n += every) {
    const NodeInfo info = made.nodes.node(n);
    const double width = bins.width_of(info.width);
    if (width == 0 || info.kind != PatchKind::kLevelTile) continue;
    if (!tiles.contains(info.source)) tiles[info.source] = made.world.level_tile(info.source);
    const LevelTileContent& tile = tiles[info.source];
    const double size = 64 >> info.block_level, s = (info.s + 0.5) * size,
                 t = (info.t + 0.5) * size;
    for (int32_t i = 0; i < 4096; ++i) {
      const double ds = std::max(0.0, std::abs(i % 64 + 0.5 - s) - 0.5);
      const double dt = std::max(0.0, std::abs(i / 64 + 0.5 - t) - 0.5);
      if ((ds * ds + dt * dt) * cell * cell >= width * width * (1 - 1e-9)) continue;
      for (size_t c = 0; c < tile.clearance.size(); ++c) {
        missing += (info.classes >> c & 1) != 0 && tile.clearance[c][static_cast<size_t>(i)] <= 0;
      }
    }
    ++tested;
  }
  EXPECT_EQ(missing, 0u) << name;
  return tested;
}

// On a curved patch: straight on by its parameters from the middle of a node, as long as that stays
// within the width, the smallest node promises no less.
size_t check_patch_widths(const std::string& name, const Nodes& nodes, uint32_t every) {
  const NodeBins bins = nodes.summary().bins;
  std::map<uint32_t, std::vector<uint32_t>> of_patch;
  for (uint32_t n = 0; n < nodes.node_count(); ++n) {
    const NodeInfo info = nodes.node(n);
    if (info.kind == PatchKind::kBezier) of_patch[info.source].push_back(n);
  }
  size_t tested = 0, broken = 0;
  for (uint32_t n = 0; n < nodes.node_count(); n += every) {
    const NodeInfo info = nodes.node(n);
    const double width = bins.width_of(info.width);
    if (width == 0 || info.kind != PatchKind::kBezier) continue;
    const double side = 1.0 / (1 << info.block_level);
    const double s0 = (info.s + 0.5) * side, t0 = (info.t + 0.5) * side;
    const Vec3d middle = nodes.point(n, s0, t0);
    for (uint64_t ray = 0; ray < 16; ++ray) {
      const double turn = 6.283185307 * random_unit(7, n, ray);
      for (double along = 0.02;; along += 0.02) {
        const double s = s0 + along * side * std::cos(turn), t = t0 + along * side * std::sin(turn);
        if (s < 0 || t < 0 || s >= 1 || t >= 1) break;
        if (length(nodes.point(n, s, t) - middle) >= width * (1 - 1e-6)) break;
        const NodeInfo* smallest = nullptr;
        NodeInfo found;
        for (const uint32_t m : of_patch[info.source]) {
          const NodeInfo other = nodes.node(m);
          const double blocks = 1 << other.block_level;
          if (std::floor(s * blocks) != other.s || std::floor(t * blocks) != other.t) continue;
          if (smallest != nullptr && found.block_level > other.block_level) continue;
          found = other;
          smallest = &found;
        }
        broken += smallest == nullptr || (info.classes & ~found.classes) != 0 ||
                  found.inclination > info.inclination || found.height < info.height ||
                  found.headroom < info.headroom;
        ++tested;
      }
    }
  }
  EXPECT_EQ(broken, 0u) << name;
  return tested;
}

TEST(Nodes, WidthsAreNeverTooWide) {
  EXPECT_GT(check_tile_widths("garage", make(test::builtin({.name = "garage"}), 0.2, 1), 7), 100u);
  EXPECT_GT(check_tile_widths("bridge", make(test::builtin({.name = "bridge"}), 0.25, 1), 5), 50u);
  const Scene landscape = test::builtin({.name = "landscape", .size = 100, .seed = 3});
  EXPECT_GT(check_patch_widths("landscape", make(landscape, 0.5, 1.5).nodes, 5), 5000u);
  const Scene net = test::net_scene({.side = 3, .cell = 8, .relief = 6});
  EXPECT_GT(check_patch_widths("net", make(net, 0.4, 0.7).nodes, 5), 1000u);
}

TEST(Nodes, WidthsAreNeverTooWideInSharedWorlds) {
  if (!shared_worlds()) GTEST_SKIP() << "no shared worlds here";
  const Made arena = make(shared_world("quake3/oa_dm5.bsp"), 0.2, 1);
  EXPECT_GT(check_tile_widths("oa_dm5", arena, 3), 50u);
  check_patch_widths("oa_dm5", arena.nodes, 3);
  EXPECT_GT(check_patch_widths("3_AC", make(shared_world("nel/3_AC.zonel"), 0.5, 2).nodes, 5),
            5000u);
}

}  // namespace
}  // namespace throng
