// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "bake/surface/node_bake.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numeric>
#include <utility>

#include "bake/surface/leaf_link_bake.h"
#include "bake/surface/node_file.h"
#include "core/access.h"
#include "core/hash.h"
#include "core/parallel.h"
#include "graph/node_bins.h"
#include "throng/scene.h"

// Makes nodes zone by zone in batches, reuses those whose input is unchanged, and collects what the
// index needs of them.
namespace throng {
namespace {

using Clock = std::chrono::steady_clock;

// Of calls that ran side by side.
Result<void> first_failure(std::span<const std::optional<Error>> failed) {
  for (const auto& failure : failed) {
    if (failure) return *failure;
  }
  return {};
}

}  // namespace

bake::NodeBaker::NodeBaker(const World& world, NodeScene scene, const NodeConfig& config,
                           const bake::NodeFolder* folder)
    : world_(world),
      data_(*data_of(world)),
      scene_(std::move(scene)),
      config_(config),
      folder_(folder),
      bins_(graph::make_bins(data_.summary.classes)) {}

Result<void> bake::NodeBaker::check(const World& world, const NodeScene& scene,
                                    const NodeConfig& config) {
  if (data_of(world) == nullptr) return Error{Errc::kBadInput, "nodes: the world is empty"};
  if (auto ok = check_node_config(config); !ok) return ok.error();
  if (scene.triangles() != world.summary().source_triangles) {
    return Error{Errc::kBadInput, "nodes: the world was not baked from this scene: it has " +
                                      std::to_string(world.summary().source_triangles) +
                                      " source triangles, the scene has " +
                                      std::to_string(scene.triangles())};
  }
  return {};
}

Result<void> bake::NodeBaker::check_off_mesh_links(const World& world, const NodeScene& scene,
                                                   const NodeConfig& config, Context& context) {
  bake::NodeBaker baker(world, scene, config, nullptr);
  auto plan = bake::plan_nodes(baker.data_, scene, config, context);
  if (!plan) return plan.error();
  baker.plan_ = *std::move(plan);
  std::vector<uint32_t> linked;
  for (uint32_t z = 0; z < baker.plan_.zones.size(); ++z) {
    if (!baker.plan_.zones[z].off_mesh_links.empty()) linked.push_back(z);
  }
  // A whole scene is there anyway.
  const uint64_t bytes = scene.is_whole() ? UINT64_MAX : config.working_bytes;
  for (const auto& zones : bake::node_batches(baker.plan_, scene, std::move(linked), bytes)) {
    const auto region = baker.region_of(zones, context);
    if (!region) return region.error();
    const auto input = baker.batch_input(**region, true, context);
    if (auto ok = bake::check_batch_links(input, zones); !ok) return ok;
  }
  return {};
}

// A world in memory does not know what it was made from.
Result<void> bake::NodeBaker::plan(Context& context) {
  auto plan = bake::plan_nodes(data_, scene_, config_, context);
  if (!plan) return plan.error();
  plan_ = *std::move(plan);
  is_done_.assign(plan_.zones.size(), 0);
  slots_.resize(plan_.zones.size());
  if (data_.path.empty()) return {};
  return bake::find_node_inputs(data_, scene_, config_, context, plan_);
}

uint64_t bake::NodeBaker::input() const {
  std::vector<uint64_t> inputs;
  for (const bake::NodePlanZone& zone : plan_.zones) inputs.push_back(zone.input);
  return hash_span<uint64_t>(inputs);
}

Result<void> bake::NodeBaker::reuse_zones() {
  if (data_.path.empty() || config_.rebuild) return {};
  const bake::OldNodes old(data_.path);
  std::vector<std::optional<Error>> failed(plan_.zones.size());
  parallel_for(plan_.zones.size(), config_.workers, [&](size_t z) {
    const bake::NodePlanZone& zone = plan_.zones[z];
    auto reused = old.reuse(zone.x, zone.z, zone.input);
    if (!reused) return;
    is_done_[z] = 1;
    slots_[z] = std::move(reused->slot);
    if (folder_ == nullptr || slots_[z] == nullptr) return;
    if (auto ok = folder_->take_over(*slots_[z]->zone, reused->file); !ok) failed[z] = ok.error();
    slots_[z]->zone.reset();
  });
  reused_ = zones_done();
  return first_failure(failed);
}

uint64_t bake::NodeBaker::zones_done() const {
  return std::accumulate(is_done_.begin(), is_done_.end(), uint64_t{0});
}

std::vector<std::vector<uint32_t>> bake::NodeBaker::batches(uint64_t max_bytes) const {
  std::vector<uint32_t> left;
  for (uint32_t z = 0; z < is_done_.size(); ++z) {
    if (is_done_[z] == 0) left.push_back(z);
  }
  return bake::node_batches(plan_, scene_, std::move(left), max_bytes);
}

Result<std::shared_ptr<bake::NodeRegion>> bake::NodeBaker::region_of(
    std::span<const uint32_t> zones, Context& context) const {
  if (!plan_.needs_triangles()) return scene_.region({}, context);
  return scene_.region(bake::box_around(plan_, bake::with_near_zones(plan_, zones)), context);
}

bake::NodeBatchInput bake::NodeBaker::batch_input(NodeRegion& region, bool is_last,
                                                  Context& context) const {
  return {.world = world_,
          .region = region,
          .config = config_,
          .bins = bins_,
          .plan = plan_,
          .store = cells_.get(),
          .is_last = is_last,
          .context = context};
}

// A region is made for its batch alone.
Result<bake::NodeSlots> bake::NodeBaker::make_nodes(std::span<const uint32_t> zones, bool is_last,
                                                    Context& context) {
  const auto region = region_of(zones, context);
  if (!region) return region.error();
  auto made =
      bake::make_node_batch(batch_input(**region, is_last || !scene_.is_whole(), context), zones);
  if (made) drop_cells(zones);
  return made;
}

void bake::NodeBaker::keep_cells(std::span<const std::vector<uint32_t>> batches) {
  if (folder_ == nullptr || batches.size() < 2 || !plan_.has_patches) return;
  auto made = bake::CellStore::create(folder_->part());
  if (!made) return;  // They are judged as often as they are needed.
  cells_ = *std::move(made);
  batches_near_.assign(plan_.zones.size(), 0);
  for (const std::vector<uint32_t>& batch : batches) {
    for (const uint32_t zone : bake::with_near_zones(plan_, batch)) ++batches_near_[zone];
  }
}

// Of zones that no further batch is near.
void bake::NodeBaker::drop_cells(std::span<const uint32_t> zones) {
  if (cells_ == nullptr) return;
  for (const uint32_t z : bake::with_near_zones(plan_, zones)) {
    if (--batches_near_[z] > 0) continue;
    for (uint32_t s = plan_.zones[z].first; s < plan_.zones[z].last; ++s) {
      const bake::PatchSource& source = plan_.sources[s];
      if (source.kind == PatchKind::kBezier) cells_->drop(source.source);
    }
  }
}

Result<std::vector<bake::NodeBaker::Made>> bake::NodeBaker::write(std::span<const uint32_t> zones,
                                                                  bake::NodeSlots& made) const {
  std::vector<Made> made_entries(zones.size());
  std::vector<std::optional<Error>> failed(zones.size());
  parallel_for(zones.size(), config_.workers, [&](size_t i) {
    made_entries[i].zone = zones[i];
    if (made[i] == nullptr) return;
    made_entries[i].has_nodes = 1;
    made_entries[i].entry = made[i]->entry;
    if (folder_ == nullptr) return;
    if (auto ok = folder_->write(*made[i]->zone); !ok) failed[i] = ok.error();
    made[i]->zone.reset();
  });
  if (auto ok = first_failure(failed); !ok) return ok.error();
  return made_entries;
}

void bake::NodeBaker::enter(std::span<const Made> made, bake::NodeSlots* slots) {
  for (size_t i = 0; i < made.size(); ++i) {
    is_done_[made[i].zone] = 1;
    if (made[i].has_nodes == 0) continue;
    auto& slot = slots_[made[i].zone];
    slot = slots != nullptr ? std::move((*slots)[i]) : std::make_unique<graph::NodeData::Slot>();
    slot->entry = made[i].entry;
  }
}

Result<void> bake::NodeBaker::list() {
  return folder_ != nullptr ? folder_->list(*gather()) : Result<void>();
}

Result<std::shared_ptr<graph::NodeData>> bake::NodeBaker::finish() {
  auto nodes = gather();
  if (nodes->node_count >= graph::kFarNode) return bake::too_many_nodes();
  nodes->summary.zones_reused = reused_;
  nodes->summary.zones_made = plan_.zones.size() - reused_;
  return nodes;
}

// What is done so far. Where nodes stay in memory they are in it, and no longer here.
std::shared_ptr<graph::NodeData> bake::NodeBaker::gather() {
  auto nodes = std::make_shared<graph::NodeData>();
  nodes->world = world_;
  nodes->world_hash = bake::world_hash(data_);
  nodes->size = config_.size;
  nodes->summary.bins = bins_;
  nodes->summary.bezier_patches = scene_.patches();
  uint64_t count = 0;
  for (size_t z = 0; z < slots_.size(); ++z) {
    if (is_done_[z] == 0) continue;
    if (!data_.path.empty()) {
      nodes->inputs.emplace_back(plan_.zones[z].x, plan_.zones[z].z, plan_.zones[z].input);
    }
    if (slots_[z] == nullptr) continue;
    auto slot = std::make_unique<graph::NodeData::Slot>();
    slot->entry = slots_[z]->entry;
    slot->zone = std::move(slots_[z]->zone);
    slot->first_node = static_cast<uint32_t>(count);
    count = std::min<uint64_t>(count + slot->entry.nodes(), graph::kFarNode);
    nodes->summary.bytes += slot->entry.bytes();
    nodes->summary.patches += slot->entry.patches();
    nodes->slots.push_back(std::move(slot));
  }
  nodes->node_count = static_cast<uint32_t>(count);
  nodes->summary.nodes = count;
  nodes->summary.zones = nodes->slots.size();
  return nodes;
}

namespace {

// By this process alone.
Result<std::shared_ptr<graph::NodeData>> make_all(const World& world, const bake::NodeScene& scene,
                                                  const NodeConfig& config, Context& context,
                                                  const bake::NodeFolder* folder) {
  const auto start = Clock::now();
  bake::NodeBaker baker(world, scene, config, folder);
  if (auto ok = baker.plan(context); !ok) return ok.error();
  if (auto ok = baker.reuse_zones(); !ok) return ok.error();
  // Off-mesh links are checked even if nothing has to be made.
  const auto batches = baker.batches(config.working_bytes);
  baker.keep_cells(batches);
  for (size_t b = 0; b < batches.size(); ++b) {
    if (context.on_progress) context.on_progress({"nodes", baker.zones_done(), baker.zones()});
    // The journal names what is there before the rest is begun.
    if (auto ok = baker.list(); !ok) return ok.error();
    auto slots = baker.make_nodes(batches[b], b + 1 == batches.size(), context);
    if (!slots) return slots.error();
    const auto made = baker.write(batches[b], *slots);
    if (!made) return made.error();
    baker.enter(*made, &*slots);
  }
  auto nodes = baker.finish();
  if (!nodes) return nodes.error();
  (*nodes)->summary.seconds = std::chrono::duration<double>(Clock::now() - start).count();
  return nodes;
}

}  // namespace

Result<void> check_node_config(const NodeConfig& config) {
  if (!(config.size >= 0.05 && config.size <= 100)) {
    return Error{Errc::kBadConfig, "nodes: the size must be 0.05 to 100 m"};
  }
  if (config.workers < 0) return Error{Errc::kBadConfig, "nodes: workers must be 0 or more"};
  for (size_t j = 0; j < config.off_mesh_links.size(); ++j) {
    const NodeOffMeshLink& off_mesh_link = config.off_mesh_links[j];
    const Vec3d sum = off_mesh_link.from + off_mesh_link.to;
    if (std::isfinite(sum.x + sum.y + sum.z)) continue;
    return Error{Errc::kBadConfig,
                 "nodes: off-mesh link " + std::to_string(j + 1) + ": its ends must be finite"};
  }
  return {};
}

Result<Nodes> Nodes::create(const World& world, const Scene& scene, const NodeConfig& config,
                            Context& context) {
  if (auto ok = bake::NodeBaker::check(world, scene, config); !ok) return ok.error();
  auto nodes = make_all(world, scene, config, context, nullptr);
  if (!nodes) return nodes.error();
  return Nodes(*std::move(nodes));
}

namespace {

Result<std::shared_ptr<graph::NodeData>> make_in_folder(const World& world,
                                                        const bake::NodeScene& scene,
                                                        const NodeConfig& config,
                                                        Context& context) {
  if (auto ok = bake::NodeBaker::check(world, scene, config); !ok) return ok.error();
  if (data_of(world)->path.empty()) {
    return Error{Errc::kBadInput, "nodes: the world is in no folder"};
  }
  const auto start = Clock::now();
  auto folder = bake::NodeFolder::begin(data_of(world)->path);
  if (!folder) return folder.error();
  const auto made = make_all(world, scene, config, context, &*folder);
  if (!made) {
    if (made.error().code == Errc::kCancelled) folder->leave();
    return made.error();
  }
  if (auto ok = bake::link_to_air(world, **made, config, *folder, context); !ok) {
    if (ok.error().code == Errc::kCancelled) folder->leave();
    return ok.error();
  }
  if (auto ok = folder->finish(**made); !ok) return ok.error();
  (*made)->summary.seconds = std::chrono::duration<double>(Clock::now() - start).count();
  (*made)->path = data_of(world)->path + "/" + graph::kNodeFolder;
  return *made;
}

}  // namespace

Result<Nodes> Nodes::create_in_folder(const World& world, const Scene& scene,
                                      const NodeConfig& config, Context& context) {
  auto made = make_in_folder(world, scene, config, context);
  if (!made) return made.error();
  return Nodes(*std::move(made));
}

Result<Nodes> Nodes::create_in_folder(const World& world, const SceneRegions& scene,
                                      const NodeConfig& config, Context& context) {
  auto made = make_in_folder(world, scene, config, context);
  if (!made) return made.error();
  return Nodes(*std::move(made));
}

Result<void> Nodes::write(const std::string& world_path, int32_t workers) const {
  THRONG_ASSERT(state_);
  if (workers < 0) return Error{Errc::kBadConfig, "nodes: workers must be 0 or more"};
  const auto world = World::open(world_path);
  if (!world) return world.error();
  if (world->summary().hash != state_->world_hash) {
    return Error{Errc::kBadFile, world_path + ": holds another world than these nodes' own"};
  }
  auto folder = bake::NodeFolder::begin(world_path);
  if (!folder) return folder.error();
  std::vector<std::optional<Error>> failed(state_->slots.size());
  parallel_for(failed.size(), workers, [&](size_t s) {
    const graph::NodeZone* zone = state_->zone(s);
    if (zone == nullptr) {
      failed[s] = Error{Errc::kBadFile, state_->slots[s]->error};
    } else if (auto ok = folder->write(*zone); !ok) {
      failed[s] = ok.error();
    }
  });
  if (auto ok = first_failure(failed); !ok) return ok;
  Context context;
  const NodeConfig config{.workers = workers, .rebuild = true};
  if (auto ok = bake::link_to_air(*world, *state_, config, *folder, context); !ok) return ok;
  return folder->finish(*state_);
}

}  // namespace throng
