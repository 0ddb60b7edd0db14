#include "renderer/lights/sun_kernels.h"

#include "renderer/math/kernel_targets.h"

#include <algorithm>
#include <vector>

// This file is compiled once for every target of Highway; what is above, for the baseline alone.
// clang-format off
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "renderer/lights/sun_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "renderer/math/transcendental_lanes-inl.h"
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace renderer::HWY_NAMESPACE {
namespace {

using D = hn::CappedTag<double, 8>;
using V = hn::Vec<D>;
constexpr std::size_t kLanes = hn::MaxLanes(D());

HWY_INLINE V set(double x)
{
    return hn::Set(D(), x);
}

HWY_INLINE void draw(const Sun& sun, const double* u0, const double* u1, double (&out)[3][kLanes])
{
    const D d;
    const V off = hn::Mul(hn::Load(d, u0), set(sun.one_minus_cosine));
    const V sine = hn::Sqrt(most(d, set(0), hn::Mul(off, hn::Sub(set(2), off))));
    const SineCosine<D> around = sin_cos(d, hn::Mul(set(2 * kPi), hn::Load(d, u1)));
    const V ahead = hn::Sub(set(1), off);
    V way[3];
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const V across = hn::Add(hn::Mul(set(sun.across[axis]), around.cosine),
                                 hn::Mul(set(sun.upward[axis]), around.sine));
        way[axis] = hn::Add(hn::Mul(set(sun.toward[axis]), ahead), hn::Mul(across, sine));
    }
    // normalize() scales first.
    V largest = most(d, hn::Abs(way[1]), hn::Abs(way[0]));
    largest = most(d, hn::Abs(way[2]), largest);
    for (V& along : way)
        along = hn::Div(along, largest);
    const V squares =
        hn::Add(hn::Add(hn::Mul(way[0], way[0]), hn::Mul(way[1], way[1])), hn::Mul(way[2], way[2]));
    const V length = hn::Sqrt(squares);
    for (std::size_t axis = 0; axis < 3; ++axis)
        hn::Store(hn::Div(way[axis], length), d, out[axis]);
}

void draw_all(const Sun& sun, std::span<const Sample2> u, std::span<Vec3d> out)
{
    alignas(64) double u0[kLanes], u1[kLanes], drawn[3][kLanes];
    for (std::size_t first = 0; first < u.size(); first += kLanes) {
        const std::size_t count = std::min(kLanes, u.size() - first);
        for (std::size_t i = 0; i < kLanes; ++i) {
            const Sample2& numbers = u[first + std::min(i, count - 1)];
            u0[i] = static_cast<double>(numbers.u0);
            u1[i] = static_cast<double>(numbers.u1);
        }
        draw(sun, u0, u1, drawn);
        for (std::size_t i = 0; i < count; ++i)
            out[first + i] = {drawn[0][i], drawn[1][i], drawn[2][i]};
    }
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
