#include "renderer/integrators/path.h"

#include "renderer/color/strongest.h"
#include "renderer/integrators/direct_lighting.h"
#include "renderer/integrators/surface_step.h"
#include "renderer/math/uninitialized.h"
#include "renderer/sampling/hemisphere_kernels.h"
#include "renderer/sampling/sampler_kernels.h"

#include <algorithm>
#include <limits>

namespace renderer {

namespace {

// Scatterings before a path may end by chance: the first ones carry most of what is to be seen.
constexpr std::uint32_t kSureScatterings = 3;
// A path that loses nothing still has to end.
constexpr float kMostSurvival = 0.98f;

struct Path {
    Ray ray;
    Rgb weight{1, 1, 1}; // what of the light it finds reaches the camera
    const CameraSample* of = nullptr;
    std::size_t sample = 0;  // of the run
    std::uint32_t depth = 0; // scatterings so far
    double pdf = 0; // of its last direction; 0: no light was sampled there, what it finds counts in full
    Vec3d from{};   // the last scattering
    bool is_indirect = false; // it has been scattered by more than mirrors and panes
    Media media{};
};

// A path that has met a surface and may go on from it.
struct Turn {
    Path* path;
    const SceneHit* hit;
    Surface surface;
    BsdfRoom room; // of its material where a picture gives it
    Vec3f wo;
    Bsdf glass;  // of a boundary: with its eta; surface.bsdf points here
    bool passes; // unbent, since it is no boundary where it is met
};

class PathRun {
public:
    PathRun(const Scene& scene,
            const PathLimits& limits,
            std::span<Rgb> radiance,
            RayTally& tally,
            const std::stop_token& stop)
        : scene_(scene), limits_(limits), radiance_(radiance), tally_(tally), stop_(stop)
    {
    }

    void run(std::span<const CameraSample> samples, FirstHits first)
    {
        for (std::size_t i = 0; i < samples.size(); ++i) {
            paths_[i] = Path{
                .ray = samples[i].ray, .of = &samples[i], .sample = i, .media = scene_.media_at_camera()};
            alive_[i] = &paths_[i];
            radiance_[i] = {};
        }
        count_ = samples.size();
        if (count_ == 0 || stop_.stop_requested()) return;
        const std::uint64_t met = step(RayKind::camera);
        note_first_hits(scene_, samples, hits_.first(samples.size()), met, first);
        while (count_ != 0 && !stop_.stop_requested())
            step(RayKind::other);
    }

private:
    void add(const Path& path, Rgb light)
    {
        Rgb arrives = path.weight * light;
        if (path.is_indirect && strongest(arrives) > limits_.clamp) {
            ++tally_.clamped;
            arrives = arrives * (limits_.clamp / strongest(arrives));
        }
        radiance_[path.sample] += arrives;
    }

    void add_background(const Path& path)
    {
        if (path.pdf > 0 && limits_.search == LightSearch::lights) return; // it was asked for
        const bool in_full = limits_.search == LightSearch::material;
        add(path, background(scene_, path.ray.direction, in_full ? 0 : path.pdf));
    }

    // Every path by one ray, and on. Which of them met something.
    std::uint64_t step(RayKind kind)
    {
        for (std::size_t i = 0; i < count_; ++i)
            rays_[i] = alive_[i]->ray;
        (kind == RayKind::camera ? tally_.camera_rays : tally_.bounce_rays) += count_;
        const std::uint64_t met = scene_.closest_hits(rays_.first(count_), hits_.first(count_), kind);
        turns_ = 0;
        for (std::size_t i = 0; i < count_; ++i)
            if ((met >> i & 1) != 0)
                arrive(*alive_[i], hits_[i]);
            else
                add_background(*alive_[i]);
        light();
        go_on();
        return met;
    }

    // What shines at a surface, and whether the path turns there.
    void arrive(Path& path, const SceneHit& hit)
    {
        const Vec3d toward_viewer = -path.ray.direction;
        Turn& turn = turn_[turns_];
        // What is seen after a bounce is not filtered: scattering has spread it over the samples.
        const double width = path.depth == 0 ? scene_.camera().width_at(hit.t) : 0;
        turn.surface = scene_.surface_at(hit, toward_viewer, &turn.room, width);
        if (path.media.here() != nullptr)
            path.weight = path.weight * transmittance(path.media, hit.t);
        else if (!path.is_indirect && scene_.sky() != nullptr)
            add_air(path, hit.t);
        const Bsdf& bsdf = *turn.surface.bsdf;
        if (!is_black(bsdf.emission)) {
            add(path, bsdf.emission * static_cast<float>(share_of_emission(path, hit)));
        }
        if (!is_black(bsdf.ambient)) add(path, bsdf.ambient);
        if (path.depth >= limits_.max_depth || bsdf.kind == BsdfKind::black) return;
        turn.path = &path;
        turn.passes = false;
        if (transmits(bsdf)) set_boundary(turn, hit);
        turn.hit = &hit;
        turn.wo = turn.surface.shading.to_local(to_float(toward_viewer));
        ++turns_;
    }

    void add_air(Path& path, double distance)
    {
        const SkyLight::Between air = air_before(scene_, path.ray, distance);
        add(path, air.added);
        path.weight = path.weight * air.transmittance;
    }

    double share_of_emission(const Path& path, const SceneHit& hit) const
    {
        if (!(path.pdf > 0) || limits_.search == LightSearch::material) return 1;
        return limits_.search == LightSearch::lights ? 0 : emitter_weight(scene_, path.from, path.pdf, hit);
    }

    void set_boundary(Turn& turn, const SceneHit& hit)
    {
        turn.glass = *turn.surface.bsdf;
        const Media::Boundary boundary =
            turn.path->media.boundary(scene_.body_at(hit), turn.glass.medium, turn.surface.is_outside);
        turn.glass.eta = boundary.eta;
        turn.surface.bsdf = &turn.glass;
        turn.passes = !boundary.is_real;
    }

    void light()
    {
        std::size_t lit = 0;
        for (std::size_t i = 0; i < turns_; ++i) {
            Turn& turn = turn_[i];
            if (turn.passes || is_delta_only(*turn.surface.bsdf)) continue;
            points_[lit] = {&turn.surface, turn.wo, turn.path->of, turn.path->depth};
            of_point_[lit] = turn.path;
            added_[lit++] = {};
        }
        if (limits_.search == LightSearch::material) return;
        const bool both = limits_.search == LightSearch::both;
        DirectLighting(scene_, both, tally_, stop_).gather(points_.first(lit), added_.first(lit));
        for (std::size_t i = 0; i < lit; ++i)
            add(*of_point_[i], added_[i]);
    }

    // The next ray of each path that goes on; the others leave the run.
    void go_on()
    {
        std::size_t diffuse = 0;
        for (std::size_t i = 0; i < turns_; ++i)
            if (is_diffuse(turn_[i])) {
                const Path& path = *turn_[i].path;
                pairs_.set(diffuse++, *path.of->sampler, path.of->number, direction_dimension(path));
            }
        draw_pairs()(pairs_, numbers_.first(diffuse));
        draw_in_hemisphere()(numbers_.first(diffuse), drawn_.first(diffuse));
        diffuse = 0;
        std::size_t kept = 0;
        for (std::size_t i = 0; i < turns_; ++i) {
            Turn& turn = turn_[i];
            const bool goes_on = turn.passes ? pass(turn)
                                 : is_diffuse(turn)
                                     ? scatter(turn, diffuse_sample(*turn.surface.bsdf, drawn_[diffuse++]))
                                     : scatter(turn, draw(turn));
            if (goes_on) alive_[kept++] = turn.path;
        }
        count_ = kept;
    }

    static bool is_diffuse(const Turn& turn) { return turn.surface.bsdf->kind == BsdfKind::diffuse; }
    static std::uint32_t direction_dimension(const Path& path)
    {
        return dimension_of(path.depth, ScatteringDimension::direction);
    }
    static BsdfSample draw(const Turn& turn)
    {
        const Path& path = *turn.path;
        const float u_lobe = path.of->one(dimension_of(path.depth, ScatteringDimension::lobe));
        return sample(*turn.surface.bsdf, turn.wo, u_lobe, path.of->two(direction_dimension(path)));
    }

    bool pass(Turn& turn)
    {
        Path& path = *turn.path;
        path.media.cross(scene_.body_at(*turn.hit), turn.glass.medium, turn.surface.is_outside);
        path.ray = Ray{offset_origin(turn.surface.point, path.ray.direction), path.ray.direction};
        return true;
    }

    bool scatter(Turn& turn, const BsdfSample& drawn)
    {
        Path& path = *turn.path;
        const Bsdf& bsdf = *turn.surface.bsdf;
        if (!(drawn.pdf > 0) || is_black(drawn.weight)) return false;
        Vec3d way;
        if (drawn.is_delta) {
            way = drawn.is_transmission
                      ? refracted(turn.surface, path.ray.direction, static_cast<double>(bsdf.eta))
                      : reflected(turn.surface, path.ray.direction);
        } else {
            way = to_double(turn.surface.shading.to_world(drawn.wi));
        }
        // A shading normal may send it through the surface, or back into it: that light is not there.
        if ((dot(turn.surface.geometric, to_float(way)) > 0) == drawn.is_transmission) return false;
        path.weight = path.weight * drawn.weight;
        if (!survives(path)) return false;
        if (drawn.is_transmission)
            path.media.cross(scene_.body_at(*turn.hit), bsdf.medium, turn.surface.is_outside);
        path.pdf = drawn.is_delta ? 0 : static_cast<double>(drawn.pdf);
        path.from = turn.surface.point.position;
        path.is_indirect = path.is_indirect || !drawn.is_delta;
        path.ray = Ray{offset_origin(turn.surface.point, way), way};
        ++path.depth;
        return true;
    }

    bool survives(Path& path) const
    {
        if (path.depth < kSureScatterings) return true;
        const float carried = strongest(path.weight);
        const float most =
            limits_.max_depth == std::numeric_limits<std::uint32_t>::max() ? kMostSurvival : 1.0f;
        const float chance = std::min(carried, most);
        if (chance >= 1) return true;
        if (!(path.of->one(dimension_of(path.depth, ScatteringDimension::roulette)) < chance)) return false;
        path.weight = path.weight / chance;
        return true;
    }

    const Scene& scene_;
    const PathLimits& limits_;
    std::span<Rgb> radiance_;
    RayTally& tally_;
    const std::stop_token& stop_;
    std::size_t count_ = 0, turns_ = 0;
    Uninitialized<Path, kMostSamples> paths_;
    Path* alive_[kMostSamples]; // those that go on, the first count_
    Uninitialized<Ray, kMostSamples> rays_;
    Uninitialized<SceneHit, kMostSamples> hits_;
    Uninitialized<Turn, kMostSamples> turn_;
    Uninitialized<LitPoint, kMostSamples> points_;
    Path* of_point_[kMostSamples];
    Uninitialized<Rgb, kMostSamples> added_;
    // Of turns at diffuse surfaces: what they ask for, and the numbers that directions are drawn with.
    PairRun pairs_;
    Uninitialized<Sample2, kMostSamples> numbers_;
    Uninitialized<Vec3f, kMostSamples> drawn_;
};

} // namespace

void path_radiance(const Scene& scene,
                   const PathLimits& limits,
                   std::span<const CameraSample> samples,
                   std::span<Rgb> radiance,
                   RayTally& tally,
                   const std::stop_token& stop,
                   FirstHits first)
{
    PathRun(scene, limits, radiance, tally, stop).run(samples, first);
}

} // namespace renderer
