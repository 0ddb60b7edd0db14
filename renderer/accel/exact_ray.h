// ExactRay: one ray in the units of the kernels, as the double test takes it.
//
// Promise  operation for operation what prepare_run does for a vector of rays.
#pragma once

#include "renderer/geometry/ray.h"
#include "renderer/geometry/triangle.h"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <limits>

namespace renderer {

// The power of two that brings a direction with this largest component near 1.
inline double power_for(double largest)
{
    const std::uint64_t exponent = std::bit_cast<std::uint64_t>(largest) & std::uint64_t{0x7ff} << 52;
    return std::max(std::bit_cast<double>((std::uint64_t{0x7fe} << 52) - exponent),
                    std::numeric_limits<double>::min());
}

struct ExactRay {
    WatertightRay<double> ray;
    Vec3d direction; // near 1 in length, as `ray` was made of
    double t_min, t_max;
    double ray_units; // t of the ray = t of the kernel * ray_units

    // A traceable one; `scale` of the mesh.
    ExactRay(const Ray& given, double scale)
    {
        const double power = power_for(max_component(abs(given.direction)));
        direction = given.direction * power;
        ray = WatertightRay<double>(given.origin * scale, direction);
        t_min = given.t_min * (scale / power);
        t_max = given.t_max * (scale / power);
        ray_units = power / scale;
    }
};

} // namespace renderer
