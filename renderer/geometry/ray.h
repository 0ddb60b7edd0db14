// Ray: a half-line that is followed from t_min to t_max; the point at t is origin + t * direction.
//
// Units      direction may have any length but zero; t counts in its lengths, so it survives a change of
//            frame.
// Range      open: a hit has t_min < t < t_max. t_max may be infinite.
// Precision  Ray is in double, in the world and in object space; kernels make their own float copy.
#pragma once

#include "renderer/math/vec3.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace renderer {

template <typename T>
struct BasicRay {
    Vec3<T> origin{};
    Vec3<T> direction{0, 0, -1};
    T t_min = 0;
    T t_max = std::numeric_limits<T>::infinity();

    Vec3<T> at(T t) const { return origin + direction * t; }
};

using Ray = BasicRay<double>;

// False for NaN or infinity in origin or direction, for a direction of no length (below the smallest normal
// number), and for a range that holds nothing or is NaN: such a ray hits nothing, anywhere.
template <typename T>
bool is_traceable(const BasicRay<T>& ray)
{
    return is_finite(ray.origin) && is_finite(ray.direction) && ray.t_min < ray.t_max &&
           max_component(abs(ray.direction)) >= std::numeric_limits<T>::min();
}

// Where a ray may end whose best hit so far is at t: past it, so that ties are still seen.
inline double just_past(double t, double t_max)
{
    return std::min(t_max, std::nextafter(t, std::numeric_limits<double>::infinity()));
}

} // namespace renderer
