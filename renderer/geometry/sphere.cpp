#include "renderer/geometry/sphere.h"

#include "renderer/geometry/rounding.h"

#include <cmath>

namespace renderer {

std::optional<double> intersect(const Sphere& sphere, const Ray& ray)
{
    if (!is_traceable(ray) || !(sphere.radius > 0)) return std::nullopt;
    const double direction_length = length(ray.direction);
    const Vec3d d = normalize(ray.direction);
    const double along = -dot(ray.origin, d);     // to the point of closest approach
    const Vec3d closest = ray.origin + d * along; // and that point
    const double distance = length(closest);
    const double half_chord_squared = (sphere.radius - distance) * (sphere.radius + distance);
    if (!(half_chord_squared >= 0)) return std::nullopt;
    const double half_chord = std::sqrt(half_chord_squared);
    const double origin_distance = length(ray.origin);
    const double product = (origin_distance - sphere.radius) * (origin_distance + sphere.radius);
    const double far_root = along + std::copysign(half_chord, along);
    const double near_root = far_root != 0 ? product / far_root : 0;
    const double first = (near_root < far_root ? near_root : far_root) / direction_length;
    const double second = (near_root < far_root ? far_root : near_root) / direction_length;
    if (first > ray.t_min) return first < ray.t_max ? std::optional(first) : std::nullopt;
    if (second > ray.t_min && second < ray.t_max) return second;
    return std::nullopt;
}

SurfacePoint point_at(const Sphere& sphere, const Ray& ray, double t)
{
    const Vec3d n = normalize(ray.at(t)); // drawn back onto the sphere: the error no longer depends on t
    const Vec3d position = n * sphere.radius;
    return {position, Vec3d{1, 1, 1} * (sphere.radius * gamma<double>(8)), n};
}

} // namespace renderer
