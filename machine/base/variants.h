#pragma once
#include <concepts>

/// Visiting a std::variant so that an alternative nobody thought of does not compile.
namespace kadr {

/// One function object of several lambdas: std::visit(Overloaded{...}, variant).
template <class... Functions>
struct Overloaded : Functions... {
  using Functions::operator()...;
};
// clang 14 does not deduce the arguments of an aggregate
template <class... Functions>
Overloaded(Functions...) -> Overloaded<Functions...>;

/// True for the types of the list: `[](const OneOf<Dwell, InputWait> auto& pause) {...}`.
template <class T, class... Types>
concept OneOf = (std::same_as<T, Types> || ...);

}  // namespace kadr
