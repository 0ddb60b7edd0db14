// Fresnel: the share of unpolarised light that a smooth boundary reflects.
//
// Units   cosines in [0, 1] of the angle of incidence; eta = index behind over index in front.
// Source  M. Born, E. Wolf, "Principles of Optics", 7th ed., 1.5.2 and 14.2; the average: S. Duntley, "The
//         Optical Properties of Diffusing Materials", JOSA 32, 1942; the approximation: C. Schlick, "An
//         Inexpensive BRDF Model for Physically-based Rendering", 1994.
#pragma once

#include "renderer/color/rgb.h"

namespace renderer {

// What a ray of that cosine meets at a dielectric.
struct DielectricBoundary {
    double reflected = 1;       // share; 1: total internal reflection
    double cos_transmitted = 0; // 0 where all is reflected
};
DielectricBoundary meet_dielectric(double cos_incident, double eta);

double fresnel_dielectric(double cos_incident, double eta);
// eta + i k against the medium in front.
double fresnel_conductor(double cos_incident, double eta, double k);
Rgb fresnel_conductor(double cos_incident, Rgb eta, Rgb k);

// At normal incidence, ((eta - 1) / (eta + 1))^2.
double normal_reflectance(double eta);

// (1 - cos)^5: a dielectric of eta >= 1 reflects about f0 + (1 - f0) of it. Too far from the truth below
// eta 1.
double schlick_weight(double cos_incident);

// Average of light from everywhere, 2 * integral of F(c) c dc.
double average_fresnel_dielectric(double eta);
double average_fresnel_conductor(double eta, double k);

} // namespace renderer
