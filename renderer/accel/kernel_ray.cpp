#include "renderer/accel/kernel_ray.h"

#include "renderer/accel/float4.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace renderer {

namespace {

constexpr float kUnit = 0x1p-24f; // relative rounding of float

// The power of two with the exponent of `x`, inverted: x * inverse_power(x) is in [1, 4).
double inverse_power(double x)
{
    const std::uint64_t exponent = (std::bit_cast<std::uint64_t>(x) >> 52) & 0x7ff;
    return std::bit_cast<double>(std::max<std::uint64_t>(1, 2046 - std::min<std::uint64_t>(exponent, 2046))
                                 << 52);
}

// A float no less than x.
float narrow_up(double x)
{
    const auto nearest = static_cast<float>(x);
    return nearest + std::abs(nearest) * (2 * kUnit) + std::numeric_limits<float>::min();
}

float largest(const Bounds3f& box)
{
    return std::max(max_abs(box.lower), max_abs(box.upper));
}

} // namespace

float kernel_scale(const Bounds3f& box)
{
    const float size = largest(box);
    if (!(size > 0) || (size > 0x1p-40f && size < 0x1p40f)) return 1;
    int exponent = 0;
    std::frexp(size, &exponent);
    return std::ldexp(1.0f, std::clamp(-exponent, -126, 126));
}

bool KernelRay::prepare_exact(const Ray& ray, float scale)
{
    if (!is_traceable(ray)) return false;
    const double direction_scale = inverse_power(max_abs(ray.direction));
    direction = ray.direction * direction_scale;
    exact = WatertightRay<double>(ray.origin * static_cast<double>(scale), direction);
    const double units = static_cast<double>(scale) / direction_scale;
    t_min = ray.t_min * units;
    t_max = ray.t_max * units;
    ray_units = direction_scale / static_cast<double>(scale);
    return true;
}

bool KernelRay::prepare(const Ray& ray, const Bounds3f& box, float scale)
{
    if (!prepare_exact(ray, scale)) return false;
    // Where double itself may be off: origin, box and the test's own roundings.
    const double blur = 0x1p-49 * (max_abs(exact.origin) + static_cast<double>(largest(box)));
    const Vec3d inverse = reciprocal(direction);
    double exit = 0;
    const SlabRay<double> whole(exact.origin, inverse, blur);
    if (!whole.meets(to_double(box.lower), to_double(box.upper), t_min, t_max, start, exit)) return false;
    sx = static_cast<float>(exact.sx);
    sy = static_cast<float>(exact.sy);
    sz = static_cast<float>(exact.sz);
    origin = to_float(exact.origin + direction * start);
    const float reach = std::max(max_abs(box.lower - origin), max_abs(box.upper - origin));
    lateral = kUnit * (8 * reach + 4 * max_abs(origin)) + 2 * static_cast<float>(blur);
    slabs = SlabRay<float>(origin, to_float(inverse), lateral);
    return true;
}

float KernelRay::end_for(double t) const
{
    return narrow_up(t - start) + 4 * lateral;
}

// The corners' places across the ray are within `lateral` of where the double test has them, so an edge value
// is within `slack` of its counterpart; only when two edges disagree beyond that is the triangle certainly
// missed. Along the ray a hit lies between the corners' depths. A NaN rejects nothing.
unsigned KernelRay::may_hit(const TriangleBlock& block, float end) const
{
    const Float4 ox = Float4::splat(origin[exact.kx]), oy = Float4::splat(origin[exact.ky]),
                 oz = Float4::splat(origin[exact.kz]);
    const Float4 shear_x = Float4::splat(sx), shear_y = Float4::splat(sy), depth_scale = Float4::splat(sz);
    Float4 x[3], y[3], t[3];
    for (std::size_t k = 0; k < 3; ++k) {
        const auto& corner = block.corners[k];
        const Float4 depth = Float4::load(corner[exact.kz]) - oz;
        x[k] = (Float4::load(corner[exact.kx]) - ox) - shear_x * depth;
        y[k] = (Float4::load(corner[exact.ky]) - oy) - shear_y * depth;
        t[k] = depth * depth_scale;
    }
    const Float4 e0 = x[2] * y[1] - y[2] * x[1], e1 = x[0] * y[2] - y[0] * x[2],
                 e2 = x[1] * y[0] - y[1] * x[0];
    const Float4 widest = max(abs(x[0]) + abs(y[0]), max(abs(x[1]) + abs(y[1]), abs(x[2]) + abs(y[2])));
    const Float4 side = Float4::splat(lateral);
    const Float4 slack = Float4::splat(4 * lateral) * (widest + side);
    const Float4 least = min(e0, min(e1, e2)), most = max(e0, max(e1, e2));
    const unsigned beside = less(least, Float4::splat(0) - slack) & less(slack, most);
    const unsigned beyond = less(Float4::splat(end), min(t[0], min(t[1], t[2])));
    const unsigned behind = less(max(t[0], max(t[1], t[2])), Float4::splat(begin()));
    return ~(beside | beyond | behind) & 0xf;
}

} // namespace renderer
