#include "renderer/sampling/hemisphere_kernels.h"

#include "renderer/math/kernel_targets.h"

#include <vector>

// This file is compiled once for every target of Highway; what is above, for the baseline alone.
// clang-format off
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "renderer/sampling/hemisphere_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "renderer/math/transcendental_lanes-inl.h"
#include "renderer/sampling/sample2_lanes-inl.h"
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace renderer::HWY_NAMESPACE {
namespace {

using D = hn::CappedTag<double, 8>;
using V = hn::Vec<D>;
constexpr std::size_t kLanes = hn::MaxLanes(D());

struct DirectionLanes {
    alignas(64) float x[kLanes], y[kLanes], z[kLanes];
};

// warp.cpp says why.
HWY_INLINE void draw(V u0, V u1, DirectionLanes& out)
{
    const D d;
    const hn::Rebind<float, D> f;
    const auto set = [](double value) HWY_ATTR { return hn::Set(D(), value); };
    const V a = hn::Sub(hn::Mul(set(2), u0), set(1)), b = hn::Sub(hn::Mul(set(2), u1), set(1));
    const auto a_is_larger = hn::Gt(hn::Abs(a), hn::Abs(b));
    const V radius = hn::IfThenElse(a_is_larger, a, b), other = hn::IfThenElse(a_is_larger, b, a);
    const SineCosine<D> of = sin_cos_near_zero(d, hn::Mul(set(kPi / 4), hn::Div(other, radius)));
    const V along = hn::Mul(radius, of.cosine), across = hn::Mul(radius, of.sine);
    const auto in_middle = hn::Eq(radius, set(0));
    const V x = hn::IfThenZeroElse(in_middle, hn::IfThenElse(a_is_larger, along, across));
    const V y = hn::IfThenZeroElse(in_middle, hn::IfThenElse(a_is_larger, across, along));
    const V left = hn::Sub(hn::Sub(set(1), hn::Mul(x, x)), hn::Mul(y, y));
    hn::Store(hn::DemoteTo(f, x), f, out.x);
    hn::Store(hn::DemoteTo(f, y), f, out.y);
    hn::Store(hn::DemoteTo(f, hn::Sqrt(most(d, set(0), left))), f, out.z);
}

void draw_all(std::span<const Sample2> u, std::span<Vec3f> out)
{
    DirectionLanes drawn;
    for_lanes_of(D(), u, [&](std::size_t first, std::size_t count, V u0, V u1) HWY_ATTR {
        draw(u0, u1, drawn);
        for (std::size_t i = 0; i < count; ++i)
            out[first + i] = {drawn.x[i], drawn.y[i], drawn.z[i]};
    });
}

} // namespace

DrawInHemisphere hemisphere_drawing()
{
    return draw_all;
}

} // namespace renderer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace renderer {

std::span<const DrawInHemisphere> all_draw_in_hemisphere()
{
    static const std::vector<DrawInHemisphere> usable =
        HELIOGRAPH_USABLE_KERNELS(DrawInHemisphere, hemisphere_drawing);
    return usable;
}

DrawInHemisphere draw_in_hemisphere()
{
    static const DrawInHemisphere best = all_draw_in_hemisphere().front();
    return best;
}

} // namespace renderer
#endif // HWY_ONCE
