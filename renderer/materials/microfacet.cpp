#include "renderer/materials/microfacet.h"

#include "renderer/math/transcendental.h"

#include <algorithm>
#include <cmath>

namespace renderer {

double Microfacets::distribution(Vec3d h) const
{
    if (!(h.z > 0)) return 0;
    const double sin2 = h.x * h.x + h.y * h.y, cos2 = h.z * h.z;
    const double length2 = sin2 + cos2, width = sin2 + alpha2 * cos2;
    const double ratio = length2 / width;
    return alpha2 * ratio * ratio / kPi;
}

double Microfacets::slope_length(double cosine) const
{
    return std::sqrt(alpha2 + (1 - alpha2) * cosine * cosine);
}

double Microfacets::masking(double cos_o) const
{
    return 2 * cos_o / (cos_o + slope_length(cos_o));
}

double Microfacets::visibility(double cos_o, double cos_i) const
{
    return 0.5 / (cos_o * slope_length(cos_i) + cos_i * slope_length(cos_o));
}

double Microfacets::visible_density(Vec3d h, double cos_o) const
{
    return 2 / (cos_o + slope_length(cos_o)) * distribution(h);
}

Vec3d sample_visible_facet(double alpha, Vec3d wo, Sample2 u)
{
    // Seen along wo, facets of a hemisphere fill a disk evenly; the slopes' width stretches the one to the
    // other.
    const Vec3d stretched = normalize(Vec3d{alpha * wo.x, alpha * wo.y, wo.z});
    const auto [sin_phi, cos_phi] = sin_cos(2 * kPi * static_cast<double>(u.u0));
    const double z = (1 - static_cast<double>(u.u1)) * (1 + stretched.z) - stretched.z;
    const double sine = std::sqrt(std::clamp((1 - z) * (1 + z), 0.0, 1.0));
    const Vec3d h = Vec3d{sine * cos_phi, sine * sin_phi, z} + stretched;
    return normalize(Vec3d{alpha * h.x, alpha * h.y, h.z});
}

} // namespace renderer
