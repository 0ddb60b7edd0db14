// "Did you mean", and text of strangers made fit to be shown.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace server {

// The one of `known` that `word` most likely meant; empty where none is near.
std::string nearest(std::string_view word, const std::vector<std::string>& known);
// At most 64 bytes, every byte that is not printable ASCII as '?'.
std::string printable(std::string_view text);

} // namespace server
