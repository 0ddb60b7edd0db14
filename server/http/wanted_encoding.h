// What encoding of a picture or layer a request asks for, by Accept and ?bits=.
#pragma once

#include "api/problem.h"
#include "renderer/description/layers.h"
#include "renderer/description/picture_formats.h"
#include "server/http/exchange.h"

#include <variant>

namespace server {

// 406: no format of pictures is taken.
api::ProblemDetails not_acceptable();

// Of /image: what Accept likes best, or with ?bits=16 a PNG of that depth; or why not, 406 or 422.
std::variant<renderer::PictureEncoding, api::ProblemDetails> wanted_encoding(const Exchange& exchange);
// Of a layer: the same, among the formats that hold it.
std::variant<renderer::PictureEncoding, api::ProblemDetails> wanted_encoding(const Exchange& exchange,
                                                                             renderer::Layer layer);

} // namespace server
