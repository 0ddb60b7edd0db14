// Bsdf: how a surface scatters light: a closed set, as eval / sample / pdf.
//
// Frame   local: z is the shading normal, on the viewer's side (every material is two-sided); wo and wi are
//         unit and point away from the surface.
// Units   eval is f(wo, wi) |cos(wi)| in 1/sr; pdfs per steradian.
// Source  diffuse: Lambert. phong_normalized: E. Lafortune, Y. Willems, "Using the Modified Phong Reflectance
//         Model for Physically Based Rendering", 1994: f = kd/pi + ks (n+2)/(2 pi) (R.V)^n, reciprocal, and
//         no more energy out than in while kd + ks <= 1. phong_classic: B. Phong, 1975, as it is usually
//         programmed: kd (N.L) + ks (R.V)^n times the irradiance on a facing surface, without 1/pi; neither
//         reciprocal nor conserving. R = 2 (N.L) N - L; both dot products clamped at 0; nothing where N.L <=
//         0.
// Cost    a switch, no virtual call, no allocation.
#pragma once

#include "renderer/color/rgb.h"
#include "renderer/description/scene_description.h"
#include "renderer/sampling/warp.h"

#include <cstdint>

namespace renderer {

enum class BsdfKind : std::uint8_t { diffuse, phong_classic, phong_normalized };

struct Bsdf {
    BsdfKind kind = BsdfKind::diffuse;
    Rgb diffuse{0.5f, 0.5f, 0.5f};
    Rgb specular{};
    Rgb ambient{}; // radiance added whatever the light
    double shininess = 0;
    float lobe_share = 0; // of the samples, drawn around the mirror direction
};

Bsdf make_bsdf(const Material& material);

struct BsdfSample {
    Vec3f wi{};
    Rgb weight{};  // eval / pdf; black below the horizon
    float pdf = 0; // 0: no direction was drawn
};

Rgb eval(const Bsdf& bsdf, Vec3f wo, Vec3f wi);
float pdf(const Bsdf& bsdf, Vec3f wo, Vec3f wi);
// u_lobe chooses what to draw from, u where.
BsdfSample sample(const Bsdf& bsdf, Vec3f wo, float u_lobe, Sample2 u);

} // namespace renderer
