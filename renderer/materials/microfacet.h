// Microfacets: a rough surface as mirrors or panes whose slopes are spread as Trowbridge and Reitz say
// (GGX), alike in all directions.
//
// Frame   local, z up; directions in double, unit: a sharp lobe is narrower than a float's step would
//         forgive.
// Units   densities per steradian. alpha: width of the slopes, roughness squared, above 0.
// Source  B. Walter et al., "Microfacet Models for Refraction through Rough Surfaces", EGSR 2007 (D,
//         Jacobians); E. Heitz, "Understanding the Masking-Shadowing Function", JCGT 3(2), 2014
//         (height-correlated Smith); J. Dupuy, A. Benyoub, "Sampling Visible GGX Normals with Spherical
//         Caps", 2023.
// Digits  sums of squares instead of 1 - cos^2, so that alpha 1e-6 keeps them.
#pragma once

#include "renderer/math/vec3.h"
#include "renderer/sampling/sampler.h"

namespace renderer {

struct Microfacets {
    double alpha2; // alpha^2

    explicit Microfacets(double alpha) : alpha2(alpha * alpha) {}

    // D(h) for any h of positive length on the upper side: its length does not matter.
    double distribution(Vec3d h) const;
    // sqrt(alpha^2 + (1 - alpha^2) cos^2): Smith's G1 is 2 cos / (cos + slope_length).
    double slope_length(double cosine) const;
    // G1(wo): share of the facets facing wo that wo sees.
    double masking(double cos_o) const;
    // G2(wo, wi) / (4 cos_o cos_i), finite at grazing angles.
    double visibility(double cos_o, double cos_i) const;
    // Density of the facets that wo sees, of h: G1 D max(0, wo.h) / cos_o, without its factor wo.h.
    double visible_density(Vec3d h, double cos_o) const;
};

// A facet that wo (wo.z > 0) sees, with density visible_density * wo.h.
Vec3d sample_visible_facet(double alpha, Vec3d wo, Sample2 u);

// In double and of unit length to 1e-14: floats are unit to 1e-7 only, which would tilt the half vector.
inline Vec3d unit_double(Vec3f w)
{
    const Vec3d v = to_double(w);
    return v * (1.5 - 0.5 * dot(v, v));
}

} // namespace renderer
