// Elementary functions of a vector of doubles: operation for operation those of transcendental.cpp, so the same bits on
// every target. Included once a target of Highway.
#if defined(HELIOGRAPH_TRANSCENDENTAL_LANES_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef HELIOGRAPH_TRANSCENDENTAL_LANES_INL
#undef HELIOGRAPH_TRANSCENDENTAL_LANES_INL
#else
#define HELIOGRAPH_TRANSCENDENTAL_LANES_INL
#endif

#include "renderer/math/transcendental.h"
#include "renderer/math/transcendental_constants.h"

#include <cstddef>
#include <hwy/highway.h>
#include <limits>

HWY_BEFORE_NAMESPACE();
namespace renderer::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

// std::min, std::max and std::clamp as they are defined; what processors call so differs where a zero is negative.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V least(D, V a, V b)
{
    return hn::IfThenElse(hn::Lt(b, a), b, a);
}
template <class D, class V = hn::Vec<D>>
HWY_INLINE V most(D, V a, V b)
{
    return hn::IfThenElse(hn::Lt(a, b), b, a);
}
template <class D, class V = hn::Vec<D>>
HWY_INLINE V clamp(D, V v, V low, V high)
{
    return hn::IfThenElse(hn::Lt(v, low), low, hn::IfThenElse(hn::Lt(high, v), high, v));
}
template <class D, class V = hn::Vec<D>>
HWY_INLINE hn::Mask<D> is_finite(D d, V v)
{
    return hn::Lt(hn::Abs(v), hn::Set(d, std::numeric_limits<double>::infinity()));
}

// Added to the products before it: a polynomial from its highest coefficient down.
template <class D, class V = hn::Vec<D>, std::size_t N>
HWY_INLINE V polynomial(D d, V z, const double (&coefficients)[N])
{
    V p = hn::Set(d, coefficients[0]);
    for (std::size_t i = 1; i < N; ++i)
        p = hn::Add(hn::Mul(p, z), hn::Set(d, coefficients[i]));
    return p;
}

template <class D, class V = hn::Vec<D>>
struct SineCosine {
    V sine, cosine;
};

// Of at most pi/4.
template <class D, class V = hn::Vec<D>>
HWY_INLINE SineCosine<D> sin_cos_near_zero(D d, V x)
{
    const auto set = [&](double value) HWY_ATTR { return hn::Set(d, value); };
    const V z = hn::Mul(x, x), half = hn::Mul(set(0.5), z), w = hn::Sub(set(1), half);
    const V rest = hn::Mul(hn::Mul(z, z), polynomial(d, z, transcendental::kCosine));
    return {hn::Add(x, hn::Mul(x, hn::Mul(z, polynomial(d, z, transcendental::kSine)))),
            hn::Add(w, hn::Add(hn::Sub(hn::Sub(set(1), w), half), rest))};
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE SineCosine<D> sin_cos(D d, V radians)
{
    const hn::RebindToUnsigned<D> u;
    const auto set = [&](double x) HWY_ATTR { return hn::Set(d, x); };
    const V shift = set(transcendental::kShift);
    const V shifted = hn::Add(hn::Mul(radians, set(2 / kPi)), shift), quarters = hn::Sub(shifted, shift);
    const V first = hn::Sub(radians, hn::Mul(quarters, set(transcendental::kQuarterTurn[0])));
    const V second = hn::Mul(quarters, set(transcendental::kQuarterTurn[1]));
    const V y = hn::Sub(first, second), lost = hn::Sub(hn::Sub(first, y), second);
    const V tail = hn::Sub(lost, hn::Mul(quarters, set(transcendental::kQuarterTurn[2])));
    const V x = hn::Add(y, tail), low = hn::Add(hn::Sub(y, x), tail);

    const auto [s0, c0] = sin_cos_near_zero(d, x);
    const V s1 = hn::Add(s0, hn::Mul(low, c0)), c1 = hn::Sub(c0, hn::Mul(low, s0));
    const auto quarter = hn::BitCast(u, shifted);
    const auto one = hn::Set(u, 1), two = hn::Set(u, 2);
    const auto odd = hn::RebindMask(d, hn::Eq(hn::And(quarter, one), one));
    const auto sine_sign = hn::ShiftLeft<62>(hn::And(quarter, two));
    const auto cosine_sign = hn::ShiftLeft<62>(hn::And(hn::Xor(hn::Add(quarter, quarter), quarter), two));
    return {hn::Xor(hn::IfThenElse(odd, c1, s1), hn::BitCast(d, sine_sign)),
            hn::Xor(hn::IfThenElse(odd, s1, c1), hn::BitCast(d, cosine_sign))};
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE V atan2(D d, V y, V x)
{
    const hn::RebindToUnsigned<D> u;
    const hn::RebindToSigned<D> i64;
    const auto set = [&](double v) HWY_ATTR { return hn::Set(d, v); };
    const V zero = hn::Zero(d), ax = hn::Abs(x), ay = hn::Abs(y), sum = hn::Add(ax, ay);
    const auto steep = hn::Lt(ax, ay), behind = hn::Lt(x, zero), below = hn::Lt(y, zero);
    const V ratio = hn::Div(least(d, ax, ay), most(d, ax, ay));
    // Of the angle within an eighth of a turn.
    const V shift = set(transcendental::kShift), shifted = hn::Add(hn::Mul(ratio, set(8)), shift);
    const V c = hn::Div(hn::Sub(shifted, shift), set(8));
    const V t = hn::Div(hn::Sub(ratio, c), hn::Add(set(1), hn::Mul(ratio, c))), z = hn::Mul(t, t);
    // Where the ratio is no number, any place will do.
    const auto place = hn::And(hn::BitCast(u, shifted), hn::Set(u, 7));
    const auto whole =
        hn::RebindMask(d, hn::Eq(hn::And(hn::BitCast(u, shifted), hn::Set(u, 15)), hn::Set(u, 8)));
    const V base = hn::IfThenElse(whole,
                                  set(transcendental::kArcOfEighths[8]),
                                  hn::GatherIndex(d, transcendental::kArcOfEighths, hn::BitCast(i64, place)));
    const V within =
        hn::Add(base, hn::Add(t, hn::Mul(t, hn::Mul(z, polynomial(d, z, transcendental::kArc)))));
    const auto negative_if = [&](hn::Mask<D> mask, V v)
                                 HWY_ATTR { return hn::Xor(v, hn::IfThenElseZero(mask, set(-0.0))); };
    const V ahead = hn::Add(hn::IfThenElseZero(steep, set(kPi / 2)), negative_if(steep, within));
    const V angle = hn::Add(hn::IfThenElseZero(behind, set(kPi)), negative_if(behind, ahead));
    const V known = hn::IfThenElse(hn::Eq(sum, zero), zero, negative_if(below, angle));
    return hn::IfThenElse(is_finite(d, sum), known, set(std::numeric_limits<double>::quiet_NaN()));
}

} // namespace
} // namespace renderer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif // per-target include guard
