// heliograph-bench sky: a panorama of 512 x 256 pixels of the sky, light scattered once, one thread: by look-up, with the
// making of its tables (cold) and without (warm), beside the plain march of 16 x 8 steps of which most programs' skies are
// made. Time of the processor; errors are relative, root mean square over directions above the horizon, against exact
// quadrature. The march does the upper half of the picture alone, where it has errors to be told; both are told in
// nanoseconds a direction besides, and their ratios are of those.
#include "renderer/math/transcendental.h"
#include "renderer/sky/sky_light.h"
#include "tests/bench/commands.h"
#include "tests/bench/spread.h"
#include "tests/bench/stopwatch.h"
#include "tests/support/random_numbers.h"
#include "tests/support/sky_march.h"

#include <cmath>
#include <cstdio>
#include <memory>
#include <vector>

namespace bench {

namespace {

using namespace renderer;

constexpr std::size_t kWidth = 512, kHeight = 256;

struct Error {
    double lookup = 0, march = 0;
};

Error errors(const SkyLight& light, double elevation, int directions)
{
    tests::RandomNumbers random(11);
    Error sum;
    for (int i = 0; i < directions; ++i) {
        const double mu = random.next(), azimuth = random.between(0, 180);
        const auto [side, ahead] = sin_cos_deg(azimuth);
        const double sine = std::sqrt(1 - mu * mu);
        SkyGeometry geometry = SkyGeometry::from_angles_deg(0, 90 - elevation, 0, 0);
        geometry.mu = mu;
        geometry.nu = mu * geometry.mu_sun + sine * std::sqrt(1 - geometry.mu_sun * geometry.mu_sun) * ahead;
        const Air& air = light.sky().air();
        const Spectrum exact = single_scattering(air, geometry, SkyPrecision::exact).air;
        const Spectrum march = tests::march(air, geometry, tests::MarchSteps::whole, 16, 8);
        const Rgb found = light.radiance({sine * side, mu, -sine * ahead});
        const double channels[] = {found.r, found.g, found.b};
        for (std::size_t w = 0; w < 3; ++w) {
            sum.lookup += (channels[w] / exact[w] - 1) * (channels[w] / exact[w] - 1);
            sum.march += (march[w] / exact[w] - 1) * (march[w] / exact[w] - 1);
        }
    }
    const double count = 3.0 * directions;
    return {std::sqrt(sum.lookup / count), std::sqrt(sum.march / count)};
}

double march_upper_half(const Air& air, double elevation)
{
    double sum = 0;
    for (std::size_t y = 0; y < kHeight / 2; ++y)
        for (std::size_t x = 0; x < kWidth; ++x)
            sum += tests::march(air,
                                SkyGeometry::from_angles_deg(0,
                                                             90 - elevation,
                                                             180 * (static_cast<double>(y) + 0.5) / kHeight,
                                                             360 * (static_cast<double>(x) + 0.5) / kWidth),
                                tests::MarchSteps::whole,
                                16,
                                8)[0];
    return sum;
}

void measure(double elevation, const SkyOptions& options)
{
    AtmosphereDescription description = atmosphere_preset(AtmospherePreset::reference_s);
    description.scattering = SkyScattering::single;
    description.sun.elevation_deg = elevation;
    description.sun.irradiance = {1, 1, 1};
    ThreadPool pool(1);
    std::vector<double> cold, warm, march;
    std::unique_ptr<SkyLight> light;
    double sink = 0;
    for (int i = 0; i < options.repeats; ++i) {
        const Stopwatch whole(CLOCK_THREAD_CPUTIME_ID);
        light = std::make_unique<SkyLight>(description, pool);
        const Stopwatch lookups(CLOCK_THREAD_CPUTIME_ID);
        const SkyPanorama picture = light->panorama(kWidth, kHeight, pool);
        warm.push_back(1e3 * lookups.spent().cpu_s);
        cold.push_back(1e3 * whole.spent().cpu_s);
        const Stopwatch naive(CLOCK_THREAD_CPUTIME_ID);
        sink += march_upper_half(light->sky().air(), elevation) + static_cast<double>(picture.pixels[0].r);
        march.push_back(1e3 * naive.spent().cpu_s);
    }
    const Error error = errors(*light, elevation, options.directions);
    const double w = spread_of(warm).median, c = spread_of(cold).median, m = spread_of(march).median;
    const double pixels = static_cast<double>(kWidth * kHeight), ns = 1e6 / pixels;
    std::printf("%9.0f %10.1f %10.2f %10.2f %10.0f %10.0f %10.1f %9.0fx %9.1fx %10.3f %% %10.2f %%%s\n",
                elevation,
                m,
                c,
                w,
                2 * m * ns,
                c * ns,
                w * ns,
                2 * m / w,
                2 * m / c,
                100 * error.lookup,
                100 * error.march,
                sink < 0 ? "!" : "");
}

} // namespace

void run_sky(const SkyOptions& options)
{
    std::printf("one processor, %zux%zu (the march: its upper half)\n"
                "%9s %10s %10s %10s %10s %10s %10s %10s %10s %12s %12s\n",
                kWidth,
                kHeight,
                "elevation",
                "march ms",
                "cold ms",
                "warm ms",
                "march ns",
                "cold ns",
                "warm ns",
                "warm",
                "cold",
                "rms",
                "march's rms");
    for (const double elevation : {60.0, 30.0, 10.0, 2.0})
        measure(elevation, options);
}

} // namespace bench
