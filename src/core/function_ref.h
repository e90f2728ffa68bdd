// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <memory>
#include <type_traits>
#include <utility>

/// A reference to anything that can be called.
namespace throng {

template <class Signature>
class FunctionRef;

/// For parameters that are called and not kept, as std::function_ref of C++26: it neither owns nor
/// copies the callable and never allocates. Two pointers: pass it by value. It must not outlive the
/// callable, so a FunctionRef that is no parameter refers to a callable that has a name. Whatever
/// the callable throws is thrown. A function itself is passed as a pointer, &f.
template <class Return, class... Args>
class FunctionRef<Return(Args...)> {
 public:
  template <class Callable>
  requires(!std::is_same_v<std::remove_cvref_t<Callable>, FunctionRef> &&
           std::is_object_v<std::remove_reference_t<Callable>> &&
           std::is_invocable_r_v<Return, std::remove_reference_t<Callable>&, Args...>)
      FunctionRef(Callable&& callable)
  noexcept  // Not explicit, so that a lambda can be passed.
      : callable_(const_cast<void*>(static_cast<const void*>(std::addressof(callable)))),
        call_(&call_as<std::remove_reference_t<Callable>>) {}

  Return operator()(Args... args) const { return call_(callable_, std::forward<Args>(args)...); }

 private:
  template <class Callable>
  static Return call_as(void* callable, Args... args) {
    return static_cast<Return>(
        std::invoke(*static_cast<Callable*>(callable), std::forward<Args>(args)...));
  }

  void* callable_;  // const if its type in call_as is
  Return (*call_)(void* callable, Args... args);
};

}  // namespace throng
