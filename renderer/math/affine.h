// Affine3: p' = M p + t, in double. Points are column vectors; names say both ends (world_from_object).
//
// Cost  plain values; inverse() is a handful of multiplications, never per ray.
#pragma once

#include "renderer/math/vec3.h"

#include <array>
#include <optional>

namespace renderer {

struct Affine3 {
    // Rows of the linear part; translation apart.
    std::array<Vec3d, 3> rows{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    Vec3d translation{};

    static Affine3 scale(Vec3d factors);
    static Affine3 translate(Vec3d offset);
    // Right-handed turn about `axis` (any length but zero) by `degrees`; multiples of 90 are exact.
    static Affine3 rotate_deg(double degrees, Vec3d axis);

    Vec3d point(Vec3d p) const { return vector(p) + translation; }
    Vec3d vector(Vec3d v) const { return {dot(rows[0], v), dot(rows[1], v), dot(rows[2], v)}; }
    // Transposed product: with the inverse transform's rows this maps normals (not normalised).
    Vec3d transposed_vector(Vec3d v) const { return rows[0] * v.x + rows[1] * v.y + rows[2] * v.z; }

    double determinant() const;
    // Nothing if singular: the linear part collapses volume, or its inverse is not finite.
    std::optional<Affine3> inverse() const;

    friend constexpr bool operator==(const Affine3&, const Affine3&) = default;
};

// First `inner`, then `outer`.
Affine3 operator*(const Affine3& outer, const Affine3& inner);

} // namespace renderer
