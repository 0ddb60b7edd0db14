// AerialView: the air between an eye and what it sees, by look-up: what it lets through, and the light that it adds.
//
// Along each line of sight distances are shares of its way within the air, up to the ground or `far_m`: so what stands on
// the ground is where a row ends, whatever the angle. Rows and parts as in SkyView. Objects cast no shadow into the air.
//
// Units   metres; what is added is L / E0, 1/sr.
// Errors  against quadrature: sky_light_test.cpp.
// Cost    building: 0.15 s of a core; a look-up 150 ns.
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

struct AerialSize {
    std::size_t rows = 40; // on either side of the horizon
    std::size_t azimuths = 19;
    std::size_t slices = 16; // of a way, thin at both its ends
};

class AerialView {
public:
    // `scattered`: null for light scattered once alone. Air and tables must outlive the view.
    AerialView(const Air& air,
               const ColumnTable& columns,
               const ScatteredLight* scattered,
               double altitude,
               double mu_sun,
               double far_m,
               ThreadPool& pool,
               const AerialSize& size = {});

    // In groups of four wavelengths, as many as the air has. What lies beyond far_m or the ground is taken as there.
    void look(double mu, float azimuth_cosine, double distance, Lanes* transmittance, Lanes* added) const;

private:
    struct Way { // within the air, from the eye
        double begin = 0, end = 0;
    };
    [[nodiscard]] Way way(double mu) const;
    void fill(std::size_t row, const ScatteredLight* scattered);

    const Air& air_;
    const ColumnTable& columns_;
    AerialSize size_;
    ViewRows rows_;
    double altitude_, mu_sun_, sun_sine_, far_;
    std::size_t groups_;
    std::vector<double> ends_; // of slices, shares of a way
    std::vector<Lanes> light_; // [row][end of a slice][azimuth][group][rayleigh, mie, multiple]
    std::vector<Lanes> depth_; // optical, [row][end of a slice][group]
};

} // namespace renderer
