// SkyLight: what an atmosphere gives a renderer: the sky and the sun as lights, and the air before what is seen.
//
// Frame   the world's: right-handed, y up at the world's origin, which lies `altitude_m` above the ground; azimuth from -z
//         towards +x. The planet's centre is straight below the origin. Sky and sun are those of one place, the eye.
// Units   W/(m^2 sr) and W/m^2 a channel, linear Rec. 709 (sky_color.h); metres.
// Errors  of the sky's table: table_error(); of the air before things: AerialView.
// Cost    making one: tables of Sky (unless they are given), SkyView, AerialView. radiance(): 100 ns. air_before():
//         200 ns. between(): 0.3 ms.
// Threads const: any number at once.
#pragma once

#include "renderer/color/rgb.h"
#include "renderer/math/vec3.h"
#include "renderer/parallel/thread_pool.h"
#include "renderer/sky/aerial_view.h"
#include "renderer/sky/sky.h"
#include "renderer/sky/sky_color.h"
#include "renderer/sky/sky_view.h"

#include <cstddef>
#include <memory>
#include <optional>
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
    // The description has no faults (check_atmosphere). From the world's origin.
    SkyLight(const AtmosphereDescription& description, ThreadPool& pool, std::stop_token stop = {});
    // `sky` is that of the description. `far_m`: how far things are seen through the air; 0: air_before() is not asked.
    // `most_table_error`: what table_error() is to come to.
    SkyLight(const AtmosphereDescription& description,
             std::shared_ptr<const Sky> sky,
             Vec3d eye,
             double far_m,
             ThreadPool& pool,
             double most_table_error = kTableError);

    // From the eye; `direction` is a unit vector. Without the sun's disk.
    [[nodiscard]] Rgb radiance(Vec3d direction) const;
    // Of the sun's disk behind the air, 0 beside it and where the ground hides it.
    [[nodiscard]] Rgb sun_radiance(Vec3d direction) const;
    // The mean of that over the disk, of which the ground may hide a part.
    [[nodiscard]] Rgb mean_sun_radiance() const;

    [[nodiscard]] Vec3d sun_direction() const { return to_sun_; }
    [[nodiscard]] double sun_radius_rad() const { return sun_radius_; }
    // On a surface that faces the sun, at the eye; 0 where the ground hides the sun's centre.
    [[nodiscard]] Rgb sun_irradiance() const;

    // What the air between two points lets through, and what it adds itself: the sun's light that it scatters once.
    // Points below the ground are taken as on it.
    struct Between {
        Rgb transmittance{1, 1, 1}, added{};
    };
    [[nodiscard]] Between between(Vec3d from, Vec3d to) const;
    // The same, with all that was scattered more often, from the eye to `distance` in a unit direction; by look-up.
    [[nodiscard]] Between air_before(Vec3d direction, double distance) const;
    [[nodiscard]] bool has_air_before() const { return aerial_.has_value(); }

    // Centres of pixels; without the sun's disk. Of `finer` rows a pixel each is the mean by their solid angles.
    [[nodiscard]] SkyPanorama
    panorama(std::size_t width, std::size_t height, ThreadPool& pool, std::size_t finer = 1) const;

    [[nodiscard]] const Sky& sky() const { return *sky_; }
    [[nodiscard]] bool is_beyond_air() const { return altitude_ > sky_->air().height_m; } // the eye

    // Of radiance() against quadrature in 64 directions that have air or ground: root mean square over the mean, the
    // worst wavelength's. Rows and columns are doubled until it is what was asked for, twice at most.
    static constexpr double kTableError = 0.005; // where nothing else is asked for
    [[nodiscard]] double table_error() const { return table_error_; }

private:
    [[nodiscard]] double limb(double share_of_radius2) const;

    [[nodiscard]] double azimuth_cosine(Vec3d direction, double mu) const;
    void make_view(double most_error, ThreadPool& pool);
    [[nodiscard]] double error_of(const SkyView& view, ThreadPool& pool) const;

    std::shared_ptr<const Sky> sky_;
    SkyColor color_;
    double origin_altitude_, sun_radius_;
    bool limb_darkening_;
    Vec3d to_sun_;
    Vec3d up_, sunwards_; // at the eye: away from the planet's centre, and along the ground towards the sun
    double altitude_ = 0, mu_sun_ = 1;
    std::optional<SkyView> view_;
    double table_error_ = 0;
    std::optional<AerialView> aerial_;
};

} // namespace renderer
