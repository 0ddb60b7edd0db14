#include "renderer/trace.h"

#include "renderer/integrators/direct.h"
#include "renderer/integrators/path.h"
#include "renderer/integrators/probes.h"
#include "renderer/integrators/whitted.h"
#include "renderer/math/uninitialized.h"
#include "renderer/sampling/sampler_kernels.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

namespace renderer {

namespace {

bool is_finite(Rgb c)
{
    return std::isfinite(c.r) && std::isfinite(c.g) && std::isfinite(c.b);
}

// Pixels whose samples are traced together: their rays run alike.
constexpr std::uint32_t kBlock = 4;

// Collects samples into runs, and what they find into the sums of their pixels, in the order of arrival.
class SampleRuns {
public:
    SampleRuns(const Scene& scene, const Plan& plan, const std::stop_token& stop, TracedUnit& out)
        : scene_(scene), plan_(plan), stop_(stop), out_(out), first_(plan.layers.empty() ? 0 : kMostSamples)
    {
    }

    void add(const PixelSampler& sampler,
             std::uint32_t x,
             std::uint32_t y,
             std::uint32_t number,
             std::size_t pixel)
    {
        samples_[count_].sampler = &sampler;
        samples_[count_].number = number;
        places_[count_] = {x, y, pixel};
        if (++count_ == kMostSamples) flush();
    }

    // Samplers that were given are no longer looked at.
    void flush()
    {
        Rgb found[kMostSamples];
        set_rays();
        if (!stop_.stop_requested()) radiance_of(found);
        stopped_ = stop_.stop_requested(); // for every run: without trees one may take long
        for (std::size_t i = 0; i < count_ && !stopped_; ++i) {
            if (is_finite(found[i]))
                out_.sums.sums[places_[i].pixel] += found[i];
            else
                ++out_.tally.non_finite_samples;
        }
        if (!first_.empty() && !stopped_) add_layers();
        count_ = 0;
    }

    bool stopped() const { return stopped_; } // what there is may be incomplete

private:
    void draw(Dimension dimension, std::span<Sample2> out)
    {
        PairRun run;
        for (std::size_t i = 0; i < count_; ++i)
            run.set(i, *samples_[i].sampler, samples_[i].number, static_cast<std::uint32_t>(dimension));
        draw_pairs()(run, out);
    }

    void set_rays()
    {
        const Camera& camera = scene_.camera();
        const bool needs_lens = camera.needs_lens();
        Uninitialized<Sample2, kMostSamples> jitter, lens;
        draw(Dimension::pixel, jitter.first(count_));
        if (needs_lens) draw(Dimension::lens, lens.first(count_));
        for (std::size_t i = 0; i < count_; ++i)
            samples_[i].ray = camera.ray(places_[i].x + static_cast<double>(jitter[i].u0),
                                         places_[i].y + static_cast<double>(jitter[i].u1),
                                         needs_lens ? lens[i] : Sample2{});
    }

    void add_layers()
    {
        for (std::size_t i = 0; i < count_; ++i)
            if (const FirstHit& hit = first_[i]; hit.is_there)
                out_.sums.layers.add(places_[i].pixel, hit.distance_m, hit.normal, hit.albedo);
    }

    void radiance_of(std::span<Rgb> found)
    {
        const std::span<const CameraSample> samples(samples_, count_);
        RayTally& tally = out_.tally;
        switch (plan_.integrator) {
        case Integrator::direct:
            return direct_radiance(scene_, samples, found, tally, stop_, first_);
        case Integrator::whitted:
            return whitted_radiance(scene_, plan_.max_depth, samples, found, tally, stop_, first_);
        case Integrator::path:
            return path_radiance(
                scene_, {plan_.max_depth, plan_.clamp}, samples, found, tally, stop_, first_);
        case Integrator::ambient_occlusion:
            return occlusion_radiance(scene_, samples, found, tally, stop_, first_);
        case Integrator::normals:
            return normals_radiance(scene_, samples, found, tally, stop_, first_);
        }
    }

    const Scene& scene_;
    const Plan& plan_;
    const std::stop_token& stop_;
    TracedUnit& out_;
    bool stopped_ = false;
    std::size_t count_ = 0;
    struct Place {
        std::uint32_t x, y; // in the picture
        std::size_t pixel;  // of the tile
    };
    CameraSample samples_[kMostSamples];
    Place places_[kMostSamples];
    std::vector<FirstHit> first_; // where layers are asked for
};

// The slice of one block of the tile, sample by sample, so that a pixel's samples add up in their order.
void trace_block(
    SampleRuns& runs, std::uint64_t seed, const PixelRect& tile, const PixelRect& block, SampleRange slice)
{
    std::optional<PixelSampler> samplers[kBlock * kBlock];
    for (std::uint32_t y = 0; y < block.height; ++y)
        for (std::uint32_t x = 0; x < block.width; ++x)
            samplers[y * kBlock + x].emplace(seed, block.x + x, block.y + y);
    for (std::uint32_t s = slice.first; s < slice.end && !runs.stopped(); ++s)
        for (std::uint32_t y = 0; y < block.height; ++y)
            for (std::uint32_t x = 0; x < block.width; ++x) {
                const std::size_t pixel =
                    std::size_t{block.y + y - tile.y} * tile.width + (block.x + x - tile.x);
                runs.add(*samplers[y * kBlock + x], block.x + x, block.y + y, s, pixel);
            }
    runs.flush();
}

} // namespace

std::optional<TracedUnit> trace(const Scene& scene,
                                const Plan& plan,
                                std::uint64_t seed,
                                const WorkUnit& unit,
                                const std::stop_token& stop)
{
    const PixelRect& tile = unit.tile;
    const std::size_t pixels = std::size_t{tile.width} * tile.height;
    TracedUnit out{{tile, std::vector<RgbSum>(pixels), LayerSums(plan.layers, pixels)}, {}};
    SampleRuns runs(scene, plan, stop, out);
    for (std::uint32_t y = 0; y < tile.height; y += kBlock) {
        for (std::uint32_t x = 0; x < tile.width; x += kBlock) {
            const PixelRect block{
                tile.x + x, tile.y + y, std::min(kBlock, tile.width - x), std::min(kBlock, tile.height - y)};
            trace_block(runs, seed, tile, block, unit.slice);
            if (runs.stopped()) return std::nullopt;
        }
    }
    return out;
}

} // namespace renderer
