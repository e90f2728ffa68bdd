// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <utility>

/// The library's access to what its public classes hold. Each of these classes has one member,
/// `state_`, and names Access as its only friend, so public headers show no internals.
namespace throng {

struct Access {
  /// What a handle holds: World, Nodes, GroundFinder, PreparedScene.
  template <class Handle>
  [[nodiscard]] static auto& state(Handle& handle) {
    return handle.state_;
  }
  /// A handle of a state.
  template <class Handle, class State>
  [[nodiscard]] static Handle create(State state) {
    return Handle(std::move(state));
  }
};

/// The data of a world (WorldData) or of nodes (NodeData); null for a handle made by default.
template <class Handle>
[[nodiscard]] const auto& data_of(const Handle& handle) {
  return Access::state(handle);
}

}  // namespace throng
