// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <chrono>
#include <cmath>
#include <numeric>
#include <optional>
#include <span>
#include <utility>

#include "bake/node_batch.h"
#include "bake/node_file.h"
#include "bake/node_folder.h"
#include "bake/node_plan.h"
#include "core/parallel.h"
#include "graph/node_bins.h"
#include "throng/scene.h"

// Which zones have to be made, in which batches, and where their nodes go.
namespace throng {
namespace {

using Clock = std::chrono::steady_clock;

Result<void> check(const World& world, const Scene& scene, const NodeConfig& config) {
  if (world.data() == nullptr) return Error{Errc::kBadInput, "nodes: the world is empty"};
  if (auto ok = check_node_config(config); !ok) return ok.error();
  if (scene.triangles.size() != world.summary().source_triangles) {
    return Error{Errc::kBadInput, "nodes: the world was not baked from this scene: it has " +
                                      std::to_string(world.summary().source_triangles) +
                                      " source triangles, the scene has " +
                                      std::to_string(scene.triangles.size())};
  }
  return {};
}

// Of calls that ran side by side.
Result<void> first_failure(std::span<const std::optional<Error>> failed) {
  for (const auto& failure : failed) {
    if (failure) return *failure;
  }
  return {};
}

class NodeBaker {
 public:
  // Without a folder nodes stay in memory.
  NodeBaker(const World& world, const Scene& scene, const NodeConfig& config, Context& context,
            const NodeFolder* folder)
      : world_(world),
        data_(*world.data()),
        scene_(scene),
        config_(config),
        context_(context),
        folder_(folder),
        bins_(make_bins(data_.summary.classes)) {}

  Result<std::shared_ptr<NodeData>> run() {
    const auto start = Clock::now();
    plan_ = plan_nodes(data_, scene_, config_);
    if (plan_.needs_triangles()) triangles_.emplace(scene_, config_.workers);
    is_done_.assign(plan_.zones.size(), 0);
    slots_.resize(plan_.zones.size());
    if (auto ok = keep_zones(); !ok) return ok.error();
    if (auto ok = make_zones(); !ok) return ok.error();
    auto nodes = gather();
    if (nodes->node_count >= kFarNode) return too_many_nodes();
    nodes->summary.zones_kept = kept_;
    nodes->summary.zones_made = plan_.zones.size() - kept_;
    nodes->summary.seconds = std::chrono::duration<double>(Clock::now() - start).count();
    return nodes;
  }

 private:
  // A world in memory does not know what it was made from.
  Result<void> keep_zones() {
    if (data_.path.empty()) return {};
    find_node_inputs(data_, scene_, config_, triangles_ ? &*triangles_ : nullptr, plan_);
    if (config_.fresh) return {};
    const OldNodes old(data_.path);
    std::vector<std::optional<Error>> failed(plan_.zones.size());
    parallel_for(plan_.zones.size(), config_.workers, [&](size_t z) {
      const NodePlanZone& zone = plan_.zones[z];
      auto kept = old.keep(zone.x, zone.z, zone.input);
      if (!kept) return;
      is_done_[z] = 1;
      slots_[z] = std::move(kept->slot);
      if (folder_ == nullptr || slots_[z] == nullptr) return;
      if (auto ok = folder_->take_over(*slots_[z]->zone, kept->file); !ok) failed[z] = ok.error();
      slots_[z]->zone.reset();
    });
    kept_ = std::accumulate(is_done_.begin(), is_done_.end(), uint64_t{0});
    return first_failure(failed);
  }

  Result<void> make_zones() {
    std::vector<uint32_t> left;
    for (uint32_t z = 0; z < is_done_.size(); ++z) {
      if (is_done_[z] == 0) left.push_back(z);
    }
    // Jumps are looked at even if nothing has to be made.
    const auto batches = node_batches(scene_, config_, plan_, std::move(left));
    uint64_t done = kept_;
    for (size_t b = 0; b < batches.size(); ++b) {
      if (context_.on_progress) context_.on_progress({"nodes", done, plan_.zones.size()});
      // What is there is told before what is left is begun.
      if (folder_ != nullptr) {
        if (auto ok = folder_->list(*gather()); !ok) return ok;
      }
      const NodeBatchInput input{.world = world_,
                                 .scene = scene_,
                                 .config = config_,
                                 .bins = bins_,
                                 .plan = plan_,
                                 .triangles = triangles_,
                                 .is_last = b + 1 == batches.size(),
                                 .context = context_};
      auto made = make_node_batch(input, batches[b]);
      if (!made) return made.error();
      if (auto ok = put(batches[b], *std::move(made)); !ok) return ok;
      done += batches[b].size();
    }
    return {};
  }

  Result<void> put(const std::vector<uint32_t>& zones, NodeSlots made) {
    std::vector<std::optional<Error>> failed(zones.size());
    parallel_for(zones.size(), config_.workers, [&](size_t i) {
      is_done_[zones[i]] = 1;
      slots_[zones[i]] = std::move(made[i]);
      const auto& slot = slots_[zones[i]];
      if (folder_ == nullptr || slot == nullptr) return;
      if (auto ok = folder_->write(*slot->zone); !ok) failed[i] = ok.error();
      slot->zone.reset();
    });
    return first_failure(failed);
  }

  // What is done so far. Where nodes stay in memory they are in it, and no longer here.
  [[nodiscard]] std::shared_ptr<NodeData> gather() {
    auto nodes = std::make_shared<NodeData>();
    nodes->world = world_;
    nodes->world_hash = world_hash(data_);
    nodes->size = config_.size;
    nodes->summary.bins = bins_;
    nodes->summary.bezier_patches = scene_.patches.size();
    uint64_t count = 0;
    for (size_t z = 0; z < slots_.size(); ++z) {
      if (is_done_[z] == 0) continue;
      if (!data_.path.empty()) {
        nodes->inputs.emplace_back(plan_.zones[z].x, plan_.zones[z].z, plan_.zones[z].input);
      }
      if (slots_[z] == nullptr) continue;
      auto slot = std::make_unique<NodeData::Slot>();
      slot->entry = slots_[z]->entry;
      slot->zone = std::move(slots_[z]->zone);
      slot->first_node = static_cast<uint32_t>(count);
      count = std::min<uint64_t>(count + slot->entry.nodes(), kFarNode);
      nodes->summary.bytes += slot->entry.bytes();
      nodes->summary.patches += slot->entry.patches();
      nodes->slots.push_back(std::move(slot));
    }
    nodes->node_count = static_cast<uint32_t>(count);
    nodes->summary.nodes = count;
    nodes->summary.zones = nodes->slots.size();
    return nodes;
  }

  const World& world_;
  const WorldData& data_;
  const Scene& scene_;
  const NodeConfig& config_;
  Context& context_;
  const NodeFolder* folder_;  // may be null
  NodeBins bins_;
  NodePlan plan_;
  std::optional<TriangleSquares> triangles_;
  std::vector<uint8_t> is_done_;  // by zone of the plan
  NodeSlots slots_;               // likewise
  uint64_t kept_ = 0;
};

}  // namespace

Result<void> check_node_config(const NodeConfig& config) {
  if (!(config.size >= 0.05 && config.size <= 100)) {
    return Error{Errc::kBadConfig, "nodes: the size must be 0.05 to 100 m"};
  }
  if (config.workers < 0) return Error{Errc::kBadConfig, "nodes: workers must be 0 or more"};
  for (size_t j = 0; j < config.jumps.size(); ++j) {
    const NodeJump& jump = config.jumps[j];
    const Vec3d sum = jump.from + jump.to;
    if (std::isfinite(sum.x + sum.y + sum.z)) continue;
    return Error{Errc::kBadConfig,
                 "nodes: jump " + std::to_string(j + 1) + ": its ends must be finite"};
  }
  return {};
}

Result<Nodes> Nodes::make(const World& world, const Scene& scene, const NodeConfig& config,
                          Context& context) {
  if (auto ok = check(world, scene, config); !ok) return ok.error();
  auto nodes = NodeBaker(world, scene, config, context, nullptr).run();
  if (!nodes) return nodes.error();
  return Nodes(*std::move(nodes));
}

Result<Nodes> Nodes::make_in_folder(const World& world, const Scene& scene,
                                    const NodeConfig& config, Context& context) {
  if (auto ok = check(world, scene, config); !ok) return ok.error();
  if (world.data()->path.empty()) {
    return Error{Errc::kBadInput, "nodes: the world is in no folder"};
  }
  auto folder = NodeFolder::begin(world.data()->path);
  if (!folder) return folder.error();
  const auto made = NodeBaker(world, scene, config, context, &*folder).run();
  if (!made) {
    if (made.error().code == Errc::kCancelled) folder->leave();
    return made.error();
  }
  if (auto ok = folder->finish(**made); !ok) return ok.error();
  (*made)->path = world.data()->path + "/" + kNodeFolder;
  return Nodes(*made);
}

Result<void> Nodes::write(const std::string& world_path, int32_t workers) const {
  THRONG_ASSERT(data_);
  const auto world = World::open(world_path);
  if (!world) return world.error();
  if (world->summary().hash != data_->world_hash) {
    return Error{Errc::kBadFile, world_path + ": holds another world than these nodes' own"};
  }
  auto folder = NodeFolder::begin(world_path);
  if (!folder) return folder.error();
  std::vector<std::optional<Error>> failed(data_->slots.size());
  parallel_for(failed.size(), workers, [&](size_t s) {
    const NodeZone* zone = data_->zone(s);
    if (zone == nullptr) {
      failed[s] = Error{Errc::kBadFile, data_->slots[s]->error};
    } else if (auto ok = folder->write(*zone); !ok) {
      failed[s] = ok.error();
    }
  });
  if (auto ok = first_failure(failed); !ok) return ok;
  return folder->finish(*data_);
}

}  // namespace throng
