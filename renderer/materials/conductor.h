// Conductor: metal by its complex index of refraction, smooth or rough; and the mirror, which reflects its
// colour.
//
// Source  the exact Fresnel terms of fresnel.h on the facets of microfacet.h; several reflections as
//         layers.h says.
#pragma once

#include "renderer/materials/bsdf.h"

namespace renderer {

Bsdf make_mirror(const MirrorMaterial& material);
Bsdf make_conductor(const ConductorMaterial& material);
// Share that a smooth one reflects to wo.
Rgb mirror_reflectance(const Bsdf& bsdf, Vec3f wo);
BsdfValue evaluate_conductor(const Bsdf& bsdf, Vec3f wo, Vec3f wi);

} // namespace renderer
