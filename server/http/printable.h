// printable: text of strangers made fit to be shown.
#pragma once

#include <string>
#include <string_view>

namespace server {

// At most 64 bytes, every byte that is not printable ASCII as '?'.
std::string printable(std::string_view text);

} // namespace server
