// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "bake/folder/zone_baker.h"

#include <utility>

#include "core/stopwatch.h"

// Zones side by side, each into its file as soon as it is made.
namespace throng::bake {
namespace {

Error cancelled() { return {Errc::kCancelled, "bake: cancelled; nothing was written"}; }

}  // namespace

ZoneBaker::ZoneBaker(const WorldBake& bake, const BakeConfig& config, Context& context,
                     WorldFolder* folder)
    : bake_(bake),
      context_(context),
      folder_(folder),
      groups_(assign_workers(bake.zones().size(), config.workers)),
      scratch_(static_cast<size_t>(groups_.groups)),
      facts_(bake.zones().size()),
      zones_(folder == nullptr ? facts_.size() : 0) {}

Result<void> ZoneBaker::run() {
  const auto baked = side_by_side(
      facts_.size(), groups_, context_,
      [&](size_t i) {
        if (context_.on_progress) {
          context_.on_progress({"bake", bake_.place(i), bake_.place_count()});
        }
      },
      [&](size_t i, int32_t group) {
        auto& scratch = scratch_[static_cast<size_t>(group)];
        if (!scratch) scratch = std::make_unique<ZoneScratch>(groups_.workers);
        return bake(i, *scratch);
      });
  if (!baked) return baked.error();
  if (context_.cancel) return cancelled();
  return {};
}

std::vector<std::unique_ptr<world::Zone>> ZoneBaker::take_zones() {
  std::erase(zones_, nullptr);
  return std::move(zones_);
}

Result<void> ZoneBaker::bake(size_t i, ZoneScratch& scratch) {
  const format::ZoneInput& input = bake_.zones()[i];
  if (folder_ != nullptr) {
    if (const auto reused = folder_->reuse(input.x(), input.z(), input.hash())) {
      facts_[i] = bake_.facts_of(*reused);
      return {};
    }
  }
  flatbuffers::DetachedBuffer bytes;
  if (!bake_.bake(i, scratch, context_, facts_[i], bytes)) return cancelled();
  const auto start = Clock::now();
  if (auto ok = put(i, std::move(bytes)); !ok) return ok;
  facts_[i].seconds_write = seconds_since(start);
  return {};
}

Result<void> ZoneBaker::put(size_t i, flatbuffers::DetachedBuffer bytes) {
  const format::ZoneEntry& entry = facts_[i].entry;
  if (folder_ != nullptr) {
    if (auto ok = WorldFolder::write_zone(folder_->path(), entry, {bytes.data(), bytes.size()});
        !ok) {
      return ok;
    }
    const std::lock_guard lock(mutex_);
    return folder_->add(entry, bake_.zones()[i].hash());
  }
  if (entry.levels() == 0) return {};
  auto zone =
      world::Zone::from_bytes(std::move(bytes), world::zone_file_name(entry.x(), entry.z()));
  if (!zone) return zone.error();
  zones_[i] = std::move(*zone);
  return {};
}

}  // namespace throng::bake
