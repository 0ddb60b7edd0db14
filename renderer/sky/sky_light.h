// SkyLight: what an atmosphere gives a renderer: the sky and the sun as lights, and the air between two points.
//
// Frame   the world's: right-handed, y up at the world's origin, which lies `altitude_m` above the ground; azimuth from -z
//         towards +x. The planet's centre is straight below the origin.
// Units   W/(m^2 sr) and W/m^2 a channel, linear Rec. 709 (sky_color.h); metres.
// Errors  of the sky's table: SkyView; of the air between points: 20 points a line of sight.
// Cost    making one: tables of Sky and SkyView. radiance(): 60 ns. sun(): 100 ns. between(): 50 us.
// Threads const: any number at once.
#pragma once

#include "renderer/color/rgb.h"
#include "renderer/math/vec3.h"
#include "renderer/parallel/thread_pool.h"
#include "renderer/sky/sky.h"
#include "renderer/sky/sky_color.h"
#include "renderer/sky/sky_view.h"

#include <cstddef>
#include <stop_token>
#include <vector>

namespace renderer {

// Rows from +y down, the centre column along -z, +x to its right.
struct SkyPanorama {
    std::size_t width = 0, height = 0;
    std::vector<Rgb> pixels;
};

class SkyLight {
public:
    // The description has no faults (check_atmosphere).
    SkyLight(const AtmosphereDescription& description, ThreadPool& pool, std::stop_token stop = {});

    // From the world's origin; `direction` is a unit vector. Without the sun's disk.
    [[nodiscard]] Rgb radiance(Vec3d direction) const;
    // Of the sun's disk behind the air, 0 beside it and where the ground hides it.
    [[nodiscard]] Rgb sun_radiance(Vec3d direction) const;

    [[nodiscard]] Vec3d sun_direction() const { return to_sun_; }
    [[nodiscard]] double sun_radius_rad() const { return sun_radius_; }
    // On a surface that faces the sun, at the world's origin; 0 where the ground hides the sun's centre.
    [[nodiscard]] Rgb sun_irradiance() const;

    // What the air between two points lets through, and what it adds itself: the sun's light that it scatters once.
    // Points below the ground are taken as on it.
    struct Between {
        Rgb transmittance{1, 1, 1}, added{};
    };
    [[nodiscard]] Between between(Vec3d from, Vec3d to) const;

    // Centres of pixels; without the sun's disk.
    [[nodiscard]] SkyPanorama panorama(std::size_t width, std::size_t height, ThreadPool& pool) const;

    [[nodiscard]] const Sky& sky() const { return sky_; }

private:
    [[nodiscard]] double limb(double share_of_radius2) const;

    Sky sky_;
    SkyColor color_;
    double altitude_, sun_radius_;
    bool limb_darkening_;
    Vec3d to_sun_;
    double sun_x_ = 0, sun_z_ = -1; // its azimuth, also where it is in the zenith
    SkyView view_;
};

} // namespace renderer
