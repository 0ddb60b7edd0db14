// read_atmosphere: an `atmosphere` environment that stands alone, as the sky's own commands take it.
#pragma once

#include "api/problem.h"
#include "renderer/description/atmosphere.h"

#include <optional>
#include <string_view>
#include <variant>

namespace api {

// {"type": "atmosphere", ...}; every fault at once, as read_job tells them. `preset`: takes the place of the one that
// the text names; whatever else stands there goes before it as ever.
std::variant<renderer::AtmosphereDescription, ProblemDetails>
read_atmosphere(std::string_view json, std::optional<renderer::AtmospherePreset> preset = {});

} // namespace api
