#include "renderer/trace.h"

#include <cmath>

namespace renderer {

namespace {

bool is_finite(Rgb c)
{
    return std::isfinite(c.r) && std::isfinite(c.g) && std::isfinite(c.b);
}

Rgb radiance(const Scene& scene,
             const Plan& plan,
             const Ray& ray,
             const PixelSampler& sampler,
             std::uint32_t sample,
             RayTally& tally)
{
    switch (plan.transport) {
    case TransportType::automatic: // make_plan has chosen: direct is what there is
    case TransportType::direct:
        return direct_radiance(scene, ray, sampler, sample, tally);
    }
    return {};
}

RgbSum pixel_sum(const Scene& scene,
                 const Plan& plan,
                 std::uint64_t seed,
                 std::uint32_t x,
                 std::uint32_t y,
                 SampleRange slice,
                 RayTally& tally)
{
    const PixelSampler sampler(seed, x, y);
    RgbSum sum;
    for (std::uint32_t s = slice.first; s < slice.end; ++s) {
        const Sample2 jitter = sampler.sample_2d(s, static_cast<std::uint32_t>(Dimension::pixel));
        const Vec3d direction =
            scene.camera().direction(x + static_cast<double>(jitter.u0), y + static_cast<double>(jitter.u1));
        const Rgb c = radiance(scene, plan, Ray{scene.camera().position(), direction}, sampler, s, tally);
        if (is_finite(c))
            sum += c;
        else
            ++tally.non_finite_samples;
    }
    return sum;
}

} // namespace

std::optional<TracedUnit> trace(const Scene& scene,
                                const Plan& plan,
                                std::uint64_t seed,
                                const WorkUnit& unit,
                                const std::stop_token& stop)
{
    TracedUnit out{{unit.tile, {}}, {}};
    out.sums.sums.reserve(std::size_t{unit.tile.width} * unit.tile.height);
    for (std::uint32_t y = unit.tile.y; y < unit.tile.y + unit.tile.height; ++y) {
        if (stop.stop_requested()) return std::nullopt;
        for (std::uint32_t x = unit.tile.x; x < unit.tile.x + unit.tile.width; ++x)
            out.sums.sums.push_back(pixel_sum(scene, plan, seed, x, y, unit.slice, out.tally));
    }
    return out;
}

} // namespace renderer
