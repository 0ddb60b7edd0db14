// Layers: what a surface of facets scatters beside each facet's own reflection: light that has met several
// facets, and the base that light reaches through them.
//
// Both depend on wo and wi as a product of one factor each, so they are reciprocal; with albedos that are
// upper bounds the whole never gives more light than it gets.
//
// Source  several facets: C. Kulla, A. Conty, "Revisiting Physically Based Shading at Imageworks", 2017,
//         the average colour of every order: F^2 E / (1 - F (1 - E)), F and E averages. The base: C.
//         Kelemen, L. Szirmay-Kalos, "A Microfacet Based Coupled Specular-Matte BRDF Model", 2001: (1 -
//         E(wo)) (1 - E(wi)) of it, E what the layer above reflects.
#pragma once

#include "renderer/color/rgb.h"

namespace renderer {

struct Layers {
    Rgb f0{};                   // what a facet reflects of light at normal incidence: for shares and albedo
    Rgb several{};              // colour of light that has met several facets; black: left out
    float one_over_missing = 0; // 1 / (pi times what a white one's first reflections miss on average), 1/sr
    Rgb base{};                 // its colour; black: none
    float base_scale = 0;       // 1 / (pi times what reaches the base on average), 1/sr
    // The layer above reflects white * E_white + slanted * E_slanted + several_white * (1 - E_white) of
    // what comes to the base.
    float white = 0, slanted = 0, several_white = 0;
};

// Colour of light that has met several facets of average Fresnel term `average_f`, where first reflections
// are `white_average`.
float several_facets(double average_f, double white_average);

// One layer of index `ior` on `base`, of facets that scatter light several times or (`compensated` false)
// lose it.
void put_on_base(Layers& layers, Rgb base, double ior, double roughness, bool compensated);

// Shares of the light from everywhere that go to one direction.
struct LayerAlbedo {
    Rgb facets{}, several{}, base{};
    double missing = 0; // 1 - E_white
    double to_base = 0; // share that reaches the base
    Rgb sum() const { return facets + several + base; }
};
LayerAlbedo layer_albedo(const Layers& layers, double cosine, double roughness);

// f of several facets and base together, 1/sr, without its cosine.
Rgb below_facets(const Layers& layers, const LayerAlbedo& o, const LayerAlbedo& i);

// Of the samples, how many to draw from the facets.
float facet_share(const LayerAlbedo& o);

} // namespace renderer
