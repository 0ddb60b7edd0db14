#include "renderer/meter.h"

#include "renderer/math/transcendental.h"

#include <cmath>

namespace renderer {

MeterReading read_meter(const Film& film, MeterQuantity quantity)
{
    const LinearImage mean = film.mean();
    const std::size_t count = mean.pixels.size();
    MeterReading reading{quantity, {}, {}, static_cast<std::uint32_t>(count)};
    // Directions of an irradiance meter are drawn by their cosine: pi times the mean radiance.
    const double scale = quantity == MeterQuantity::irradiance ? kPi : 1;
    for (float Rgb::*const channel : {&Rgb::r, &Rgb::g, &Rgb::b}) {
        double sum = 0, squares = 0;
        for (const Rgb& pixel : mean.pixels)
            sum += static_cast<double>(pixel.*channel);
        const auto n = static_cast<double>(count);
        const double average = sum / n;
        for (const Rgb& pixel : mean.pixels) {
            const double off = static_cast<double>(pixel.*channel) - average;
            squares += off * off;
        }
        reading.value.*channel = static_cast<float>(average * scale);
        if (count > 1)
            reading.standard_error.*channel = static_cast<float>(std::sqrt(squares / (n - 1) / n) * scale);
    }
    return reading;
}

} // namespace renderer
