#include "server/http/wanted_encoding.h"

#include "server/http/negotiation.h"
#include "server/http/printable.h"

#include <string>

namespace server {

namespace {

constexpr renderer::PictureEncoding kPng16{renderer::PictureFormat::png, 16};

// ?bits=: 8, or 16 where the answer is to be a PNG of that depth.
std::variant<std::uint8_t, api::ProblemDetails> wanted_bits(const Exchange& exchange)
{
    const std::string bits = exchange.query("bits").value_or("8");
    if (bits == "8") return std::uint8_t{8};
    if (bits == "16") return std::uint8_t{16};
    return query_problem("out_of_range", "bits=" + printable(bits) + ": a PNG has 8 or 16 bits a channel");
}

std::string media_types_of(renderer::Layer layer)
{
    std::string all;
    for (const renderer::PictureFormatEntry& entry : renderer::kPictureFormats)
        if (holds(entry.format, layer)) all += (all.empty() ? "" : ", ") + std::string(entry.media_type);
    return all;
}

} // namespace

api::ProblemDetails not_acceptable()
{
    std::string all;
    for (const renderer::PictureFormatEntry& entry : renderer::kPictureFormats)
        all += (all.empty() ? "" : ", ") + std::string(entry.media_type);
    return problem(406, "not_acceptable", "the picture is to be had as " + all + ": Accept: image/png, say");
}

std::variant<renderer::PictureEncoding, api::ProblemDetails> wanted_encoding(const Exchange& exchange)
{
    const Acceptance accept = read_accept(exchange.header("Accept"));
    auto bits = wanted_bits(exchange);
    if (auto* refusal = std::get_if<api::ProblemDetails>(&bits)) return std::move(*refusal);
    if (std::get<std::uint8_t>(bits) == 16) {
        if (accept.takes(renderer::PictureFormat::png)) return kPng16;
        return problem(406, "not_acceptable", "?bits=16 is for PNG: Accept: image/png, or leave it out");
    }
    const auto best = accept.best();
    if (!best) return not_acceptable();
    return renderer::PictureEncoding{*best, 8};
}

std::variant<renderer::PictureEncoding, api::ProblemDetails> wanted_encoding(const Exchange& exchange,
                                                                             renderer::Layer layer)
{
    const Acceptance accept = read_accept(exchange.header("Accept"));
    auto bits = wanted_bits(exchange);
    if (auto* refusal = std::get_if<api::ProblemDetails>(&bits)) return std::move(*refusal);
    const std::string name(entry_of(layer).name);
    if (std::get<std::uint8_t>(bits) == 16) {
        const bool is_png = holds(renderer::PictureFormat::png, layer);
        if (is_png && accept.takes(renderer::PictureFormat::png)) return kPng16;
        return problem(406,
                       "not_acceptable",
                       is_png ? "?bits=16 is for PNG: Accept: image/png, or leave it out"
                              : "?bits=16 is for PNG, and the layer " + name + " is to be had as " +
                                    media_types_of(layer) + " alone");
    }
    const auto best = accept.best_of(layer);
    if (best) return renderer::PictureEncoding{*best, 8};
    return problem(406,
                   "not_acceptable",
                   "the layer " + name + " is to be had as " + media_types_of(layer) +
                       ": Accept: image/x-exr, say");
}

} // namespace server
