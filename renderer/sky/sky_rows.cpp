#include "renderer/sky/sky_rows.h"

#include "renderer/sky/arc_cosine.h"
#include "renderer/sky/phase.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace renderer {

SkyRows::SkyRows(const SkyView& view, const SkyColor& color, const std::vector<double>& azimuth_cosines)
    : view_(view), color_(color), cosines_(azimuth_cosines)
{
    places_.reserve(cosines_.size());
    for (const double cosine : cosines_)
        places_.push_back(angle_place(arc_cosine(static_cast<float>(cosine)), view.azimuths()));
}

void SkyRows::fill(double mu, Rgb* pixels) const
{
    constexpr std::size_t kParts = SkyView::kParts;
    std::vector<Lanes> row(view_.azimuths() * view_.groups() * kParts);
    if (!view_.row(mu, row.data())) {
        std::fill_n(pixels, cosines_.size(), Rgb{});
        return;
    }
    // Colours, of each column of the view, and what the next one differs by: a product is linear in them.
    struct Cell {
        std::array<Lanes, kParts> light, step;
    };
    std::vector<Cell> cells(view_.azimuths());
    for (std::size_t a = 0; a < cells.size(); ++a)
        for (std::size_t part = 0; part < kParts; ++part)
            cells[a].light[part] = color_.mix(&row[a * view_.groups() * kParts + part], kParts);
    for (std::size_t a = 0; a + 1 < cells.size(); ++a)
        for (std::size_t part = 0; part < kParts; ++part)
            cells[a].step[part] = cells[a + 1].light[part] - cells[a].light[part];

    const double up = mu * view_.mu_sun(),
                 side = std::sqrt(std::max(0.0, (1 - mu) * (1 + mu))) * view_.sun_sine();
    const auto fill_with = [&](auto phase) {
        // Some at a time, apart from the look-ups: the compiler makes vectors of it.
        constexpr std::size_t kChunk = 64;
        std::array<float, kChunk> rayleigh, mie;
        for (std::size_t begin = 0; begin < cosines_.size(); begin += kChunk) {
            const std::size_t count = std::min(kChunk, cosines_.size() - begin);
            for (std::size_t i = 0; i < count; ++i) {
                const double nu = std::min(1.0, std::max(-1.0, up + side * cosines_[begin + i]));
                rayleigh[i] = static_cast<float>(rayleigh_phase(nu));
                mie[i] = static_cast<float>(phase(nu));
            }
            for (std::size_t i = 0; i < count; ++i) {
                const AnglePlace at = places_[begin + i];
                const Cell& cell = cells[at.column];
                const Lanes share = splat(at.share);
                const Lanes light = (cell.light[0] + cell.step[0] * share) * splat(rayleigh[i]) +
                                    (cell.light[1] + cell.step[1] * share) * splat(mie[i]) +
                                    (cell.light[2] + cell.step[2] * share);
                const Lanes seen = light > 0 ? light : Lanes{};
                pixels[begin + i] = {seen[0], seen[1], seen[2]};
            }
        }
    };
    const double g = view_.air().g;
    switch (view_.air().phase) {
    case MiePhase::cornette_shanks:
        return fill_with([g](double nu) { return mie_phase(MiePhase::cornette_shanks, g, nu); });
    case MiePhase::henyey_greenstein:
        return fill_with([g](double nu) { return mie_phase(MiePhase::henyey_greenstein, g, nu); });
    }
}

} // namespace renderer
