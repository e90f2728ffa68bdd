// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "path/ground/hub_labels.h"

#include <algorithm>
#include <utility>

#include "core/parallel.h"

// Casts from every corner, then labels the visibility graph of the corners ([LPW79]) by hubs. Time:
// the blocks and corners that each corner sees, and a pruned Dijkstra search from each corner
// (two_hop.cpp).
namespace throng::path {
namespace {

// Turns "what each corner sees" into "by which corners each block is seen".
void list_candidates(const PathMesh& mesh, const std::vector<std::vector<SeenBlock>>& blocks,
                     HubLabels& out) {
  out.first_candidate.assign(mesh.block_count() + 1, 0);
  for (const auto& of_corner : blocks) {
    for (const SeenBlock& b : of_corner) ++out.first_candidate[b.block + 1];
  }
  for (size_t r = 1; r < out.first_candidate.size(); ++r)
    out.first_candidate[r] += out.first_candidate[r - 1];
  out.candidates.resize(out.first_candidate.back());
  std::vector<uint32_t> at(out.first_candidate.begin(), out.first_candidate.end() - 1);
  for (uint32_t c = 0; c < blocks.size(); ++c) {
    for (const SeenBlock& b : blocks[c]) out.candidates[at[b.block]++] = {c & 0x7fffffff, b.whole};
  }
}

PathGraph cast_from_corners(const PathMesh& mesh, int32_t workers, const Context& context,
                            HubLabels& out) {
  const size_t count = mesh.corner_count();
  std::vector<std::vector<SeenBlock>> blocks(count);  // of each corner
  std::vector<std::vector<SeenCorner>> seen(count);
  constexpr size_t kGrain = 64;
  parallel_ranges(count, kGrain, workers, [&](size_t begin, size_t end) {
    Sight sight;
    for (size_t c = begin; c < end && !context.cancel; ++c) {
      sight.cast_from_corner(mesh, static_cast<uint32_t>(c), true);
      seen[c] = sight.corners();
      blocks[c] = sight.blocks();
    }
  });
  list_candidates(mesh, blocks, out);
  // What one sees the other does, even where rounding hid it from one of them.
  struct Pair {
    uint32_t from, to;
    double length;
  };
  std::vector<Pair> pairs;
  for (uint32_t c = 0; c < count; ++c) {
    for (const SeenCorner& s : seen[c]) {
      pairs.push_back({c, s.corner, s.distance});
      pairs.push_back({s.corner, c, s.distance});
    }
    seen[c] = {};
  }
  std::sort(pairs.begin(), pairs.end(), [](const Pair& a, const Pair& b) {
    return a.from != b.from ? a.from < b.from : a.to < b.to;
  });
  PathGraph graph;
  graph.first.assign(count + 1, 0);
  for (size_t i = 0; i < pairs.size(); ++i) {
    if (i > 0 && pairs[i].from == pairs[i - 1].from && pairs[i].to == pairs[i - 1].to) continue;
    graph.edges.push_back({pairs[i].to, pairs[i].length});
    ++graph.first[pairs[i].from + 1];
  }
  for (size_t c = 0; c < count; ++c) graph.first[c + 1] += graph.first[c];
  return graph;
}

}  // namespace

Result<HubLabels> build_labels(const PathMesh& mesh, int32_t workers, Context& context) {
  HubLabels out;
  const PathGraph graph = cast_from_corners(mesh, workers, context, out);
  if (context.cancel) return Error{Errc::kCancelled, "path: cancelled"};
  constexpr uint64_t kSamples = 256;
  auto labels = label_graph(graph, kSamples, workers, context);
  if (!labels) return labels.error();
  static_cast<TwoHopLabels&>(out) = std::move(*labels);
  constexpr uint64_t kMaxEntries = uint64_t{1} << 25;  // 320 MiB
  if (mesh.block_side == kSmallBlock)
    out.by_block = build_block_labels(mesh, out, workers, kMaxEntries);
  if (out.by_block.first.empty()) out.by_middle = build_middle_labels(mesh, out, workers);
  return out;
}

}  // namespace throng::path
