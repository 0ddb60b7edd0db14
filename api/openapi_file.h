// api/openapi.json as it stands in the tree, compiled in.
#pragma once

#include <string_view>

namespace api {

std::string_view openapi_file();

} // namespace api
