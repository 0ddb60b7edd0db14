// The functions of vec3.h for a vector of vectors: operation for operation, so the same bits on every target. Included once
// a target of Highway.
#if defined(HELIOGRAPH_VEC3_LANES_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef HELIOGRAPH_VEC3_LANES_INL
#undef HELIOGRAPH_VEC3_LANES_INL
#else
#define HELIOGRAPH_VEC3_LANES_INL
#endif

#include "renderer/math/vec3.h"

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace renderer::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

template <class V>
struct Vec3Lanes {
    V x, y, z;
};

template <class D, class V = hn::Vec<D>>
HWY_INLINE Vec3Lanes<V> splat(D d, Vec3d v)
{
    return {hn::Set(d, v.x), hn::Set(d, v.y), hn::Set(d, v.z)};
}
template <class V>
HWY_INLINE Vec3Lanes<V> add(const Vec3Lanes<V>& a, const Vec3Lanes<V>& b)
{
    return {hn::Add(a.x, b.x), hn::Add(a.y, b.y), hn::Add(a.z, b.z)};
}
template <class V>
HWY_INLINE Vec3Lanes<V> subtract(const Vec3Lanes<V>& a, const Vec3Lanes<V>& b)
{
    return {hn::Sub(a.x, b.x), hn::Sub(a.y, b.y), hn::Sub(a.z, b.z)};
}
template <class V>
HWY_INLINE Vec3Lanes<V> times(const Vec3Lanes<V>& a, V s)
{
    return {hn::Mul(a.x, s), hn::Mul(a.y, s), hn::Mul(a.z, s)};
}
template <class V>
HWY_INLINE Vec3Lanes<V> divided(const Vec3Lanes<V>& a, V s)
{
    return {hn::Div(a.x, s), hn::Div(a.y, s), hn::Div(a.z, s)};
}
template <class V>
HWY_INLINE Vec3Lanes<V> abs(const Vec3Lanes<V>& v)
{
    return {hn::Abs(v.x), hn::Abs(v.y), hn::Abs(v.z)};
}
template <class V>
HWY_INLINE V dot(const Vec3Lanes<V>& a, const Vec3Lanes<V>& b)
{
    return hn::Add(hn::Add(hn::Mul(a.x, b.x), hn::Mul(a.y, b.y)), hn::Mul(a.z, b.z));
}
template <class V>
HWY_INLINE Vec3Lanes<V> cross(const Vec3Lanes<V>& a, const Vec3Lanes<V>& b)
{
    return {hn::Sub(hn::Mul(a.y, b.z), hn::Mul(a.z, b.y)),
            hn::Sub(hn::Mul(a.z, b.x), hn::Mul(a.x, b.z)),
            hn::Sub(hn::Mul(a.x, b.y), hn::Mul(a.y, b.x))};
}
template <class V>
HWY_INLINE V max_component(const Vec3Lanes<V>& v)
{
    const V xy = hn::IfThenElse(hn::Gt(v.x, v.y), v.x, v.y);
    return hn::IfThenElse(hn::Gt(xy, v.z), xy, v.z);
}
template <class V>
HWY_INLINE V length(const Vec3Lanes<V>& v)
{
    const V largest = max_component(abs(v));
    const Vec3Lanes<V> s = divided(v, largest);
    const V zero = hn::Zero(hn::DFromV<V>());
    return hn::IfThenElseZero(hn::Gt(largest, zero), hn::Mul(largest, hn::Sqrt(dot(s, s))));
}
template <class V>
HWY_INLINE Vec3Lanes<V> normalize(const Vec3Lanes<V>& v)
{
    const Vec3Lanes<V> s = divided(v, max_component(abs(v)));
    return divided(s, hn::Sqrt(dot(s, s)));
}

} // namespace
} // namespace renderer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif // per-target include guard
