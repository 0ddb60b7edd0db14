#include "api/words/digest.h"

#include <algorithm>

namespace api {

namespace {

constexpr std::string_view kScheme = "sha256:";

}

bool names_digest(std::string_view text)
{
    return text.starts_with(kScheme);
}

bool is_digest(std::string_view text)
{
    return names_digest(text) && text.size() == kScheme.size() + 64 &&
           std::all_of(text.begin() + kScheme.size(), text.end(), [](char c) {
               return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f');
           });
}

std::string damaged_asset_words(std::string_view digest)
{
    const std::string name(digest);
    return name + " was damaged on the service's disk: PUT /v1/assets/" + name +
           " with the same bytes mends it, then try again";
}

} // namespace api
