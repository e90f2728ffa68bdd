// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "paths/boxes.h"

#include <fmt/format.h>

#include <algorithm>

#include "command.h"

// The option --block: obstacles as boxes.
namespace throng::app {

void add_blocks(CLI::App* command, std::vector<double>& blocks) {
  command->add_option("--block", blocks, "A box-shaped obstacle, by two opposite corners [m]")
      ->delimiter(',')
      ->type_size(6)
      ->expected(1, 1 << 16)
      ->type_name("X,Y,Z,X,Y,Z");
}

Result<Prism> box_of(std::span<const double, 6> corners, const char* option) {
  const Vec3d a{corners[0], corners[1], corners[2]}, b{corners[3], corners[4], corners[5]};
  if (a.x == b.x || a.y == b.y || a.z == b.z) {
    return Error{Errc::kBadInput,
                 fmt::format("{}: ({}) and ({}) are no opposite corners of a box: they must differ "
                             "in x, y and z",
                             option, where(a), where(b))};
  }
  const Prism box = Prism::box({std::min(a.x, b.x), std::min(a.y, b.y), std::min(a.z, b.z)},
                               {std::max(a.x, b.x), std::max(a.y, b.y), std::max(a.z, b.z)});
  if (auto ok = check_prism(box); !ok) {
    return Error{Errc::kBadInput, fmt::format("{}: {}", option, ok.error().message)};
  }
  return box;
}

Result<std::vector<Prism>> boxes_of(const std::vector<double>& blocks) {
  std::vector<Prism> boxes;
  for (size_t i = 0; i + 6 <= blocks.size(); i += 6) {
    const auto box = box_of(std::span(blocks).subspan(i).first<6>(), "--block");
    if (!box) return box.error();
    boxes.push_back(*box);
  }
  return boxes;
}

}  // namespace throng::app
