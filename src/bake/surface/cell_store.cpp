// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "bake/surface/cell_store.h"

#include <cstring>
#include <type_traits>
#include <utility>

// An entry is a row of arrays, each behind its count. Places are whole kilobytes and used again, so
// the file is as large as what is needed at a time.
namespace throng::bake {
namespace {

constexpr uint32_t kBlock = 1024;  // [bytes]

uint32_t place_of(uint32_t bytes) { return (bytes + kBlock - 1) / kBlock * kBlock; }

class Writer {
 public:
  template <class Value>
  void add(const Value& value) {
    static_assert(std::is_trivially_copyable_v<Value>);
    const auto* bytes = reinterpret_cast<const uint8_t*>(&value);
    bytes_.insert(bytes_.end(), bytes, bytes + sizeof value);
  }
  template <class Value>
  void add(const std::vector<Value>& values) {
    static_assert(std::is_trivially_copyable_v<Value>);
    add(static_cast<uint32_t>(values.size()));
    const auto* bytes = reinterpret_cast<const uint8_t*>(values.data());
    bytes_.insert(bytes_.end(), bytes, bytes + values.size() * sizeof(Value));
  }
  [[nodiscard]] const std::vector<uint8_t>& bytes() const { return bytes_; }

 private:
  std::vector<uint8_t> bytes_;
};

// Reads what Writer has written.
class Reader {
 public:
  explicit Reader(const std::vector<uint8_t>& bytes) : bytes_(bytes) {}
  template <class Value>
  void get(Value& value) {
    std::memcpy(&value, bytes_.data() + at_, sizeof value);
    at_ += sizeof value;
  }
  template <class Value>
  void get(std::vector<Value>& values) {
    uint32_t count = 0;
    get(count);
    values.resize(count);
    if (count > 0) std::memcpy(values.data(), bytes_.data() + at_, count * sizeof(Value));
    at_ += count * sizeof(Value);
  }

 private:
  const std::vector<uint8_t>& bytes_;
  size_t at_ = 0;
};

// Calls visit for each part of the cells but their makers.
template <class Cells, class Visit>
void for_each_part(Cells& cells, Visit visit) {
  visit(cells.promise.depth);
  visit(cells.promise.partial);
  visit(cells.promise.cells);
  visit(cells.promise.cut_s);
  visit(cells.promise.cut_t);
  visit(cells.promise.step_s);
  visit(cells.promise.step_t);
  visit(cells.origin);
  visit(cells.shape);
}

}  // namespace

Result<std::unique_ptr<CellStore>> CellStore::create(const std::string& folder) {
  auto file = ScratchFile::create(folder, "cells");
  if (!file) return file.error();
  return std::unique_ptr<CellStore>(new CellStore(*std::move(file)));
}

void CellStore::keep(const NodeRegion& region, uint32_t patch, const BezierCells& cells) {
  Writer writer;
  for_each_part(cells, [&](const auto& part) { writer.add(part); });
  std::vector<uint32_t> makers;
  for (const uint32_t maker : cells.makers) makers.push_back(region.number_of(maker));
  writer.add(makers);
  Entry entry{.offset = 0, .bytes = static_cast<uint32_t>(writer.bytes().size())};
  {
    const std::lock_guard lock(mutex_);
    std::vector<uint64_t>& places = free_[place_of(entry.bytes)];
    if (places.empty()) {
      entry.offset = end_;
      end_ += place_of(entry.bytes);
    } else {
      entry.offset = places.back();
      places.pop_back();
    }
  }
  if (!file_.write(entry.offset, writer.bytes().data(), writer.bytes().size())) return;
  const std::lock_guard lock(mutex_);
  entries_[region.number_of(patch)] = entry;
}

bool CellStore::read(const NodeRegion& region, uint32_t patch, BezierCells& out) const {
  Entry entry;
  {
    const std::lock_guard lock(mutex_);
    const auto found = entries_.find(region.number_of(patch));
    if (found == entries_.end()) return false;
    entry = found->second;
  }
  std::vector<uint8_t> bytes(entry.bytes);
  if (!file_.read(entry.offset, bytes.data(), bytes.size())) return false;
  Reader reader(bytes);
  BezierCells cells;
  for_each_part(cells, [&](auto& part) { reader.get(part); });
  reader.get(cells.makers);
  for (uint32_t& maker : cells.makers) {
    maker = region.patch_of(maker);
    if (maker == kNoPatch) return false;
  }
  out = std::move(cells);
  return true;
}

void CellStore::drop(uint32_t number) {
  const std::lock_guard lock(mutex_);
  const auto found = entries_.find(number);
  if (found == entries_.end()) return;
  free_[place_of(found->second.bytes)].push_back(found->second.offset);
  entries_.erase(found);
}

}  // namespace throng::bake
