// Glass: a boundary that reflects and refracts, smooth or rough, seen from either side.
//
// Units   eta of the Bsdf: index behind over index on wo's side. At eta 1 there is no boundary: light goes
//         on to the bit.
// Source  smooth: the exact Fresnel term and Snell's law in vector form. Rough: B. Walter et al.,
//         "Microfacet Models for Refraction through Rough Surfaces", EGSR 2007, with height-correlated
//         masking across the boundary.
#pragma once

#include "renderer/materials/bsdf.h"

namespace renderer {

Bsdf make_glass(const GlassMaterial& material);
bool passes_straight(const Bsdf& bsdf);
BsdfValue evaluate_glass(const Bsdf& bsdf, Vec3f wo, Vec3f wi);
BsdfSample sample_smooth_glass(const Bsdf& bsdf, Vec3f wo, float u_lobe);
DeltaLobes delta_lobes_of_glass(const Bsdf& bsdf, Vec3f wo);
// A zero vector where none was drawn.
Vec3f sample_rough_glass(const Bsdf& bsdf, Vec3f wo, float u_lobe, Sample2 u);

} // namespace renderer
