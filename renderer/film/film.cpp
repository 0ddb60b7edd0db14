#include "renderer/film/film.h"

namespace renderer {

Film::Film(PixelRect rect, LayerSet asked)
    : region(rect), sums(std::size_t{rect.width} * rect.height), layers(asked, sums.size())
{
}

void Film::merge(const TileSums& part)
{
    const PixelRect& t = part.tile;
    std::size_t from = 0;
    for (std::uint32_t y = 0; y < t.height; ++y) {
        const std::size_t row = std::size_t{t.y - region.y + y} * region.width + (t.x - region.x);
        layers.add(part.layers, from, row, t.width);
        for (std::uint32_t x = 0; x < t.width; ++x)
            sums[row + x] += part.sums[from++];
    }
}

LinearImage Film::mean() const
{
    LinearImage image{region.width, region.height, std::vector<Rgb>(sums.size())};
    if (samples == 0) return image;
    const double n = samples;
    for (std::size_t i = 0; i < sums.size(); ++i)
        image.pixels[i] = {static_cast<float>(sums[i].r / n),
                           static_cast<float>(sums[i].g / n),
                           static_cast<float>(sums[i].b / n)};
    return image;
}

FinishedFilm finish(Film film)
{
    FinishedFilm finished{film.mean(), {}};
    std::vector<RgbSum>().swap(film.sums);
    finished.layers = film.layers.mean(film.samples);
    return finished;
}

} // namespace renderer
