#include "renderer/lights/sun_kernels.h"

#include "renderer/math/kernel_targets.h"

#include <vector>

// This file is compiled once for every target of Highway; what is above, for the baseline alone.
// clang-format off
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "renderer/lights/sun_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "renderer/math/transcendental_lanes-inl.h"
#include "renderer/math/vec3_lanes-inl.h"
#include "renderer/sampling/sample2_lanes-inl.h"
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace renderer::HWY_NAMESPACE {
namespace {

using D = hn::CappedTag<double, 8>;
using V = hn::Vec<D>;
constexpr std::size_t kLanes = hn::MaxLanes(D());

// sun.cpp's sample().
HWY_INLINE Vec3Lanes<V> draw(const Sun& sun, V u0, V u1)
{
    const D d;
    const V off = hn::Mul(u0, hn::Set(d, sun.one_minus_cosine));
    const V sine = hn::Sqrt(most(d, hn::Zero(d), hn::Mul(off, hn::Sub(hn::Set(d, 2), off))));
    const SineCosine<D> around = sin_cos(d, hn::Mul(hn::Set(d, 2 * kPi), u1));
    const Vec3Lanes<V> across =
        add(times(splat(d, sun.across), around.cosine), times(splat(d, sun.upward), around.sine));
    const Vec3Lanes<V> ahead = times(splat(d, sun.toward), hn::Sub(hn::Set(d, 1), off));
    return normalize(add(ahead, times(across, sine)));
}

void draw_all(const Sun& sun, std::span<const Sample2> u, std::span<Vec3d> out)
{
    const D d;
    alignas(64) double x[kLanes], y[kLanes], z[kLanes];
    for_lanes_of(d, u, [&](std::size_t first, std::size_t count, V u0, V u1) HWY_ATTR {
        const Vec3Lanes<V> toward = draw(sun, u0, u1);
        hn::Store(toward.x, d, x);
        hn::Store(toward.y, d, y);
        hn::Store(toward.z, d, z);
        for (std::size_t i = 0; i < count; ++i)
            out[first + i] = {x[i], y[i], z[i]};
    });
}

} // namespace

DrawTowardsSun sun_drawing()
{
    return draw_all;
}

} // namespace renderer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace renderer {

std::span<const DrawTowardsSun> all_draw_towards_sun()
{
    static const std::vector<DrawTowardsSun> usable = HELIOGRAPH_USABLE_KERNELS(DrawTowardsSun, sun_drawing);
    return usable;
}

DrawTowardsSun draw_towards_sun()
{
    static const DrawTowardsSun best = all_draw_towards_sun().front();
    return best;
}

} // namespace renderer
#endif // HWY_ONCE
