// SkyRows: rows of a panorama of the whole sky. What a row's pixels share, and what a column's do, is computed once.
//
// Frame   the eye's vertical is the picture's; columns are azimuths from the sun.
// Errors  those of the SkyView; differs from its look-up by single-precision rounding.
// Cost    a pixel 15 ns in rows of 512, what a row shares included.
// Threads const: any number at once. View and colour must outlive it.
#pragma once

#include "renderer/color/rgb.h"
#include "renderer/sky/lanes.h"
#include "renderer/sky/sky_color.h"
#include "renderer/sky/sky_view.h"

#include <cstddef>
#include <vector>

namespace renderer {

class SkyRows {
public:
    // Of each column the cosine of its azimuth from the sun, in [-1, 1].
    SkyRows(const SkyView& view, const SkyColor& color, const std::vector<double>& azimuth_cosines);

    // Light of every column at one cosine to the vertical: `pixels` has room for them.
    void fill(double mu, Rgb* pixels) const;

private:
    const SkyView& view_;
    const SkyColor& color_;
    std::vector<double> cosines_;
    std::vector<AnglePlace> places_; // in the view's columns
};

} // namespace renderer
