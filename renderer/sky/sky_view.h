// SkyView: the whole sky from one place under one sun, by look-up.
//
// Rows are angles to the vertical (view_rows.h), columns azimuths from the sun. What was scattered once is kept apart for
// each constituent and without its phase function, which is a product on look-up: so the table is smooth around the sun.
//
// Units   L / E0, 1/sr. Angles as in single_scattering.h. The sun's disk is not in it.
// Errors  0.5 % rms over the sky by day with the default size; SkyLight measures it and takes a larger one where it must.
// Cost    building: 15 ms of a core, and three times that with light scattered twice and more; a look-up 40 ns.
// Threads the same bits however many build it; const: any number at once.
#pragma once

#include "renderer/parallel/thread_pool.h"
#include "renderer/sky/column_table.h"
#include "renderer/sky/lanes.h"
#include "renderer/sky/scattered_light.h"
#include "renderer/sky/view_rows.h"

#include <cstddef>
#include <vector>

namespace renderer {

struct SkyViewSize {
    std::size_t rows = 48; // on either side of the horizon
    std::size_t azimuths = 25;
    std::size_t points = 20; // of a line of sight, a side of its closest approach
};

class SkyView {
public:
    // `scattered`: null for light scattered once alone. Air and tables must outlive the view.
    SkyView(const Air& air,
            const ColumnTable& columns,
            const ScatteredLight* scattered,
            double altitude,
            double mu_sun,
            ThreadPool& pool,
            const SkyViewSize& size = {});

    [[nodiscard]] Spectrum radiance(double mu, double azimuth_cosine) const;
    // The same in groups of four wavelengths, as many as the air has.
    void radiance(double mu, float azimuth_cosine, Lanes* groups) const;
    // All azimuths of the table at one mu, [azimuth][group][rayleigh, mie, multiple], without the phase functions, as rows
    // of a panorama want them. False where there is nothing to be seen; then nothing is written.
    static constexpr std::size_t kParts = 3;
    bool row(double mu, Lanes* light) const;

    [[nodiscard]] const Air& air() const { return air_; }
    [[nodiscard]] std::size_t azimuths() const { return size_.azimuths; }
    [[nodiscard]] std::size_t groups() const { return groups_; }
    [[nodiscard]] double mu_sun() const { return mu_sun_; }
    [[nodiscard]] double sun_sine() const { return sun_sine_; }
    [[nodiscard]] const ViewRows& rows() const { return rows_; }

private:
    void fill(std::size_t index, const ScatteredLight* scattered);

    const Air& air_;
    const ColumnTable& columns_;
    SkyViewSize size_;
    ViewRows rows_;
    double altitude_, mu_sun_, sun_sine_;
    std::size_t groups_;
    std::vector<Lanes>
        light_; // [row][azimuth][group][rayleigh, mie, multiple]; rows below the horizon come second
};

} // namespace renderer
