// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "import/formats/zonel.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <tuple>
#include <type_traits>

// Format: derived from 96 real zones (zone version 3, patch version 4), of which every byte is
// accounted for; what later versions add is skipped. Little-endian. A version is one byte, or 255
// and 32 bits; a list is a 32-bit count and its elements. Source of the format: the NeL library,
// which [PACS00] became part of.
namespace throng::importer {
namespace {

static_assert(std::endian::native == std::endian::little,
              "the reader copies little-endian numbers");

// In the file: the vertices A B C D, then ab ba bc cb cd dc da ad, then ia ib ic id. Ours by rows
// of t: (A ad da D) (ab ia id dc) (ba ib ic cd) (B bc cb C).
constexpr std::array<size_t, 16> kFromFile{0, 11, 10, 3, 4, 12, 15, 9, 5, 13, 14, 8, 1, 6, 7, 2};

class ZoneReader {
 public:
  ZoneReader(std::string_view bytes, const ReadOptions& options, Context& context)
      : bytes_(bytes), options_(options), context_(context), writer_(options) {}

  Result<RawScene> read() {
    if (!read_head() || !read_border() || !read_patches() || !read_binds() || !check_end()) {
      if (context_.cancel) return Error{Errc::kCancelled, "cancelled while reading"};
      return Error{Errc::kBadFile, fmt::format("{}: {}", options_.name, message_)};
    }
    auto scene = writer_.finish();
    if (!scene) return scene.error();
    return RawScene{
        .scene = *std::move(scene), .up = 'z', .metres_per_unit = 1, .zone = std::move(zone_)};
  }

 private:
  bool fail(std::string why) {
    message_ = std::move(why);
    return false;
  }
  bool truncated(const std::string& where) {
    return fail(fmt::format("ends in {} (byte {}); the file is truncated or damaged, get it again",
                            where, bytes_.size()));
  }

  template <class T>
  bool take(T& value) {
    static_assert(std::is_trivially_copyable_v<T>);
    if (bytes_.size() - at_ < sizeof value) return false;
    std::memcpy(&value, bytes_.data() + at_, sizeof value);
    at_ += sizeof value;
    return true;
  }
  bool skip(uint64_t size) {
    if (bytes_.size() - at_ < size) return false;
    at_ += size;
    return true;
  }
  bool take_version(uint32_t& version) {
    uint8_t small = 0;
    if (!take(small)) return false;
    version = small;
    return small != 255 || take(version);
  }
  // A count whose elements, of at least `size` bytes each, can still be in the file.
  bool take_count(size_t size, uint32_t& count) {
    int32_t number = 0;
    if (!take(number) || number < 0) return false;
    count = static_cast<uint32_t>(number);
    return uint64_t{count} * size <= bytes_.size() - at_;
  }
  bool skip_list(size_t size) {
    uint32_t count = 0;
    return take_count(size, count) && skip(uint64_t{count} * size);
  }

  bool read_head() {
    uint32_t box_version = 0;
    char magic[4];
    if (!take_version(version_) || !take(magic)) return truncated("its head");
    if (std::string_view(magic, 4) != "ZONE") {
      return fail("not a landscape zone: ZONE is missing from its head");
    }
    if (version_ < 3 || version_ > 5) {
      return fail(fmt::format("zone of version {}; 3 to 5 are read", version_));
    }
    int32_t vertices = 0;
    if (!take(zone_.id) || !take_version(box_version) || !skip(24) || !take(bias_) ||
        !take(scale_) || !take(vertices)) {
      return truncated("its head");
    }
    for (const float number : {bias_[0], bias_[1], bias_[2], scale_}) {
      if (!(std::fabs(number) < 1e9f)) return fail("its scale or bias is not a usable number");
    }
    zone_.file = options_.name;
    return true;
  }

  bool read_border() {
    uint32_t count = 0;
    if (!take_count(7, count)) return truncated("the border vertices");
    zone_.border.reserve(count);
    for (uint32_t i = 0; i < count; ++i) {
      uint32_t version = 0;
      ZoneCorner corner;
      if (!take_version(version) || !take(corner.corner) || !take(corner.other_zone) ||
          !take(corner.other_corner)) {
        return truncated(fmt::format("border vertex {} of {}", i, count));
      }
      zone_.border.push_back(corner);
    }
    return true;
  }

  bool read_patches() {
    if (!take_count(96, patches_)) return truncated("the patches");
    if (patches_ == 0) return fail("has no patches");
    writer_.scene().patches.begin_run(options_.name, zone_name(zone_.id), "");
    for (uint32_t p = 0; p < patches_; ++p) {
      if (context_.cancel) return false;
      if (!read_patch(p)) return false;
    }
    return true;
  }

  bool read_patch(uint32_t p) {
    const std::string where = fmt::format("patch {} of {}", p, patches_);
    uint32_t version = 0;
    int16_t packed[16][3];
    if (!take_version(version)) return truncated(where);
    if (version < 2 || version > 7) {
      return fail(fmt::format("{} (byte {}) has version {}; 2 to 7 are read", where, at_, version));
    }
    if (!take(packed)) return truncated(where);
    BezierPatch patch;
    for (size_t i = 0; i < 16; ++i) {
      const int16_t* from = packed[kFromFile[i]];
      const auto place = [&](size_t axis) {
        return static_cast<double>(from[axis]) * static_cast<double>(scale_) +
               static_cast<double>(bias_[axis]);
      };
      patch.points[i] = {place(0), place(1), place(2)};
    }
    // Tiles, colours, orders and light: of no use here, but they must be there.
    const bool whole = skip_list(8) && skip_list(version <= 6 ? 5 : 2) && skip(2) && skip_list(1) &&
                       (version < 3 || skip(2)) && (version < 4 || skip(1)) &&
                       (version < 5 || skip_list(3));
    if (!whole) return truncated(where);
    writer_.scene().patches.add(patch);
    return true;
  }

  bool read_binds() {
    uint32_t count = 0;
    if (!take_count(13, count)) return truncated("the neighbours");
    if (count != patches_) {
      return fail(fmt::format("has neighbours for {} patches but {} patches; it is damaged", count,
                              patches_));
    }
    for (uint32_t p = 0; p < count; ++p) {
      const std::string where = fmt::format("the neighbours of patch {} of {}", p, count);
      uint32_t version = 0;
      std::array<uint16_t, 4> corners{};
      if (!take_version(version)) return truncated(where);
      if (version > 1) {
        return fail(
            fmt::format("{} (byte {}) have version {}; 0 and 1 are read", where, at_, version));
      }
      if (!skip(version == 0 ? 6 : 4) || !take(corners)) return truncated(where);
      zone_.corners.push_back(corners);
      for (uint32_t e = 0; e < 4; ++e) {
        if (!read_bind({p, e}, where)) return false;
      }
    }
    return true;
  }

  bool read_bind(PatchSide side, const std::string& where) {
    uint32_t version = 0;
    uint8_t kind = 0;
    uint16_t zone = 0;
    uint16_t next[4];
    uint8_t edge[4];
    if (!take_version(version) || !take(kind) || !take(zone) || !take(next) || !take(edge)) {
      return truncated(where);
    }
    if (kind == 0) return true;
    if (kind == 3 || kind > 5) {
      return fail(fmt::format("edge {} in {} is of kind {}; kinds are 0, 1, 2, 4 and 5", side.edge,
                              where, kind));
    }
    ZoneBind bind{.side = side, .bind = static_cast<EdgeBind>(kind), .other_zone = zone};
    const uint32_t used = kind == 5 ? 1 : kind;
    for (uint32_t k = 0; k < used; ++k) {
      if (edge[k] > 3) {
        return fail(fmt::format("edge {} in {} meets edge {} of patch {}; edges are 0 to 3",
                                side.edge, where, edge[k], next[k]));
      }
      if (zone == zone_.id && next[k] >= patches_) {
        return fail(fmt::format("edge {} in {} meets patch {}, and there are only {}", side.edge,
                                where, next[k], patches_));
      }
      bind.next[k] = {next[k], edge[k]};
    }
    if (zone == zone_.id) {
      writer_.scene().patches.edges[side.patch][side.edge] = {bind.bind, bind.next};
    } else {
      zone_.far.push_back(bind);
    }
    return true;
  }

  // From version 4 on lights follow, which we do not read.
  bool check_end() {
    if (version_ >= 4 || at_ == bytes_.size()) return true;
    return fail(
        fmt::format("{} bytes follow the last patch; the file is damaged", bytes_.size() - at_));
  }

  std::string_view bytes_;
  const ReadOptions& options_;
  Context& context_;
  SceneWriter writer_;
  PatchZone zone_;
  std::string message_;
  size_t at_ = 0;
  uint32_t version_ = 0;
  uint32_t patches_ = 0;
  float bias_[3] = {};
  float scale_ = 1;
};

auto as_tuple(const ZoneCorner& c) { return std::tuple(c.corner, c.other_zone, c.other_corner); }
bool before(const ZoneCorner& a, const ZoneCorner& b) { return as_tuple(a) < as_tuple(b); }

// Do both tables of border vertices pair the corners of two whole edges? Corners of halves and
// quarters lie within an edge and are in no table.
bool corners_are_paired(const PatchZone& mine, PatchSide side, const PatchZone& other,
                        PatchSide next) {
  const auto& a = mine.corners[side.patch];
  const auto& b = other.corners[next.patch];
  for (uint32_t end = 0; end < 2; ++end) {
    const ZoneCorner pair{.corner = a[(side.edge + end) % 4],
                          .other_zone = other.id,
                          .other_corner = b[(next.edge + 1 - end) % 4]};
    if (!std::binary_search(mine.border.begin(), mine.border.end(), pair, before)) return false;
  }
  return true;
}

}  // namespace

std::string zone_name(uint16_t id) {
  const int column = id & 255;
  const int row = (id >> 8) + 1;
  if (column >= 26 * 26) return std::to_string(id);
  return fmt::format("{}_{}{}", row, static_cast<char>('A' + column / 26),
                     static_cast<char>('A' + column % 26));
}

Result<RawScene> read_zonel(std::string_view bytes, const ReadOptions& options, Context& context) {
  return ZoneReader(bytes, options, context).read();
}

Result<void> join_zones(PatchSet& set, std::span<PatchZone> zones, SceneReport& report) {
  std::vector<PatchZone*> by_id;
  for (PatchZone& zone : zones) {
    std::sort(zone.border.begin(), zone.border.end(), before);
    by_id.push_back(&zone);
  }
  std::stable_sort(by_id.begin(), by_id.end(),
                   [](const PatchZone* a, const PatchZone* b) { return a->id < b->id; });
  for (size_t i = 1; i < by_id.size(); ++i) {
    if (by_id[i]->id != by_id[i - 1]->id) continue;
    return Error{Errc::kBadInput,
                 fmt::format("{}: zone {} was already read from {}; name it once", by_id[i]->file,
                             zone_name(by_id[i]->id), by_id[i - 1]->file)};
  }
  const auto find = [&](uint16_t id) -> const PatchZone* {
    const auto found =
        std::lower_bound(by_id.begin(), by_id.end(), id,
                         [](const PatchZone* zone, uint16_t wanted) { return zone->id < wanted; });
    return found != by_id.end() && (*found)->id == id ? *found : nullptr;
  };

  uint64_t left_open = 0;
  for (const PatchZone& zone : zones) {
    for (const ZoneBind& bind : zone.far) {
      const PatchZone* other = find(bind.other_zone);
      if (other == nullptr) {
        ++left_open;
        continue;
      }
      const auto refuse = [&](const std::string& what) {
        return Error{Errc::kBadInput,
                     fmt::format("{}: patch {}, edge {}: {}; both files must come from one world",
                                 zone.file, bind.side.patch, bind.side.edge, what)};
      };
      PatchEdge edge{bind.bind, {}};
      for (size_t k = 0; k < bind.next.size() && bind.next[k] != PatchSide{}; ++k) {
        const PatchSide next = bind.next[k];
        if (next.patch >= other->corners.size()) {
          return refuse(fmt::format("meets patch {} of zone {}, which has only {}", next.patch,
                                    zone_name(other->id), other->corners.size()));
        }
        if (bind.bind == EdgeBind::kOne && !corners_are_paired(zone, bind.side, *other, next)) {
          return refuse(
              fmt::format("meets zone {} at vertices that its border vertices do not pair",
                          zone_name(other->id)));
        }
        edge.next[k] = {other->first_patch + next.patch, next.edge};
      }
      set.edges[zone.first_patch + bind.side.patch][bind.side.edge] = edge;
    }
  }
  if (left_open > 0) {
    report.warnings.push_back(fmt::format(
        "{} of {} zones: {} edges lead to zones that are not among the files and stay open",
        zones.front().file, zones.size(), left_open));
  }
  return {};
}

}  // namespace throng::importer
