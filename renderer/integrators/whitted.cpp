#include "renderer/integrators/whitted.h"

#include "renderer/color/strongest.h"
#include "renderer/integrators/direct_lighting.h"
#include "renderer/integrators/surface_step.h"
#include "renderer/math/uninitialized.h"

#include <algorithm>
#include <vector>

namespace renderer {

namespace {

// Branches that are done and not yet forgotten: two mirrors may face each other for a million rays.
constexpr std::size_t kKept = 1024;

struct Branch {
    Ray ray;
    Rgb weight{1, 1, 1};
    const CameraSample* of = nullptr;
    std::size_t sample = 0;
    std::uint32_t depth = 0; // scatterings so far
    Media media{};
};

// The branches of all samples, generation by generation. Light is added to a sample in the order of its own branches,
// whichever others are in the run.
class TreeRun {
public:
    TreeRun(const Scene& scene,
            std::uint32_t max_depth,
            std::span<Rgb> radiance,
            RayTally& tally,
            const std::stop_token& stop)
        : scene_(scene), max_depth_(max_depth), radiance_(radiance), tally_(tally), stop_(stop)
    {
    }

    void run(std::span<const CameraSample> samples, FirstHits first)
    {
        for (std::size_t i = 0; i < samples.size(); ++i) {
            waiting_.push_back(
                {.ray = samples[i].ray, .of = &samples[i], .sample = i, .media = scene_.media_at_camera()});
            radiance_[i] = {};
        }
        RayKind kind = RayKind::camera;
        for (std::size_t done = 0; done < waiting_.size() && !stop_.stop_requested();) {
            const std::size_t count = std::min(waiting_.size() - done, kMostSamples);
            std::copy_n(waiting_.begin() + static_cast<std::ptrdiff_t>(done), count, branches_.data());
            const std::uint64_t met = follow(count, kind);
            // The samples are one run: no camera ray is left after it.
            if (kind == RayKind::camera)
                note_first_hits(scene_, samples, hits_.first(samples.size()), met, first);
            kind = RayKind::other;
            done += count;
            if (done < kKept || 2 * done < waiting_.size()) continue;
            waiting_.erase(waiting_.begin(), waiting_.begin() + static_cast<std::ptrdiff_t>(done));
            done = 0;
        }
    }

private:
    // Which of them met something.
    std::uint64_t follow(std::size_t count, RayKind kind)
    {
        for (std::size_t i = 0; i < count; ++i)
            rays_[i] = branches_[i].ray;
        (kind == RayKind::camera ? tally_.camera_rays : tally_.bounce_rays) += count;
        const std::uint64_t met = scene_.closest_hits(rays_.first(count), hits_.first(count), kind);
        std::size_t lit = 0;
        for (std::size_t i = 0; i < count; ++i) {
            found_[i] = {};
            if ((met >> i & 1) == 0)
                found_[i] = background(scene_, branches_[i].ray.direction, 0);
            else if (arrive(i))
                of_point_[lit++] = i;
        }
        for (std::size_t i = 0; i < lit; ++i) {
            const std::size_t branch = of_point_[i];
            points_[i] = {&surfaces_[branch], wo_[branch], branches_[branch].of, branches_[branch].depth};
            added_[i] = {};
        }
        DirectLighting(scene_, false, tally_, stop_).gather(points_.first(lit), added_.first(lit));
        for (std::size_t i = 0; i < lit; ++i)
            found_[of_point_[i]] += added_[i];
        for (std::size_t i = 0; i < count; ++i)
            radiance_[branches_[i].sample] += branches_[i].weight * found_[i];
        return met;
    }

    // What shines there, and the branches that go on. True if lights are to be asked.
    bool arrive(std::size_t i)
    {
        Branch& branch = branches_[i];
        const SceneHit& hit = hits_[i];
        const Vec3d toward_viewer = -branch.ray.direction;
        // What is seen in mirrors and through panes is not filtered.
        const double width = branch.depth == 0 ? scene_.camera().width_at(hit.t) : 0;
        Surface& surface = surfaces_[i] = scene_.surface_at(hit, toward_viewer, &rooms_[i], width);
        if (branch.media.here() != nullptr) {
            branch.weight = branch.weight * transmittance(branch.media, hit.t);
        } else if (scene_.sky() != nullptr) {
            const SkyLight::Between air = air_before(scene_, branch.ray, hit.t);
            radiance_[branch.sample] += branch.weight * air.added;
            branch.weight = branch.weight * air.transmittance;
        }
        found_[i] = surface.bsdf->emission + surface.bsdf->ambient;
        if (surface.bsdf->kind == BsdfKind::black) return false;
        wo_[i] = surface.shading.to_local(to_float(toward_viewer));
        if (transmits(*surface.bsdf)) {
            Bsdf& bsdf = glass_[i] = *surface.bsdf;
            surface.bsdf = &bsdf;
            const Media::Boundary boundary =
                branch.media.boundary(scene_.body_at(hit), bsdf.medium, surface.is_outside);
            bsdf.eta = boundary.eta;
            if (!boundary.is_real) {
                Branch through = branch;
                through.media.cross(scene_.body_at(hit), bsdf.medium, surface.is_outside);
                through.ray = Ray{offset_origin(surface.point, branch.ray.direction), branch.ray.direction};
                waiting_.push_back(through);
                return false;
            }
        }
        const DeltaLobes lobes = delta_lobes(*surface.bsdf, wo_[i]);
        for (std::size_t l = 0; l < lobes.count; ++l)
            grow(branch, hit, surface, lobes.lobes[l]);
        return branch.depth < max_depth_ && !is_delta_only(*surface.bsdf);
    }

    void grow(const Branch& from, const SceneHit& hit, const Surface& surface, const DeltaLobe& lobe)
    {
        const Bsdf& bsdf = *surface.bsdf;
        const Vec3d way = lobe.is_transmission
                              ? refracted(surface, from.ray.direction, static_cast<double>(bsdf.eta))
                              : reflected(surface, from.ray.direction);
        if ((dot(surface.geometric, to_float(way)) > 0) == lobe.is_transmission) return;
        Branch branch = from;
        branch.weight = from.weight * lobe.weight;
        const float carried = strongest(branch.weight);
        if (carried == 0) return;
        if (lobe.is_transmission) branch.media.cross(scene_.body_at(hit), bsdf.medium, surface.is_outside);
        if (from.depth >= max_depth_ || carried < kLeastWeight) {
            // Within glass of index n radiance is n^2 times what it came from.
            const double n =
                branch.media.here() != nullptr ? static_cast<double>(branch.media.here()->ior) : 1;
            tally_.cut_weight += static_cast<double>(carried) * n * n;
            return;
        }
        branch.ray = Ray{offset_origin(surface.point, way), way};
        ++branch.depth;
        waiting_.push_back(branch);
    }

    const Scene& scene_;
    std::uint32_t max_depth_;
    std::span<Rgb> radiance_;
    RayTally& tally_;
    const std::stop_token& stop_;
    std::vector<Branch> waiting_;
    Uninitialized<Branch, kMostSamples> branches_;
    Uninitialized<Ray, kMostSamples> rays_;
    Uninitialized<SceneHit, kMostSamples> hits_;
    Uninitialized<Surface, kMostSamples> surfaces_;
    BsdfRoom rooms_[kMostSamples]; // of materials where pictures give them
    Vec3f wo_[kMostSamples];
    Uninitialized<Bsdf, kMostSamples> glass_; // with the eta of its boundary
    Uninitialized<Rgb, kMostSamples> found_, added_;
    Uninitialized<LitPoint, kMostSamples> points_;
    std::size_t of_point_[kMostSamples];
};

} // namespace

void whitted_radiance(const Scene& scene,
                      std::uint32_t max_depth,
                      std::span<const CameraSample> samples,
                      std::span<Rgb> radiance,
                      RayTally& tally,
                      const std::stop_token& stop,
                      FirstHits first)
{
    TreeRun(scene, max_depth, radiance, tally, stop).run(samples, first);
}

} // namespace renderer
