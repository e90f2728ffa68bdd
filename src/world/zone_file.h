// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <flatbuffers/flatbuffers.h>

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <utility>

#include "core/file_map.h"
#include "core/hash.h"
#include "throng/result.h"

/// What the files of a world's zones share: the ground's, the air's, the nodes'.
namespace throng {

/// A zone's bytes, mapped or owned, and whatever `Zone` finds in them: it has a private
///   Result<void> attach(const std::string& name)
/// that fails with kBadFile unless bytes() are sound, and lets this class call it.
template <class Zone>
class ZoneFile {
 public:
  static Result<std::unique_ptr<Zone>> from_bytes(flatbuffers::DetachedBuffer bytes,
                                                  const std::string& name) {
    auto zone = std::make_unique<Zone>();
    ZoneFile& file = *zone;
    file.owned_ = std::move(bytes);
    file.bytes_ = {file.owned_.data(), file.owned_.size()};
    return attached(std::move(zone), name);
  }
  static Result<std::unique_ptr<Zone>> from_file(FileMap map, const std::string& name) {
    auto zone = std::make_unique<Zone>();
    ZoneFile& file = *zone;
    file.map_ = std::move(map);
    file.bytes_ = file.map_.bytes();
    return attached(std::move(zone), name);
  }

  [[nodiscard]] std::span<const uint8_t> bytes() const { return bytes_; }
  /// FileMap::give_back, if it is mapped.
  void give_back() const { map_.give_back(); }

 private:
  static Result<std::unique_ptr<Zone>> attached(std::unique_ptr<Zone> zone,
                                                const std::string& name) {
    if (auto sound = zone->attach(name); !sound) return sound.error();
    return zone;
  }

  flatbuffers::DetachedBuffer owned_;
  FileMap map_;
  std::span<const uint8_t> bytes_;
};

/// Maps the file of a zone that a list (`whose`, as in "the manifest's") names with its size and
/// XXH3. Fails with kIo or kBadFile; `remedy` says what to do.
inline Result<FileMap> map_listed(const std::string& name, uint64_t bytes, uint64_t hash,
                                  const char* whose, const char* remedy) {
  auto map = FileMap::open(name);
  if (!map) return map.error();
  if (map->bytes().size() == bytes &&
      hash_bytes(map->bytes().data(), map->bytes().size()) == hash) {
    return map;
  }
  return Error{Errc::kBadFile, name + ": its checksum is not " + whose +
                                   " (truncated, damaged or of another bake); " + remedy};
}

/// The verifier sees to the alignment of a vector's length, 4 bytes, but not of larger elements.
template <class T>
bool is_aligned(const flatbuffers::Vector<T>& values) {
  return values.size() == 0 || reinterpret_cast<uintptr_t>(values.Data()) % 8 == 0;
}

}  // namespace throng
