// JSON Pointers (RFC 6901): where in the request a fault is.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace api {

// `base` and one more step; ~ and / of a member's name are escaped.
std::string pointer_to(std::string_view base, std::string_view member);
std::string pointer_to(std::string_view base, std::size_t index);

// Order of pointers in an answer: step by step, numbers as numbers, a value before its members.
bool comes_before(std::string_view a, std::string_view b);

// `pointer` is `base` or below it.
bool is_within(std::string_view pointer, std::string_view base);

} // namespace api
