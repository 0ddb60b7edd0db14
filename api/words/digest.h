// Names of assets by content: "sha256:" and 64 lower-case hex digits.
#pragma once

#include <string>
#include <string_view>

namespace api {

bool names_digest(std::string_view text); // begins with "sha256:", well-formed or not
bool is_digest(std::string_view text);

// Of an asset whose bytes the service's disk lost: what to do.
std::string damaged_asset_words(std::string_view digest);

} // namespace api
