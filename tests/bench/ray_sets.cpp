#include "tests/bench/ray_sets.h"

#include "renderer/math/transcendental.h"

#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

namespace bench {

using namespace renderer;

namespace {

constexpr std::uint32_t kSide = 1024;

// splitmix64: S. Vigna, public domain.
class Random {
public:
    std::uint64_t bits()
    {
        std::uint64_t z = (state_ += 0x9e3779b97f4a7c15u);
        z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
        z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
        return z ^ (z >> 31);
    }
    double uniform() { return static_cast<double>(bits() >> 11) * 0x1p-53; }

private:
    std::uint64_t state_ = 1;
};

// Every other bit of a Morton code.
std::uint32_t every_other_bit(std::uint32_t code)
{
    std::uint32_t value = 0;
    for (unsigned bit = 0; bit < 16; ++bit)
        value |= ((code >> (2 * bit)) & 1u) << bit;
    return value;
}

FloatRay narrow(Vec3d origin, Vec3d direction, double t_max)
{
    return {to_float(origin), 0, to_float(direction), static_cast<float>(t_max)};
}

Vec3d cosine_direction(Vec3d n, Random& random)
{
    const Vec3d side = normalize(cross(n, std::abs(n.x) < 0.5 ? Vec3d{1, 0, 0} : Vec3d{0, 1, 0}));
    const double r = std::sqrt(random.uniform());
    const auto [s, c] = sin_cos(2 * kPi * random.uniform());
    return side * (r * c) + cross(n, side) * (r * s) + n * std::sqrt(1 - r * r);
}

RaySet primary_rays(const View& view)
{
    RaySet set{"primary", false, true, {}};
    set.rays.reserve(std::size_t{kSide} * kSide);
    const Vec3d forward = normalize(view.at - view.eye), right = normalize(cross(forward, view.up));
    const Vec3d up = cross(right, forward);
    const double scale = tan_deg(view.fov_deg / 2);
    for (std::uint32_t code = 0; code < kSide * kSide; ++code) {
        const double x = 2 * (every_other_bit(code) + 0.5) / kSide - 1,
                     y = 1 - 2 * (every_other_bit(code >> 1) + 0.5) / kSide;
        set.rays.push_back(narrow(view.eye,
                                  normalize(forward + right * (x * scale) + up * (y * scale)),
                                  std::numeric_limits<double>::infinity()));
    }
    return set;
}

} // namespace

View view_of_object(const Bounds3f& bounds)
{
    const Vec3d center = to_double(bounds.center());
    const double radius = length(to_double(bounds.extent())) / 2;
    View view;
    view.eye = center + normalize(Vec3d{0.35, 0.3, 1}) * (2.4 * radius);
    view.at = center;
    view.light = center + Vec3d{1.5, 2, 1.7} * radius;
    return view;
}

View view_of_nave()
{
    View view;
    view.eye = {-11.5, 2.6, 0.35};
    view.at = {5, 2.4, -0.2};
    view.light = {1.5, 9.5, 0.7};
    view.fov_deg = 60;
    return view;
}

View scaled(const View& view, double factor)
{
    View result = view;
    result.eye = view.eye * factor;
    result.at = view.at * factor;
    result.light = view.light * factor;
    return result;
}

std::vector<RaySet> make_ray_sets(const Mesh& mesh, const MeshBvh& bvh, const View& view)
{
    RaySet primary = primary_rays(view), shadow{"shadow", true, true, {}},
           ordered{"diffuse in pixel order", false, false, {}};
    const double stand_off = 1e-5 * length(to_double(bvh.bounds().extent()));
    Random random;
    for (const FloatRay& ray : primary.rays) {
        const auto hit = bvh.closest_hit({to_double(ray.origin), to_double(ray.direction)});
        if (!hit) continue;
        const SurfacePoint point = surface_point(mesh, *hit);
        const Vec3d n = dot(point.normal, to_double(ray.direction)) > 0 ? -point.normal : point.normal;
        const Vec3d origin = point.position + n * stand_off;
        shadow.rays.push_back(narrow(origin, view.light - origin, 1));
        ordered.rays.push_back(
            narrow(origin, cosine_direction(n, random), std::numeric_limits<double>::infinity()));
    }
    RaySet shuffled{"diffuse", false, false, ordered.rays};
    for (std::size_t i = shuffled.rays.size(); i > 1; --i)
        std::swap(shuffled.rays[i - 1], shuffled.rays[random.bits() % i]);
    std::vector<RaySet> sets;
    sets.push_back(std::move(primary));
    sets.push_back(std::move(shadow));
    sets.push_back(std::move(shuffled));
    sets.push_back(std::move(ordered));
    return sets;
}

} // namespace bench
