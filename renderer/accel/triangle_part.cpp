#include "renderer/accel/triangle_part.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace renderer {

Vec3f round_down(Vec3d p)
{
    const auto down = [](double x) {
        const auto nearest = static_cast<float>(x);
        return static_cast<double>(nearest) > x
                   ? std::nextafter(nearest, -std::numeric_limits<float>::infinity())
                   : nearest;
    };
    return {down(p.x), down(p.y), down(p.z)};
}
Vec3f round_up(Vec3d p)
{
    return -round_down(-p);
}

namespace {

// Where the edge from a to b crosses the plane, with room for what that is off by in double.
void extend_by_crossing(Bounds3f& box, Vec3d a, Vec3d b, unsigned axis, double plane)
{
    const double t = (plane - a[axis]) / (b[axis] - a[axis]);
    const Vec3d at = a + (b - a) * t, slack = (abs(a) + abs(b)) * 0x1p-50;
    Vec3d lower = at - slack, upper = at + slack;
    lower[axis] = upper[axis] = plane;
    box.extend(round_down(lower));
    box.extend(round_up(upper));
}

} // namespace

Bounds3f part_between(const Vec3d (&corners)[3], unsigned axis, float from, float to)
{
    const double planes[2] = {static_cast<double>(from), static_cast<double>(to)};
    Bounds3f box;
    for (std::size_t i = 0; i < 3; ++i) {
        const Vec3d &a = corners[i], &b = corners[i == 2 ? 0 : i + 1];
        if (planes[0] <= a[axis] && a[axis] <= planes[1]) {
            box.extend(round_down(a));
            box.extend(round_up(a));
        }
        for (const double plane : planes)
            if (std::min(a[axis], b[axis]) < plane && plane < std::max(a[axis], b[axis]))
                extend_by_crossing(box, a, b, axis, plane);
    }
    return box;
}

} // namespace renderer
