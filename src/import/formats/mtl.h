// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "import/raw/raw_scene.h"

namespace throng::importer {

/// The materials of a Wavefront OBJ, from the .mtl files beside it.
class MaterialLibrary {
 public:
  explicit MaterialLibrary(std::string model) : model_(std::move(model)) {}

  /// Adds the materials of a file that the model names. If the file is missing, its materials are
  /// left out and one warning names it.
  void read(const std::string& named);
  /// The same from bytes.
  void parse(std::string_view bytes);
  /// Number of a material as of a ScenePart: 0 if it is not known.
  [[nodiscard]] uint32_t material1(const std::string& name) const;
  /// Gives materials, textures and warnings to the scene.
  void hand_over(RawScene& raw);

 private:
  uint32_t texture1(std::string_view arguments);

  std::string model_;
  std::vector<Material> materials_;
  std::map<std::string, uint32_t> numbers1_;
  std::vector<TextureSource> textures_;
  std::map<std::string, uint32_t> texture_numbers1_;
  std::vector<std::string> missing_;
};

}  // namespace throng::importer
