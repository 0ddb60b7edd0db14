#include "renderer/sky/sky.h"

#include "renderer/sky/optical_depth.h"

namespace renderer {

GridResolution resolution_of(SkyPrecision precision)
{
    if (precision == SkyPrecision::exact) return {};
    return {.altitudes = 18,
            .sun_step_deg = 0.6,
            .sky = 12,
            .down = 6,
            .azimuths = 11,
            .out_angles = 25,
            .points = 10};
}

Sky::Sky(const AtmosphereDescription& description, ThreadPool& pool, const std::stop_token& stop)
    : air_(make_air(description)),
      precision_(description.mode == SkyMode::fast ? SkyPrecision::quick : SkyPrecision::exact),
      columns_(std::make_unique<ColumnTable>(air_, pool))
{
    if (description.scattering == SkyScattering::multiple)
        scattered_ = std::make_unique<ScatteredLight>(air_, *columns_, resolution_of(precision_), pool, stop);
}

SkyRadiance Sky::radiance(const SkyGeometry& geometry) const
{
    return radiance(PlanetRay(air_.radius_m, geometry.altitude_m, geometry.mu), geometry);
}

SkyRadiance Sky::radiance(const PlanetRay& ray, const SkyGeometry& geometry) const
{
    const SingleScattering once = single_scattering(air_, ray, geometry, precision_);
    SkyRadiance result{once.air, {}, once.hits_ground};
    for (std::size_t w = 0; w < air_.wavelengths; ++w)
        result.single[w] += once.ground[w];
    if (scattered_)
        result.multiple = scattered_->radiance(scattered_->path(ray), geometry.mu_sun, geometry.nu);
    return result;
}

Spectrum Sky::transmittance(double altitude, double mu) const
{
    Spectrum result{};
    WayOut out;
    if (precision_ == SkyPrecision::exact || altitude >= air_.height_m) {
        out = columns_to_top(air_, altitude, mu);
    } else {
        out.blocked = PlanetRay(air_.radius_m, altitude, mu).hits_ground();
        out.columns = columns_->at(altitude, mu);
    }
    for (std::size_t w = 0; w < air_.wavelengths && !out.blocked; ++w)
        result[w] = air_.transmittance(w, out.columns);
    return result;
}

SkyIrradiance Sky::irradiance(double altitude, double mu_sun) const
{
    return sky_irradiance(air_, scattered_.get(), altitude, mu_sun, precision_);
}

} // namespace renderer
