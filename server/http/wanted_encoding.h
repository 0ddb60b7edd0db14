// What encoding of a picture or layer a request asks for, by Accept and ?bits=.
#pragma once

#include "api/problem.h"
#include "renderer/description/layers.h"
#include "renderer/description/picture_formats.h"
#include "server/http/exchange.h"

#include <optional>
#include <variant>

namespace server {

// Of a layer, or of the picture where none is named. 406: no format that holds it is taken.
api::ProblemDetails not_acceptable(std::optional<renderer::Layer> layer);

// What Accept likes best among the formats that hold it, or with ?bits=16 a PNG of that depth; or why not, 406 or 422.
std::variant<renderer::PictureEncoding, api::ProblemDetails>
wanted_encoding(const Exchange& exchange, std::optional<renderer::Layer> layer);

} // namespace server
