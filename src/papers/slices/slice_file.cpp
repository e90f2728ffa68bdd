// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "papers/slices/slice_file.h"

#include <flatbuffers/flatbuffers.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <fstream>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/files/file_map.h"
#include "core/hash.h"
#include "papers/slices/slices_generated.h"

// Reads and writes files of slices (FlatBuffers) and checks every number that is used as an index.
namespace throng {
namespace {

constexpr const char* kIdentifier = "THSL";
constexpr uint32_t kVersion = 1;
constexpr uint64_t kMaxBytes = (uint64_t{1} << 31) - (1 << 20);  // FlatBuffers' own limit
constexpr int32_t kMaxSide = 1 << 27;                            // [cells]

// Slices may share their bytes in a forged file: do they take no more than it has?
bool fits(const format::SlicesFile& file, uint64_t file_bytes) {
  uint64_t bytes = 0;
  for (const format::SliceDepths* slice : *file.slices()) {
    bytes += uint64_t{slice->depths()->size()} * sizeof(uint16_t);
    if (bytes > file_bytes) return false;
  }
  return true;
}

// FlatBuffers are written from back to front: the first depths, padded to four bytes, end a file.
bool ends_with_depths(const format::SlicesFile& file, std::span<const uint8_t> bytes) {
  const uint8_t* end = bytes.data();
  for (const format::SliceDepths* slice : *file.slices()) {
    const auto& depths = *slice->depths();
    end = std::max(end, depths.Data() + size_t{depths.size()} * sizeof(uint16_t));
  }
  const auto used = static_cast<size_t>(end - bytes.data());
  return (used + 3) / 4 * 4 == bytes.size();
}

Error bad(const std::string& path, const std::string& what) {
  return {Errc::kBadFile, path + ": " + what + "; make it again with throng slices"};
}

}  // namespace

namespace papers {

uint64_t sum_of(const DepthSlices& set) {
  const std::array<uint64_t, 10> words = {
      static_cast<uint64_t>(set.width),         static_cast<uint64_t>(set.depth),
      std::bit_cast<uint64_t>(set.cell),        std::bit_cast<uint64_t>(set.origin_x),
      std::bit_cast<uint64_t>(set.origin_z),    static_cast<uint64_t>(set.far_plane),
      static_cast<uint64_t>(set.avatar_height), static_cast<uint64_t>(set.resolution),
      static_cast<uint64_t>(set.taken),         static_cast<uint64_t>(set.extra)};
  uint64_t sum = hash_span(std::span<const uint64_t>(words));
  for (const DepthSlice& slice : set.slices) {
    sum = hash_bytes(&slice.height, sizeof(slice.height), sum);
    sum = hash_span(std::span<const uint16_t>(slice.depths), sum);
  }
  return sum;
}

bool is_sound(const DepthSlices& set) {
  const bool grid = set.width >= 1 && set.width <= kMaxSide && set.depth >= 1 &&
                    set.depth <= kMaxSide && set.cell >= SliceConfig::kMinCell &&
                    set.cell <= SliceConfig::kMaxCell && std::isfinite(set.origin_x) &&
                    std::isfinite(set.origin_z);
  if (!grid || set.avatar_height < 1 || set.resolution < 1 || set.taken < 0 || set.slices.empty() ||
      set.extra < 0 || static_cast<size_t>(set.extra) >= set.slices.size()) {
    return false;
  }
  const uint64_t cells = uint64_t(set.width) * uint64_t(set.depth);
  for (size_t i = 0; i < set.slices.size(); ++i) {
    if (set.slices[i].depths.size() != cells) return false;
    if (i > 0 && set.slices[i].height >= set.slices[i - 1].height) return false;
    // Surfaces must not overflow.
    if (set.slices[i].height < INT32_MIN / 2 || set.slices[i].height > INT32_MAX / 2) return false;
  }
  return true;
}

Result<StoredSlices> decode_slices(std::span<const uint8_t> bytes, const std::string& name) {
  flatbuffers::Verifier verifier(bytes.data(), bytes.size());
  if (bytes.size() < 8 || !flatbuffers::BufferHasIdentifier(bytes.data(), kIdentifier) ||
      !verifier.VerifyBuffer<format::SlicesFile>(kIdentifier)) {
    return bad(name, "not a file of slices, or truncated");
  }
  const format::SlicesFile& file = *flatbuffers::GetRoot<format::SlicesFile>(bytes.data());
  if (file.version() != kVersion) {
    return bad(
        name, fmt::format("slices of version {}, this program reads {}", file.version(), kVersion));
  }
  if (!fits(file, bytes.size())) return bad(name, "its numbers make no sense");
  if (!ends_with_depths(file, bytes)) return bad(name, "has bytes after its end");
  StoredSlices stored{.slices = {.width = file.width(),
                                 .depth = file.depth(),
                                 .cell = file.cell(),
                                 .origin_x = file.origin_x(),
                                 .origin_z = file.origin_z(),
                                 .far_plane = file.far_plane(),
                                 .avatar_height = file.avatar_height(),
                                 .resolution = file.resolution(),
                                 .taken = file.taken(),
                                 .extra = file.extra(),
                                 .slices = {}},
                      .sum = file.sum()};
  for (const format::SliceDepths* slice : *file.slices()) {
    stored.slices.slices.push_back(
        {.height = slice->height(), .depths = {slice->depths()->begin(), slice->depths()->end()}});
  }
  return stored;
}

}  // namespace papers

Result<void> save_slices(const DepthSlices& set, const std::string& path) {
  THRONG_ASSERT(papers::is_sound(set));
  if (set.bytes() > kMaxBytes) {
    return Error{
        Errc::kLimit,
        fmt::format("{}: {} slices of {} x {} cells take {:.1f} GB, a file of slices holds "
                    "2 GB; use larger cells",
                    path, set.slices.size(), set.width, set.depth,
                    static_cast<double>(set.bytes()) / 1e9)};
  }
  flatbuffers::FlatBufferBuilder builder(set.bytes() + (1 << 16));
  std::vector<flatbuffers::Offset<format::SliceDepths>> slices;
  for (const DepthSlice& slice : set.slices) {
    slices.push_back(
        format::CreateSliceDepths(builder, slice.height, builder.CreateVector(slice.depths)));
  }
  const auto slices_at = builder.CreateVector(slices);
  builder.Finish(
      format::CreateSlicesFile(builder, kVersion, papers::sum_of(set), set.width, set.depth,
                               set.cell, set.origin_x, set.origin_z, set.far_plane,
                               set.avatar_height, set.resolution, set.taken, set.extra, slices_at),
      kIdentifier);
  return write_file(path, {builder.GetBufferPointer(), builder.GetSize()});
}

bool is_slice_file(const std::string& path) {
  std::array<char, 8> head{};
  std::ifstream file(path, std::ios::binary);
  return file.read(head.data(), head.size()) && std::string(head.data() + 4, 4) == kIdentifier;
}

Result<DepthSlices> load_slices(const std::string& path) {
  const Result<FileMap> map = FileMap::open(path);
  if (!map) return map.error();
  Result<papers::StoredSlices> stored = papers::decode_slices(map->bytes(), path);
  if (!stored) return stored.error();
  if (stored->sum != papers::sum_of(stored->slices)) {
    return bad(path, "its checksum is wrong (damaged)");
  }
  if (!papers::is_sound(stored->slices)) return bad(path, "its numbers make no sense");
  return std::move(stored->slices);
}

}  // namespace throng
