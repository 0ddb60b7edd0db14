#include "renderer/render.h"

#include "renderer/meter.h"
#include "renderer/ordered_merge.h"
#include "renderer/plan/budget.h"
#include "renderer/tile_grid.h"
#include "renderer/trace.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <mutex>

namespace renderer {

namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start)
{
    return std::chrono::duration<double>(Clock::now() - start).count();
}

// Tells the sink, ten times a second at most; a thread that finds another one telling goes on with its work.
class Teller {
public:
    Teller(const ProgressSink& sink,
           std::uint32_t samples,
           std::optional<double> time_s,
           Clock::time_point start)
        : sink_(sink), samples_(samples), time_s_(time_s), start_(start), last_(start)
    {
    }

    void tell(double samples_done, std::uint32_t complete, bool at_end)
    {
        if (!sink_) return;
        std::unique_lock lock(mutex_, std::defer_lock);
        if (at_end)
            lock.lock();
        else if (!lock.try_lock())
            return;
        const auto now = Clock::now();
        if (!at_end && now - last_ < std::chrono::milliseconds(100)) return;
        last_ = now;
        const double by_samples = samples_done / samples_;
        const double by_time = time_s_ ? seconds_since(start_) / *time_s_ : 0;
        fraction_ = at_end ? 1 : std::clamp(std::max(by_samples, by_time), fraction_, 0.999);
        complete_ = std::max(complete_, complete); // a thread may come late with what it read earlier
        sink_({fraction_, complete_, passes_complete(complete_)});
    }

private:
    static std::uint32_t passes_complete(std::uint32_t samples)
    {
        const std::uint32_t begun = passes_for(samples);
        return begun != 0 && samples_of_pass(begun - 1).end > samples ? begun - 1 : begun;
    }

    const ProgressSink& sink_;
    double samples_;
    std::optional<double> time_s_;
    Clock::time_point start_, last_;
    double fraction_ = 0;
    std::uint32_t complete_ = 0;
    std::mutex mutex_;
};

// What is fixed during one render, and what grows.
class Job {
public:
    Job(const Scene& scene,
        const Plan& plan,
        const RenderSettings& settings,
        ThreadPool& pool,
        std::stop_token stop,
        const ProgressSink& progress)
        : scene_(scene), plan_(plan), settings_(settings), pool_(pool), stop_(std::move(stop)),
          film_(region_of(settings.image), plan.layers),
          bytes_a_pixel_(sizeof(RgbSum) + layer_sum_bytes(plan.layers)),
          grid_(film_.region,
                tile_side(settings.acceleration.tile_px,
                          kMergeBytes / bytes_a_pixel_ / kUnitsAThread / pool.size())),
          target_(target_of(settings.quality)), teller_(progress, target_, settings.quality.time_s, start_)
    {
    }

    std::optional<RenderResult> run()
    {
        StopReason reason = StopReason::samples;
        if (settings_.quality.time_s)
            reason = run_passes(*settings_.quality.time_s);
        else
            run_samples({0, target_});
        if (stop_.stop_requested()) return std::nullopt;
        teller_.tell(film_.samples, film_.samples, true);
        RenderReport told = report(reason); // before the film is given away
        return RenderResult{std::move(film_), std::move(told)};
    }

private:
    static PixelRect region_of(const ImageSettings& image)
    {
        return image.region.value_or(PixelRect{0, 0, image.width_px, image.height_px});
    }

    static std::uint32_t target_of(const QualitySettings& quality)
    {
        if (quality.samples) return *quality.samples;
        return quality.time_s ? std::max(1u, quality.max_samples) : kDefaultSamples;
    }

    // decide(): after each pass, is there time for the next one at the pace of the last?
    StopReason run_passes(double time_s)
    {
        for (std::uint32_t pass = 0; film_.samples < target_; ++pass) {
            const SampleRange all = samples_of_pass(pass);
            const SampleRange range{all.first, std::min(all.end, target_)};
            const double begun = seconds_since(start_);
            run_samples(range);
            if (stop_.stop_requested() || film_.samples >= target_) break;
            const double now = seconds_since(start_);
            const double next_pass = (now - begun) / range.count() * samples_of_pass(pass + 1).count();
            if (now + next_pass > time_s) return StopReason::time;
        }
        return StopReason::samples;
    }

    // All units of the range, slice by slice over all tiles, merged in that order.
    void run_samples(SampleRange range)
    {
        const std::size_t tiles = grid_.size();
        const std::uint32_t first_slice = slice_number(range.first),
                            slices = slice_number(range.end) - first_slice;
        const auto slice_of = [&](std::size_t number) {
            const SampleRange slice =
                samples_of_slice(first_slice + static_cast<std::uint32_t>(number / tiles));
            return SampleRange{slice.first, std::min(slice.end, range.end)};
        };
        const auto merge = [&](std::size_t number, const TracedUnit& unit) {
            film_.merge(unit.sums);
            tally_ += unit.tally;
            const SampleRange slice = slice_of(number);
            const double share = static_cast<double>(number % tiles + 1) / static_cast<double>(tiles);
            samples_done_ = slice.first + slice.count() * share;
            samples_complete_ = share < 1 ? slice.first : slice.end;
        };
        OrderedMerge<TracedUnit, decltype(merge)> results(0, window(), merge);
        const auto body = [&](std::size_t number, unsigned) {
            const WorkUnit unit{grid_.tile(number % tiles), slice_of(number)};
            trace_and_put(unit, number, results);
        };
        pool_.run(slices * tiles, body, stop_, settings_.acceleration.threads);
        film_.samples = range.end;
    }

    template <typename Results>
    void trace_and_put(const WorkUnit& unit, std::size_t number, Results& results)
    {
        try {
            std::optional<TracedUnit> traced = trace(scene_, plan_, settings_.seed, unit, stop_);
            if (!traced) return results.abort();
            results.put(number, std::move(*traced));
        } catch (...) { // out of memory: nobody may wait for this unit
            results.abort();
            throw;
        }
        teller_.tell(samples_done_, samples_complete_, false);
    }

    // Units that may wait for an older one; tiles are small enough that there is room for a few a thread.
    std::size_t window() const
    {
        const std::size_t bytes = grid_.largest_tile_pixels() * bytes_a_pixel_;
        return std::max(std::size_t{kUnitsAThread} * pool_.size(),
                        std::min(kMergeBytes / bytes, std::size_t{4096}));
    }

    RenderReport report(StopReason reason) const
    {
        RenderReport r;
        r.models = plan_.models;
        r.numerics = scene_.numerics();
        r.numerics.non_finite_samples = tally_.non_finite_samples;
        r.accuracy = {film_.samples, reason};
        r.timing.render_s = seconds_since(start_);
        r.timing.camera_rays = tally_.camera_rays;
        r.timing.shadow_rays = tally_.shadow_rays;
        r.timing.bounce_rays = tally_.bounce_rays;
        r.numerics.clamped = tally_.clamped;
        if (tally_.camera_rays != 0)
            r.numerics.cut_weight = tally_.cut_weight / static_cast<double>(tally_.camera_rays);
        if (scene_.camera().is_meter()) r.meter = read_meter(film_, scene_.camera().quantity());
        if (scene_.sky() != nullptr) r.sky = SkyReport{scene_.sky()->table_error()};
        r.geometry = scene_.geometry();
        const unsigned asked = settings_.acceleration.threads;
        r.threads = asked == 0 ? pool_.size() : std::min(asked, pool_.size());
        return r;
    }

    const Clock::time_point start_ = Clock::now();
    const Scene& scene_;
    const Plan& plan_;
    const RenderSettings& settings_;
    ThreadPool& pool_;
    std::stop_token stop_;
    Film film_;
    std::size_t bytes_a_pixel_; // of the sums of a unit
    TileGrid grid_;
    std::uint32_t target_;
    RayTally tally_;
    // Written under the merge's lock, read by whoever tells.
    std::atomic<double> samples_done_ = 0;
    std::atomic<std::uint32_t> samples_complete_ = 0;
    Teller teller_;
};

} // namespace

std::optional<RenderResult> render(const Scene& scene,
                                   const Plan& plan,
                                   const RenderSettings& settings,
                                   ThreadPool& pool,
                                   std::stop_token stop,
                                   const ProgressSink& progress)
{
    return Job(scene, plan, settings, pool, std::move(stop), progress).run();
}

} // namespace renderer
