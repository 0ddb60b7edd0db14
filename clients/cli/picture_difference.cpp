#include "clients/cli/picture_difference.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

namespace clients {
namespace {

std::array<double, 3> channels_of(const renderer::Rgb& color)
{
    return {color.r, color.g, color.b};
}

bool is_finite(const renderer::Rgb& c)
{
    return std::isfinite(c.r) && std::isfinite(c.g) && std::isfinite(c.b);
}

std::string number(double value)
{
    if (!std::isfinite(value)) return "null";
    std::array<char, 32> text{};
    return {text.data(), std::to_chars(text.data(), text.data() + text.size(), value).ptr};
}

} // namespace

std::optional<PictureDifference> difference(const renderer::LinearImage& picture,
                                            const renderer::LinearImage& reference)
{
    if (picture.width_px != reference.width_px || picture.height_px != reference.height_px)
        return std::nullopt;
    PictureDifference out;
    const auto counts = [&](std::size_t i) {
        return is_finite(picture.pixels[i]) && is_finite(reference.pixels[i]);
    };

    double reference_sum = 0;
    std::uint64_t pixels = 0;
    for (std::size_t i = 0; i < reference.pixels.size(); ++i) {
        if (!counts(i)) continue;
        ++pixels;
        for (const double value : channels_of(reference.pixels[i]))
            reference_sum += value;
    }
    out.non_finite_pixels = reference.pixels.size() - pixels;
    if (pixels == 0) return out;
    const double mean = reference_sum / (3 * static_cast<double>(pixels));
    const double e = 0.2 * mean * (0.2 * mean);

    double squares = 0, relative_squares = 0;
    for (std::size_t i = 0; i < reference.pixels.size(); ++i) {
        if (!counts(i)) continue;
        const auto x = channels_of(picture.pixels[i]), ref = channels_of(reference.pixels[i]);
        for (std::size_t c = 0; c < 3; ++c) {
            const double d = x[c] - ref[c];
            squares += d * d;
            if (d != 0)
                relative_squares += d * d / (ref[c] * ref[c] + e); // 0/0 of an all-black pair is no error
            out.max = std::max(out.max, std::abs(d));
            out.mean[c] += d;
        }
    }
    const auto count = static_cast<double>(pixels);
    out.rmse = std::sqrt(squares / (3 * count));
    out.relative_rmse = std::sqrt(relative_squares / (3 * count));
    for (double& channel : out.mean)
        channel /= count;
    return out;
}

std::string write_json(const PictureDifference& d)
{
    return "{\"rmse\":" + number(d.rmse) + ",\"relative_rmse\":" + number(d.relative_rmse) +
           ",\"max\":" + number(d.max) + ",\"mean\":[" + number(d.mean[0]) + ',' + number(d.mean[1]) + ',' +
           number(d.mean[2]) + "],\"non_finite_pixels\":" + std::to_string(d.non_finite_pixels) + "}\n";
}

std::string write_text(const PictureDifference& d)
{
    const auto shown = [](double value) {
        return std::isfinite(value) ? number(value) : std::string("infinite");
    };
    std::string out = "rmse           " + shown(d.rmse) + "\nrelative_rmse  " + shown(d.relative_rmse) +
                      "\nmax            " + shown(d.max) + "\nmean           " + shown(d.mean[0]) + ' ' +
                      shown(d.mean[1]) + ' ' + shown(d.mean[2]) + '\n';
    if (d.non_finite_pixels > 0)
        out += "non-finite     " + std::to_string(d.non_finite_pixels) + " pixels, left out\n";
    return out;
}

} // namespace clients
