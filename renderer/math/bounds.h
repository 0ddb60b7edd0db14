// Bounds3: axis-aligned box, empty by default. Empty boxes have lower > upper and contain nothing.
#pragma once

#include "renderer/math/vec3.h"

#include <algorithm>
#include <limits>

namespace renderer {

template <typename T>
struct Bounds3 {
    Vec3<T> lower{std::numeric_limits<T>::infinity(),
                  std::numeric_limits<T>::infinity(),
                  std::numeric_limits<T>::infinity()};
    Vec3<T> upper{-std::numeric_limits<T>::infinity(),
                  -std::numeric_limits<T>::infinity(),
                  -std::numeric_limits<T>::infinity()};

    bool empty() const { return !(lower.x <= upper.x && lower.y <= upper.y && lower.z <= upper.z); }
    Vec3<T> center() const { return lower / T(2) + upper / T(2); }
    Vec3<T> extent() const { return upper - lower; }

    void extend(Vec3<T> p)
    {
        lower = {std::min(lower.x, p.x), std::min(lower.y, p.y), std::min(lower.z, p.z)};
        upper = {std::max(upper.x, p.x), std::max(upper.y, p.y), std::max(upper.z, p.z)};
    }
    void extend(const Bounds3& b)
    {
        lower = {std::min(lower.x, b.lower.x), std::min(lower.y, b.lower.y), std::min(lower.z, b.lower.z)};
        upper = {std::max(upper.x, b.upper.x), std::max(upper.y, b.upper.y), std::max(upper.z, b.upper.z)};
    }

    friend bool operator==(const Bounds3&, const Bounds3&) = default;
};

using Bounds3f = Bounds3<float>;
using Bounds3d = Bounds3<double>;

// Of its surface; of a box that is not empty, and whose extent is finite.
inline double half_area(const Bounds3d& box)
{
    const Vec3d e = box.extent();
    return e.x * e.y + e.y * e.z + e.z * e.x;
}
inline double half_area(const Bounds3f& box)
{
    return half_area(Bounds3d{to_double(box.lower), to_double(box.upper)});
}

} // namespace renderer
