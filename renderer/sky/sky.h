// Sky: an atmosphere made ready to be asked: the air, its tables, and how exact they are.
//
// Units   L / E0, as single_scattering.h: radiance over the sun's irradiance above the air.
// Cost    the columns' table takes 50 ms of a core; that of multiple scattering 11 s of a core for each four wavelengths
//         in mode exact, 1.5 s in mode fast, and nothing where scattering is single.
// Threads const: any number at once.
#pragma once

#include "renderer/parallel/thread_pool.h"
#include "renderer/sky/air.h"
#include "renderer/sky/column_table.h"
#include "renderer/sky/planet_ray.h"
#include "renderer/sky/scattered_light.h"
#include "renderer/sky/single_scattering.h"
#include "renderer/sky/sky_irradiance.h"

#include <memory>
#include <stop_token>

namespace renderer {

struct SkyRadiance {
    Spectrum single{};   // scattered once by the air, or by the ground that the sun lights
    Spectrum multiple{}; // everything else; 0 where scattering is single
    bool hits_ground = false;
};

class Sky {
public:
    // The description has no faults (check_atmosphere). Its mode `auto` is exact.
    Sky(const AtmosphereDescription& description, ThreadPool& pool, const std::stop_token& stop = {});

    [[nodiscard]] const Air& air() const { return air_; }
    [[nodiscard]] SkyPrecision precision() const { return precision_; }
    [[nodiscard]] const ColumnTable& columns() const { return *columns_; }
    [[nodiscard]] const ScatteredLight* scattered() const { return scattered_.get(); } // null: single

    [[nodiscard]] std::size_t size_bytes() const // of its tables
    {
        return columns_->size_bytes() + (scattered_ ? scattered_->size_bytes() : 0);
    }

    // The sun's disk is not in it.
    [[nodiscard]] SkyRadiance radiance(const SkyGeometry& geometry) const;
    [[nodiscard]] SkyRadiance radiance(const PlanetRay& ray, const SkyGeometry& geometry) const;
    // From a point to the top of the air, at each wavelength; 0 where the ground is in the way.
    [[nodiscard]] Spectrum transmittance(double altitude, double mu) const;
    [[nodiscard]] SkyIrradiance irradiance(double altitude, double mu_sun) const;

private:
    Air air_;
    SkyPrecision precision_;
    std::unique_ptr<const ColumnTable> columns_;
    std::unique_ptr<const ScatteredLight> scattered_;
};

// What tables of multiple scattering the two modes have.
GridResolution resolution_of(SkyPrecision precision);

} // namespace renderer
