#include "renderer/math/affine.h"

#include "renderer/math/transcendental.h"

#include <cmath>

namespace renderer {

Affine3 Affine3::scale(Vec3d factors)
{
    Affine3 a;
    a.rows = {{{factors.x, 0, 0}, {0, factors.y, 0}, {0, 0, factors.z}}};
    return a;
}

Affine3 Affine3::translate(Vec3d offset)
{
    Affine3 a;
    a.translation = offset;
    return a;
}

// Source: Rodrigues' rotation formula as a matrix.
Affine3 Affine3::rotate_deg(double degrees, Vec3d axis)
{
    const auto [s, c] = sin_cos_deg(degrees);
    const Vec3d k = normalize(axis);
    const double v = 1 - c;
    Affine3 a;
    a.rows = {{{c + k.x * k.x * v, k.x * k.y * v - k.z * s, k.x * k.z * v + k.y * s},
               {k.y * k.x * v + k.z * s, c + k.y * k.y * v, k.y * k.z * v - k.x * s},
               {k.z * k.x * v - k.y * s, k.z * k.y * v + k.x * s, c + k.z * k.z * v}}};
    return a;
}

double Affine3::determinant() const
{
    return dot(rows[0], cross(rows[1], rows[2]));
}

std::optional<Affine3> Affine3::inverse() const
{
    // Rows are scaled to unit size first, so that neither 1e-200 nor 1e200 loses the determinant.
    std::array<double, 3> size{};
    std::array<Vec3d, 3> unit{};
    for (std::size_t i = 0; i < 3; ++i) {
        size[i] = max_component(abs(rows[i]));
        if (!(size[i] > 0) || !std::isfinite(size[i])) return std::nullopt;
        unit[i] = rows[i] / size[i];
    }
    const Vec3d c0 = cross(unit[1], unit[2]), c1 = cross(unit[2], unit[0]), c2 = cross(unit[0], unit[1]);
    const double det = dot(unit[0], c0);
    // Below rounding of the cofactors themselves the volume is not told from zero.
    if (!(std::abs(det) > 1e-15 * length(unit[0]) * length(unit[1]) * length(unit[2]))) return std::nullopt;
    Affine3 inv;
    const Vec3d a = c0 / det / size[0], b = c1 / det / size[1], c = c2 / det / size[2];
    inv.rows = {{{a.x, b.x, c.x}, {a.y, b.y, c.y}, {a.z, b.z, c.z}}};
    inv.translation = -inv.vector(translation);
    for (const Vec3d& row : inv.rows)
        if (!is_finite(row)) return std::nullopt;
    if (!is_finite(inv.translation)) return std::nullopt;
    return inv;
}

Affine3 operator*(const Affine3& outer, const Affine3& inner)
{
    Affine3 a;
    for (std::size_t i = 0; i < 3; ++i)
        a.rows[i] = inner.transposed_vector(outer.rows[i]);
    a.translation = outer.point(inner.translation);
    return a;
}

} // namespace renderer
