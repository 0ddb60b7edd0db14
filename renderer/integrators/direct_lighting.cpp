#include "renderer/integrators/direct_lighting.h"

#include "renderer/lights/sun_kernels.h"

#include <limits>

namespace renderer {

namespace {

// A shadow ray stops this share of its way short of the light, so that a light that lies in a surface is not
// shadowed by it.
constexpr double kShadowEnd = 1 - 0x1p-20;

} // namespace

std::span<const Sample2>
DirectLighting::draw(std::span<const LitPoint> points, ScatteringDimension which, std::uint32_t listed)
{
    for (std::size_t i = 0; i < points.size(); ++i) {
        const CameraSample& of = *points[i].of;
        pairs_.set(i, *of.sampler, of.number, dimension_of(points[i].scattering, which, listed));
    }
    const std::span<Sample2> drawn = numbers_.first(points.size());
    draw_pairs()(pairs_, drawn);
    return drawn;
}

void DirectLighting::add(const LitPoint& point, std::size_t i, const Arrival& arrival)
{
    if (is_black(arrival.radiance)) return;
    const Vec3f wi = to_float(arrival.wi), local = point.surface->shading.to_local(wi);
    if (!point.agrees(wi, local)) return;
    Rgb light = arrival.radiance;
    Rgb f;
    if (arrival.pdf == 0 || !mis_) {
        f = eval(*point.surface->bsdf, point.wo, local);
        if (arrival.pdf > 0) light = light * static_cast<float>(1 / arrival.pdf);
    } else {
        const BsdfValue value = evaluate(*point.surface->bsdf, point.wo, local);
        f = value.f;
        light = light * static_cast<float>(power_heuristic(arrival.pdf, static_cast<double>(value.pdf)) /
                                           arrival.pdf);
    }
    if (is_black(f)) return;
    rays_[count_] = Ray{offset_origin(point.surface->point, arrival.wi), arrival.wi, 0, arrival.distance};
    light_[count_] = f * light;
    point_[count_++] = i;
}

void DirectLighting::arrive(std::span<Rgb> added)
{
    if (count_ == 0) return;
    tally_.shadow_rays += count_;
    const std::uint64_t shadowed = scene_.any_hits(rays_.first(count_));
    for (std::size_t i = 0; i < count_; ++i)
        if ((shadowed >> i & 1) == 0) added[point_[i]] += light_[i];
    count_ = 0;
}

void DirectLighting::add_delta(const LitPoint& point,
                               std::size_t i,
                               const PreparedLight& light,
                               double chance)
{
    const LightSample s = illuminate(light, point.surface->point.position);
    add(point, i, {s.wi, s.distance * kShadowEnd, s.irradiance * static_cast<float>(1 / chance), 0});
}

void DirectLighting::add_sun(std::span<const LitPoint> points, const Sun& sun, std::uint32_t number)
{
    Uninitialized<Vec3d, kMostSamples> toward;
    draw_towards_sun()(sun, draw(points, ScatteringDimension::listed, number), toward.first(points.size()));
    for (std::size_t i = 0; i < points.size(); ++i)
        add(points[i], i, {toward[i], std::numeric_limits<double>::infinity(), sun.radiance, sun.pdf});
}

void DirectLighting::add_map(std::span<const LitPoint> points, const EnvironmentMap& map)
{
    const std::span<const Sample2> u = draw(points, ScatteringDimension::environment);
    for (std::size_t i = 0; i < points.size(); ++i) {
        const EnvironmentMap::Sample s = map.sample(u[i]);
        if (s.pdf > 0) add(points[i], i, {s.wi, std::numeric_limits<double>::infinity(), s.radiance, s.pdf});
    }
}

void DirectLighting::add_emitter(std::span<const LitPoint> points,
                                 const Emitter& emitter,
                                 std::uint32_t number)
{
    Uninitialized<Vec3d, kMostSamples> at;
    Uninitialized<EmitterSample, kMostSamples> drawn;
    for (std::size_t i = 0; i < points.size(); ++i)
        at[i] = points[i].surface->point.position;
    sample_many(emitter,
                at.first(points.size()),
                draw(points, ScatteringDimension::listed, number),
                drawn.first(points.size()));
    for (std::size_t i = 0; i < points.size(); ++i)
        add(points[i], i, emitter, drawn[i], 1);
}

void DirectLighting::add(
    const LitPoint& point, std::size_t i, const Emitter& emitter, const EmitterSample& s, double chance)
{
    if (s.distance > 0) add(point, i, {s.wi, s.distance * kShadowEnd, emitter.radiance, s.pdf * chance});
}

void DirectLighting::add_picked(const LitPoint& point, std::size_t i)
{
    const float u = point.of->one(dimension_of(point.scattering, ScatteringDimension::pick));
    const LightTree::Pick pick =
        scene_.light_tree().pick(point.surface->point.position, static_cast<double>(u));
    if (!(pick.probability > 0)) return;
    if (const PreparedLight* const light = scene_.picked_light(pick.light))
        return add_delta(point, i, *light, pick.probability);
    const Emitter& emitter = scene_.emitters()[pick.light];
    const Sample2 numbers = point.of->two(dimension_of(point.scattering, ScatteringDimension::picked));
    add(point, i, emitter, sample(emitter, point.surface->point.position, numbers), pick.probability);
}

// One direction drawn by the material: as good as any for light that is the same from everywhere.
void DirectLighting::add_environment_color(const LitPoint& point, std::size_t i)
{
    const float u_lobe = point.of->one(dimension_of(point.scattering, ScatteringDimension::lobe));
    const Sample2 u = point.of->two(dimension_of(point.scattering, ScatteringDimension::direction));
    const BsdfSample drawn = sample(*point.surface->bsdf, point.wo, u_lobe, u);
    if (is_black(drawn.weight) || drawn.is_delta) return;
    const Vec3f wi = point.surface->shading.to_world(drawn.wi);
    if (!point.agrees(wi, drawn.wi)) return;
    const Vec3d way = to_double(wi);
    rays_[count_] =
        Ray{offset_origin(point.surface->point, way), way, 0, std::numeric_limits<double>::infinity()};
    light_[count_] = drawn.weight * scene_.environment();
    point_[count_++] = i;
}

void DirectLighting::gather(std::span<const LitPoint> points, std::span<Rgb> added)
{
    // One kind of light for all points, then the next: shadow rays to one light run alike.
    const auto with = [&](auto&& add_all) {
        if (stop_.stop_requested()) return;
        add_all();
        arrive(added);
    };
    const auto for_all = [&](auto&& add_to) {
        with([&] {
            for (std::size_t i = 0; i < points.size(); ++i)
                add_to(points[i], i);
        });
    };
    for (const PreparedLight& light : scene_.lights())
        for_all([&](const LitPoint& point, std::size_t i) { add_delta(point, i, light, 1); });
    // Of very many suns some share their numbers, which does no harm: each is sampled rightly.
    constexpr std::uint32_t kMostNumbers =
        kOfScattering - static_cast<std::uint32_t>(ScatteringDimension::listed);
    std::uint32_t listed = 0;
    for (const Sun& sun : scene_.suns())
        with([&] { add_sun(points, sun, listed++ % kMostNumbers); });
    if (scene_.light_tree().empty())
        for (const Emitter& emitter : scene_.emitters())
            with([&] { add_emitter(points, emitter, listed++ % kMostNumbers); });
    else
        for_all([&](const LitPoint& point, std::size_t i) { add_picked(point, i); });
    if (const EnvironmentMap* const map = scene_.environment_map()) with([&] { add_map(points, *map); });
    if (!mis_ && !is_black(scene_.environment()))
        for_all([&](const LitPoint& point, std::size_t i) { add_environment_color(point, i); });
}

} // namespace renderer
