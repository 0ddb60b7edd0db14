// SkyColor: from the wavelengths of an atmosphere to linear Rec. 709.
//
// Three wavelengths stand for red, green and blue as they are, longest first; any other number is weighted by the eye's
// colour matching, the sun's spectrum and its distance to its neighbours, in any order, and white is the sun above the air: a sky that took nothing from its light
// would have the colour of the irradiance.
//
// Source  Wyman, Sloan, Shirley, "Simple Analytic Approximations to the CIE XYZ Color Matching Functions", 2013; the
//         sun as a black body of 5778 K.
#pragma once

#include "renderer/color/rgb.h"
#include "renderer/sky/air.h"
#include "renderer/sky/lanes.h"

#include <array>
#include <cstddef>
#include <vector>

namespace renderer {

class SkyColor {
public:
    // `irradiance`: the sun's above the air, W/m^2 a channel.
    SkyColor(const std::vector<double>& wavelengths_nm, Rgb irradiance);

    // From L / E0 (or E / E0) at each wavelength.
    [[nodiscard]] Rgb operator()(const Spectrum& spectrum) const;
    // The same of groups of wavelengths as look-ups give them: no double, no bounds.
    [[nodiscard]] Rgb of_lanes(const Lanes* groups) const;
    // As lanes (red, green, blue, 0), also below 0, of groups `stride` apart: linear, to be added up before it is cut.
    [[nodiscard]] Lanes mix(const Lanes* groups, std::size_t stride) const
    {
        Lanes sum{};
        for (std::size_t w = 0; w < columns_.size(); ++w)
            sum += columns_[w] * splat(groups[w / kLanes * stride][w % kLanes]);
        return sum;
    }
    // A share that is taken or left, without the irradiance: of white, white is left.
    [[nodiscard]] Rgb share(const Spectrum& spectrum) const;
    [[nodiscard]] Rgb share_of_lanes(const Lanes* groups) const;

private:
    std::vector<std::array<double, 3>> weight_; // one a wavelength; each channel sums to 1
    std::vector<std::array<Lanes, 3>> lanes_;   // the same times the irradiance, [group]
    std::vector<Lanes> columns_;                // and [wavelength] (red, green, blue, 0)
    Rgb irradiance_;
};

} // namespace renderer
