// Sees: what a walk over the members of T takes: T to fill, or T to look at.
#pragma once

#include <concepts>
#include <type_traits>

namespace api {

template <typename X, typename T>
concept Sees = std::same_as<std::remove_const_t<X>, T>;

} // namespace api
