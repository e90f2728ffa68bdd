// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "import/formats/mtl.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <utility>

#include "core/files/read_file.h"
#include "import/formats/text_cursor.h"

// Reads of a material: Kd, d or Tr, map_Kd and map_d. Colours of such files are as a screen shows
// them, so their squares are nearly linear light.
namespace throng::importer {
namespace {

constexpr float kBlack = 0.02F;

float linear(double shown) {
  const double root = std::clamp(shown, 0.0, 1.0);  // NaN becomes 0 below.
  return root == root ? static_cast<float>(root * root) : 0.0F;
}

}  // namespace

void MaterialLibrary::read(const std::string& named) {
  const std::filesystem::path name(named);
  const std::filesystem::path folder = std::filesystem::path(model_).parent_path();
  for (const auto& path :
       {folder / (name.is_relative() ? name : name.filename()), folder / name.filename()}) {
    std::error_code failure;
    if (!std::filesystem::is_regular_file(path, failure)) continue;
    const auto bytes = read_file(path.string());
    if (!bytes) break;
    parse(*bytes);
    return;
  }
  missing_.push_back(named);
}

uint32_t MaterialLibrary::texture1(std::string_view arguments) {
  // Options with their numbers stand before the name, which may hold blanks.
  TextCursor cursor(arguments);
  while (cursor.skip_space(), cursor.peek() == '-') {
    cursor.take_word();
    for (double number = 0;;) {
      cursor.skip_space();
      const std::string_view value = cursor.rest();
      TextCursor probe(value);
      const std::string_view word = probe.take_word();
      TextCursor digits(word);
      const bool is_value =
          (digits.take(number) && digits.at_end()) || word == "on" || word == "off";
      if (!is_value) break;
      cursor.take_word();
    }
  }
  const std::string name(cursor.take_rest());
  if (name.empty()) return 0;
  const auto [found, is_new] =
      texture_numbers1_.try_emplace(name, static_cast<uint32_t>(textures_.size()) + 1);
  if (is_new) textures_.push_back({.name = name, .bytes = {}});
  return found->second;
}

void MaterialLibrary::parse(std::string_view bytes) {
  Material* current = nullptr;
  while (!bytes.empty()) {
    const size_t end = bytes.find('\n');
    TextCursor cursor(bytes.substr(0, end));
    bytes = end == std::string_view::npos ? std::string_view() : bytes.substr(end + 1);
    const std::string_view word = cursor.take_word();
    cursor.skip_space();
    if (word == "newmtl") {
      materials_.push_back(
          {.name = std::string(cursor.take_rest()), .colour = {0.6F, 0.6F, 0.6F, 1}});
      numbers1_[materials_.back().name] = static_cast<uint32_t>(materials_.size());
      current = &materials_.back();
      continue;
    }
    if (current == nullptr) continue;
    double number = 0;
    if (word == "Kd") {
      for (size_t c = 0; c < 3 && cursor.take(number); ++c) current->colour[c] = linear(number);
    } else if ((word == "d" || word == "Tr") && cursor.take(number)) {
      const double opaque = word == "d" ? number : 1 - number;
      // A file that confuses the two would show nothing.
      current->colour[3] = opaque > 0.01 && opaque < 1 ? static_cast<float>(opaque) : 1.0F;
      if (current->colour[3] < 1) current->opacity = Opacity::kBlended;
    } else if (word == "map_Kd") {
      current->texture1 = texture1(cursor.rest());
      const auto& colour = current->colour;
      if (std::max({colour[0], colour[1], colour[2]}) < kBlack) {
        current->colour = {1, 1, 1, colour[3]};
      }
    } else if (word == "map_d") {
      // The same file as the colours: its alpha is used. Any other is left out.
      current->opacity = Opacity::kHoles;
    }
  }
}

uint32_t MaterialLibrary::material1(const std::string& name) const {
  const auto found = numbers1_.find(name);
  return found == numbers1_.end() ? 0 : found->second;
}

void MaterialLibrary::hand_over(RawScene& raw) {
  raw.scene.materials = std::move(materials_);
  raw.textures = std::move(textures_);
  if (missing_.empty()) return;
  raw.scene.report.warnings.push_back(fmt::format(
      "{}: the materials of {} are not beside it; plain colours stand in", model_, missing_[0]));
}

}  // namespace throng::importer
