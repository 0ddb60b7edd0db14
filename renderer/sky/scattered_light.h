// ScatteredLight: light that was scattered twice and more, everywhere in the air and for every sun.
//
// Kept is the source: what each place sends into each direction, of all orders together; a line of sight is summed
// up over it, so that eye, view and sun are free. Light that the ground reflects counts as an order of its own.
//
// Units   L / E0, 1/sr, as single_scattering.h; altitudes in metres.
// Source  the iteration over orders of Bruneton, Neyret 2008, algorithm 4.1; discrete directions and azimuthal series
//         instead of its four-dimensional table of radiance.
// Errors  against Monte Carlo: reference/sky_test.cpp.
// Memory  exact 27 MB for four wavelengths, thrice while it is built.
// Cost    building: 10 s of a core for four wavelengths (exact), a fifth of it (quick); then some 3 us a line of sight.
// Threads the same bits however many build it; const: any number at once.
#pragma once

#include "renderer/parallel/thread_pool.h"
#include "renderer/sky/air.h"
#include "renderer/sky/column_table.h"
#include "renderer/sky/lanes.h"
#include "renderer/sky/light_grid.h"
#include "renderer/sky/light_path.h"
#include "renderer/sky/scatter_kernel.h"
#include "renderer/sky/single_scattering.h"

#include <cstddef>
#include <limits>
#include <memory>
#include <stop_token>
#include <vector>

namespace renderer {

class ScatteredLight {
public:
    // `columns` are those of `air`. Once `stop` is requested the orders end early: throw the light away then.
    ScatteredLight(const Air& air,
                   const ColumnTable& columns,
                   const GridResolution& resolution,
                   ThreadPool& pool,
                   const std::stop_token& stop = {});

    // A line of sight, for radiance(): of use for every sun and azimuth. It ends `far_m` from the eye, if not sooner.
    [[nodiscard]] LightPath path(const PlanetRay& ray,
                                 double far_m = std::numeric_limits<double>::infinity()) const;
    // Of orders two and more, those of the ground included; mu_sun, nu at the path's start.
    [[nodiscard]] Spectrum radiance(const LightPath& path, double mu_sun, double nu) const;

    // Orders that were summed one by one; those beyond follow as a geometric series.
    [[nodiscard]] std::size_t orders() const { return orders_; }
    [[nodiscard]] std::size_t size_bytes() const;

private:
    // What the places send out, of one group of wavelengths.
    struct Source {
        std::vector<Moments> moments; // [altitude][sun]
        std::vector<Lanes> mie;    // [altitude][sun][zenith angle][azimuth]; empty where nothing scatters so
        std::vector<Lanes> ground; // radiance of the ground, [sun]
    };
    struct Site; // one altitude: directions, kernel, lines of sight
    using Sites = std::vector<std::unique_ptr<Site>>;
    struct Scratch;

    [[nodiscard]] Source empty_source() const;
    static Lanes sum_of(const Source& source);
    static void add(const Source& more, Lanes times, Source& to);
    void build(std::size_t group, const Sites& sites, ThreadPool& pool, const std::stop_token& stop);
    void
    light_from_sun(std::size_t group, const Site& site, std::size_t sun, std::vector<Lanes>& light) const;
    void light_from(const Source& source,
                    std::size_t group,
                    const Site& site,
                    std::size_t sun,
                    std::vector<Lanes>& light) const;
    void scatter(std::size_t group, const Site& site, std::size_t item, Scratch& scratch, Source& to) const;
    [[nodiscard]] Lanes
    gather(const Source& source, const LightPath& path, std::size_t group, double mu_sun, double nu) const;

    const Air& air_;
    const ColumnTable& columns_;
    LightGrid grid_;
    bool has_mie_ = false;
    std::vector<Lanes> albedo_over_pi_; // [group]
    std::vector<Source> total_;         // [group]
    std::size_t orders_ = 0;
};

} // namespace renderer
