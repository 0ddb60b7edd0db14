// EnvironmentMap: an equirectangular picture of light from all around, looked up and sampled by what it gives.
//
// Frame   +y up; the centre column is -z, turned by rotation_deg about +y, counter-clockwise seen from above; +x is to
//         its right; the top row is +y.
// Light   every texel is a patch of the sphere of one radiance: so its light is exactly its radiance times its solid
//         angle, at the poles and the seam too. What cameras see, directly or by mirrors, is interpolated.
// Units   radiance W/(m^2 sr); pdfs per steradian.
// Memory  24 bytes a texel. Cost: a look-up two inverse functions; a sample two binary searches.
#pragma once

#include "renderer/color/rgb.h"
#include "renderer/math/vec3.h"
#include "renderer/sampling/sampler.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace renderer {

class EnvironmentMap {
public:
    // Rows from the top; values are finite and not below 0.
    EnvironmentMap(std::uint32_t width, std::uint32_t height, std::vector<Rgb> texels, double rotation_deg);

    Rgb radiance(Vec3d direction) const;     // of the texel, as light
    Rgb interpolated(Vec3d direction) const; // as seen

    struct Sample {
        Vec3d wi{};
        Rgb radiance{};
        double pdf = 0; // 0: it is all black
    };
    Sample sample(Sample2 u) const;
    double pdf(Vec3d direction) const;

    std::uint64_t size_bytes() const;

private:
    struct Place {
        double column, row; // in texels from the left and the top
    };
    Place place_of(Vec3d direction) const;
    std::size_t index_of(Vec3d direction) const;
    double solid_angle(std::size_t row) const;

    std::uint32_t width_, height_;
    std::vector<Rgb> texels_;
    double sin_turn_, cos_turn_;
    std::vector<double> row_cosines_; // of the upper edges of rows, and of the lowest one's lower edge
    std::vector<double> rows_;        // chance of a row above number i, height + 1 of them
    std::vector<float> columns_;      // within each row likewise, width + 1 a row
};

} // namespace renderer
