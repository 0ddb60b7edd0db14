#include "renderer/geometry/surface_point.h"

#include "renderer/geometry/rounding.h"

#include <cmath>
#include <limits>

namespace renderer {

namespace {

// The next representable number away from `from`, where `offset` moves; the sum may have rounded back.
double outwards(double sum, double offset)
{
    if (offset == 0) return sum;
    return std::nextafter(sum, std::copysign(std::numeric_limits<double>::infinity(), offset));
}

} // namespace

Vec3d offset_origin(const SurfacePoint& from, Vec3d direction)
{
    const double distance = dot(abs(from.normal), from.error);
    const Vec3d offset = from.normal * (dot(direction, from.normal) < 0 ? -distance : distance);
    const Vec3d moved = from.position + offset;
    return {outwards(moved.x, offset.x), outwards(moved.y, offset.y), outwards(moved.z, offset.z)};
}

SurfacePoint triangle_point(Vec3d a, Vec3d b, Vec3d c, Vec3d barycentrics)
{
    const Vec3d da = a * barycentrics.x, db = b * barycentrics.y, dc = c * barycentrics.z;
    SurfacePoint point;
    point.position = da + db + dc;
    // Products and sums round; the weights themselves may miss a sum of 1 by four roundings.
    point.error = (abs(da) + abs(db) + abs(dc)) * gamma<double>(8);
    point.normal = normalize(cross(b - a, c - a));
    return point;
}

} // namespace renderer
