#include "server/http/printable.h"

#include <algorithm>

namespace server {

std::string printable(std::string_view text)
{
    std::string shown(text.substr(0, 64));
    std::replace_if(
        shown.begin(), shown.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
    return shown;
}

} // namespace server
