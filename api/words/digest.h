// Names of assets by content: "sha256:" and 64 lower-case hex digits.
#pragma once

#include <string_view>

namespace api {

bool names_digest(std::string_view text); // begins with "sha256:", well-formed or not
bool is_digest(std::string_view text);

} // namespace api
