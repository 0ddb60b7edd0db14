#include "renderer/geometry/surface_point.h"

#include "renderer/geometry/rounding.h"

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

namespace renderer {

namespace {

// The next representable number where `offset` moves; the sum may have rounded back. As std::nextafter of what is
// finite and no zero, without its call.
double outwards(double sum, double offset)
{
    if (offset == 0) return sum;
    if (sum == 0 || !std::isfinite(sum))
        return std::nextafter(sum, std::copysign(std::numeric_limits<double>::infinity(), offset));
    const auto bits = std::bit_cast<std::uint64_t>(sum);
    return std::bit_cast<double>((sum < 0) == (offset < 0) ? bits + 1 : bits - 1);
}

} // namespace

Vec3d offset_origin(const SurfacePoint& from, Vec3d direction)
{
    const double distance = dot(abs(from.normal), from.error);
    const Vec3d offset = from.normal * (dot(direction, from.normal) < 0 ? -distance : distance);
    const Vec3d moved = from.position + offset;
    return {outwards(moved.x, offset.x), outwards(moved.y, offset.y), outwards(moved.z, offset.z)};
}

SurfacePoint weighted_point(Vec3d a, Vec3d b, Vec3d c, Vec3d barycentrics)
{
    const Vec3d da = a * barycentrics.x, db = b * barycentrics.y, dc = c * barycentrics.z;
    SurfacePoint point;
    point.position = da + db + dc;
    point.error = (abs(da) + abs(db) + abs(dc)) * gamma<double>(kWeighingRoundings);
    return point;
}

SurfacePoint triangle_point(Vec3d a, Vec3d b, Vec3d c, Vec3d barycentrics)
{
    SurfacePoint point = weighted_point(a, b, c, barycentrics);
    point.normal = normalize(cross(b - a, c - a));
    return point;
}

} // namespace renderer
