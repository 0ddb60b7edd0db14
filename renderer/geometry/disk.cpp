#include "renderer/geometry/disk.h"

#include "renderer/geometry/rounding.h"

namespace renderer {

std::optional<double> intersect(const Disk& disk, const Ray& ray)
{
    if (!is_traceable(ray) || ray.direction.z == 0) return std::nullopt;
    const double t = -ray.origin.z / ray.direction.z;
    if (!(t > ray.t_min && t < ray.t_max)) return std::nullopt;
    const Vec3d p = ray.at(t);
    if (!(length(Vec3d{p.x, p.y, 0}) <= disk.radius)) return std::nullopt;
    return t;
}

SurfacePoint point_at(const Disk&, const Ray& ray, double t)
{
    const Vec3d p = ray.at(t);
    const Vec3d reach = abs(ray.origin) + abs(ray.direction * t);
    return {{p.x, p.y, 0}, {reach.x * gamma<double>(4), reach.y * gamma<double>(4), 0}, {0, 0, 1}};
}

} // namespace renderer
