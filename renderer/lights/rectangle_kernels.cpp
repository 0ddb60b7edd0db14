#include "renderer/lights/rectangle_kernels.h"

#include "renderer/math/kernel_targets.h"

#include <vector>

// This file is compiled once for every target of Highway; what is above, for the baseline alone.
// clang-format off
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "renderer/lights/rectangle_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "renderer/math/transcendental_lanes-inl.h"
#include "renderer/math/vec3_lanes-inl.h"
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
HWY_INLINE V plus_squares(V a, V b)
{
    return hn::Add(hn::Mul(a, a), hn::Mul(b, b));
}
HWY_INLINE V sine_of(V cosine)
{
    const V one = set(1);
    return hn::Sqrt(most(D(), hn::Zero(D()), hn::Mul(hn::Sub(one, cosine), hn::Add(one, cosine))));
}
HWY_INLINE V sum_of_arc_cosines(V a, V b)
{
    const D d;
    const V sa = sine_of(a), sb = sine_of(b);
    const V angle =
        atan2(d, hn::Add(hn::Mul(sa, b), hn::Mul(a, sb)), hn::Sub(hn::Mul(a, b), hn::Mul(sa, sb)));
    return hn::Add(angle, hn::IfThenElseZero(hn::Lt(angle, hn::Zero(d)), set(2 * kPi)));
}
HWY_INLINE V dot(const V (&v)[3], Vec3d w)
{
    return dot(Vec3Lanes<V>{v[0], v[1], v[2]}, splat(D(), w));
}

// spherical_sampling.cpp says what these are.
HWY_INLINE void draw(const RectangleView& r, RectangleRun& run, std::size_t first)
{
    const D d;
    const V zero = hn::Zero(d), one = set(1);
    V point[3], corner[3];
    for (std::size_t axis = 0; axis < 3; ++axis) {
        point[axis] = hn::Load(d, run.point[axis] + first);
        corner[axis] = hn::Sub(set(r.corner[axis]), point[axis]);
    }
    V z0 = dot(corner, r.z);
    const auto flip = hn::IfThenElseZero(hn::Gt(z0, zero), set(-0.0));
    z0 = hn::Xor(z0, flip);
    const V x0 = dot(corner, r.x), y0 = dot(corner, r.y);
    const V x1 = hn::Add(x0, set(r.width)), y1 = hn::Add(y0, set(r.height));
    const V n0 = hn::Sqrt(plus_squares(z0, y0)), n1 = hn::Sqrt(plus_squares(z0, x1)),
            n2 = hn::Sqrt(plus_squares(z0, y1)), n3 = hn::Sqrt(plus_squares(z0, x0));
    const V b0 = hn::Div(hn::Neg(y0), n0), b1 = hn::Div(x1, n1), b2 = hn::Div(y1, n2),
            b3 = hn::Div(hn::Neg(x0), n3);
    const V k = hn::Sub(set(2 * kPi), sum_of_arc_cosines(hn::Mul(hn::Neg(b2), b3), hn::Mul(hn::Neg(b3), b0)));
    const V seen = hn::Sub(sum_of_arc_cosines(hn::Mul(hn::Neg(b0), b1), hn::Mul(hn::Neg(b1), b2)), k);
    const V solid_angle = hn::IfThenElseZero(hn::Lt(z0, zero), most(d, zero, seen));
    hn::Store(solid_angle, d, run.solid_angle + first);

    const V au = hn::Add(hn::Mul(hn::Load(d, run.u0 + first), solid_angle), k);
    const SineCosine<D> of_au = sin_cos(d, au);
    const V fu = hn::Div(hn::Sub(hn::Mul(of_au.cosine, b0), b2), of_au.sine);
    V cu = hn::Div(one, hn::Sqrt(plus_squares(fu, b0)));
    cu = hn::Xor(cu, hn::IfThenElseZero(hn::Lt(fu, zero), set(-0.0)));
    cu = hn::IfThenElse(is_finite(d, cu), clamp(d, cu, set(-1), one), set(-1));
    const V below = most(d, set(1e-300), hn::Sub(one, hn::Mul(cu, cu)));
    const V xu = clamp(d, hn::Div(hn::Neg(hn::Mul(cu, z0)), hn::Sqrt(below)), x0, x1);
    const V d2 = plus_squares(xu, z0);
    const V h0 = hn::Div(y0, hn::Sqrt(hn::Add(d2, hn::Mul(y0, y0)))),
            h1 = hn::Div(y1, hn::Sqrt(hn::Add(d2, hn::Mul(y1, y1))));
    const V hv = hn::Add(h0, hn::Mul(hn::Load(d, run.u1 + first), hn::Sub(h1, h0)));
    const V left = hn::Sub(one, hn::Mul(hv, hv));
    const V yv = hn::IfThenElse(
        hn::Gt(left, set(1e-15)), clamp(d, hn::Mul(hv, hn::Sqrt(hn::Div(d2, left))), y0, y1), y1);

    V way[3];
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const V z = hn::Xor(set(r.z[axis]), flip);
        const V across = hn::Add(hn::Mul(set(r.x[axis]), xu), hn::Mul(set(r.y[axis]), yv));
        const V seen_at = hn::Add(across, hn::Mul(z, z0));
        way[axis] = hn::Sub(hn::Add(point[axis], seen_at), point[axis]);
    }
    const V distance = length(Vec3Lanes<V>{way[0], way[1], way[2]});
    hn::Store(distance, d, run.distance + first);
    for (std::size_t axis = 0; axis < 3; ++axis)
        hn::Store(hn::Div(way[axis], distance), d, run.direction[axis] + first);
}

void draw_all(const RectangleView& rectangle, RectangleRun& run, std::size_t count)
{
    for (std::size_t first = 0; first < count; first += kLanes)
        draw(rectangle, run, first);
}

} // namespace

DrawOnRectangle rectangle_drawing()
{
    return draw_all;
}

} // namespace renderer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace renderer {

std::span<const DrawOnRectangle> all_draw_on_rectangle()
{
    static const std::vector<DrawOnRectangle> usable =
        HELIOGRAPH_USABLE_KERNELS(DrawOnRectangle, rectangle_drawing);
    return usable;
}

DrawOnRectangle draw_on_rectangle()
{
    static const DrawOnRectangle best = all_draw_on_rectangle().front();
    return best;
}

} // namespace renderer
#endif // HWY_ONCE
