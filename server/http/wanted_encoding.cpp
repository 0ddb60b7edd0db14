#include "server/http/wanted_encoding.h"

#include "server/http/negotiation.h"
#include "server/http/printable.h"

#include <string>

namespace server {

namespace {

// ?bits=: 8, or 16 where the answer is to be a PNG of that depth.
std::variant<std::uint8_t, api::ProblemDetails> wanted_bits(const Exchange& exchange)
{
    const std::string bits = exchange.query("bits").value_or("8");
    if (bits == "8") return std::uint8_t{8};
    if (bits == "16") return std::uint8_t{16};
    return query_problem("out_of_range", "bits=" + printable(bits) + ": a PNG has 8 or 16 bits a channel");
}

} // namespace

api::ProblemDetails not_acceptable(std::optional<renderer::Layer> layer)
{
    std::string all;
    for (const renderer::PictureFormatEntry& entry : renderer::kPictureFormats)
        if (!layer || holds(entry.format, *layer))
            all += (all.empty() ? "" : ", ") + std::string(entry.media_type);
    const std::string what = layer ? "layer " + std::string(entry_of(*layer).name) : "picture";
    return problem(406,
                   "not_acceptable",
                   "the " + what + " is to be had as " + all +
                       ": Accept: " + (layer ? "image/x-exr" : "image/png") + ", say");
}

std::variant<renderer::PictureEncoding, api::ProblemDetails>
wanted_encoding(const Exchange& exchange, std::optional<renderer::Layer> layer)
{
    const Acceptance accept = read_accept(exchange.header("Accept"));
    auto bits = wanted_bits(exchange);
    if (auto* refusal = std::get_if<api::ProblemDetails>(&bits)) return std::move(*refusal);
    if (std::get<std::uint8_t>(bits) == 16) {
        using enum renderer::PictureFormat;
        const bool can_be_png = !layer || holds(png, *layer);
        if (can_be_png && accept.takes(png)) return renderer::PictureEncoding{png, 16};
        return problem(406,
                       "not_acceptable",
                       can_be_png ? "?bits=16 is for PNG: Accept: image/png, or leave it out"
                                  : "?bits=16 is for PNG; " + not_acceptable(layer).detail);
    }
    const auto best = layer ? accept.best_of(*layer) : accept.best();
    if (!best) return not_acceptable(layer);
    return renderer::PictureEncoding{*best, 8};
}

} // namespace server
