// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <flatbuffers/flatbuffers.h>

#include <cstdint>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <utility>

#include "core/files/file_map.h"
#include "core/hash.h"
#include "throng/base.h"

/// What the files of a world's zones share: the ground's, the air's, the nodes'.
namespace throng::world {

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

inline constexpr const char* kUsualRemedy = "bake the world again";

/// What is wrong with a file, and what to do.
inline Error bad_file(const std::string& name, const std::string& what,
                      const char* remedy = kUsualRemedy) {
  return {Errc::kBadFile, name + ": " + what + "; " + remedy};
}

/// A file as a list names it: with its size and XXH3.
struct ListedFile {
  std::string name;
  uint64_t bytes = 0, hash = 0;
  const char* whose = "";  // as in "the manifest's"
  const char* remedy = kUsualRemedy;
};

/// Maps the file and opens it. Fails with kIo or kBadFile.
template <class Zone>
Result<std::unique_ptr<Zone>> open_listed(const ListedFile& file) {
  auto map = FileMap::open(file.name);
  if (!map) return map.error();
  if (map->bytes().size() != file.bytes ||
      hash_bytes(map->bytes().data(), map->bytes().size()) != file.hash) {
    return bad_file(file.name,
                    std::string("its checksum is not ") + file.whose +
                        " (truncated, damaged or of another bake)",
                    file.remedy);
  }
  return Zone::from_file(std::move(*map), file.name);
}

/// Where a zone is kept that is opened at its first touch, or why it could not be.
template <class Zone>
struct ZoneSlot {
  mutable std::once_flag once;
  mutable std::unique_ptr<Zone> zone;
  mutable std::string error;

  /// What `once` is for, if the zone is on disk. belongs(zone): is it of the world that lists it?
  template <class Belongs>
  void open(const ListedFile& file, Belongs belongs) const {
    auto opened = open_listed<Zone>(file);
    if (!opened) {
      error = opened.error().message;
    } else if (!belongs(**opened)) {
      error = bad_file(file.name, "belongs to another world", file.remedy).message;
    } else {
      zone = std::move(*opened);
    }
  }
};

/// The structs of a vector.
template <class T>
std::span<const T> structs(const flatbuffers::Vector<const T*>& values) {
  return {reinterpret_cast<const T*>(values.Data()), values.size()};
}

/// The verifier sees to the alignment of a vector's length, 4 bytes, but not of larger elements.
template <class T>
bool is_aligned(const flatbuffers::Vector<T>& values) {
  return values.size() == 0 || reinterpret_cast<uintptr_t>(values.Data()) % 8 == 0;
}

}  // namespace throng::world
