// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "core/function_ref.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <memory>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>

namespace throng {
namespace {

int call_twice(FunctionRef<int(int)> f) { return f(1) + f(2); }
int triple(int value) { return 3 * value; }

TEST(FunctionRef, CallsTheCallableItselfAndNoCopy) {
  int sum = 0;
  auto count = [&sum, calls = 0](int value) mutable {
    sum += value;
    return ++calls;
  };
  EXPECT_EQ(call_twice(count), 1 + 2);
  EXPECT_EQ(call_twice(count), 3 + 4);  // Of a copy, the calls would begin again.
  EXPECT_EQ(sum, 6);
}

TEST(FunctionRef, TakesWhatCannotBeCopiedWhatIsConstAndPointersToFunctions) {
  const auto owner = [five = std::make_unique<int>(5)](int value) { return *five * value; };
  static_assert(!std::is_copy_constructible_v<decltype(owner)>);
  EXPECT_EQ(call_twice(owner), 15);
  EXPECT_EQ(call_twice(&triple), 9);
  EXPECT_EQ(call_twice([](int value) { return -value; }), -3);
}

// Else a reference that is handed on would refer to a parameter that is gone.
TEST(FunctionRef, ACopyRefersToTheSameCallable) {
  const auto one = [](int) { return 1; };
  const auto ten = [](int) { return 10; };
  FunctionRef<int(int)> first = one;
  const FunctionRef<int(int)> second = first;
  first = ten;
  EXPECT_EQ(call_twice(first), 20);
  EXPECT_EQ(call_twice(second), 2);
}

TEST(FunctionRef, PassesReferencesAndValuesThatOnlyMove) {
  std::string text = "a";
  const auto append = [](std::string& to, std::unique_ptr<std::string> what) -> std::string& {
    return to += *what;
  };
  const FunctionRef<std::string&(std::string&, std::unique_ptr<std::string>)> f = append;
  EXPECT_EQ(&f(text, std::make_unique<std::string>("b")), &text);
  EXPECT_EQ(text, "ab");
}

TEST(FunctionRef, DropsAResultThatIsNotWantedAndThrowsWhatIsThrown) {
  int calls = 0;
  const auto next = [&] { return ++calls; };
  const FunctionRef<void()> f = next;
  f();
  EXPECT_EQ(calls, 1);
  const auto fail = [] { throw std::runtime_error("as thrown"); };
  const FunctionRef<void()> g = fail;
  EXPECT_THROW(g(), std::runtime_error);
}

TEST(FunctionRef, RefusesWhatCannotBeCalledSo) {
  const auto of_text = [](const std::string& text) { return text; };
  static_assert(!std::is_constructible_v<FunctionRef<int(int)>, decltype(of_text)&>);
  static_assert(!std::is_constructible_v<FunctionRef<int(int)>, std::nullptr_t>);
  static_assert(!std::is_default_constructible_v<FunctionRef<int(int)>>);
  static_assert(std::is_trivially_copyable_v<FunctionRef<int(int)>>);
  static_assert(sizeof(FunctionRef<int(int)>) == 2 * sizeof(void*));
  EXPECT_EQ(FunctionRef<std::string(std::string)>(of_text)("so"), "so");
}

}  // namespace
}  // namespace throng
