// CookTorrance: a varnished base: facets of a dielectric, or of metal where `metallic` says so, over what
// is diffuse.
//
// Source  R. Cook, K. Torrance, "A Reflectance Model for Computer Graphics", 1982, with the normalisation
//         of Walter et al. 2007 and their D and G (microfacet.h); C. Schlick's approximation of F by the
//         cosine to the facet, 1994, except below ior 1, where the exact term rises to total reflection;
//         the base as layers.h says, so that nothing comes out brighter than it went in.
// Mixing  metallic m: (1 - m) of a dielectric of that ior over base_color, m of a metal that reflects
//         base_color at normal incidence.
#pragma once

#include "renderer/materials/bsdf.h"

namespace renderer {

Bsdf make_cook_torrance(const CookTorranceMaterial& material);
BsdfValue evaluate_cook_torrance(const Bsdf& bsdf, Vec3f wo, Vec3f wi);
// Of one whose facets are smooth: the base alone.
BsdfValue evaluate_smooth_cook_torrance(const Bsdf& bsdf, Vec3f wo, Vec3f wi);
BsdfSample sample_smooth_cook_torrance(const Bsdf& bsdf, Vec3f wo, float u_lobe, Sample2 u);
// What its facets mirror to wo.
Rgb varnish_reflectance(const Bsdf& bsdf, double cosine);

} // namespace renderer
