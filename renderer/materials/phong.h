// Phong: the empirical highlight, cos^n around the mirror direction, beside a diffuse part.
//
// Source  phong_normalized: E. Lafortune, Y. Willems, "Using the Modified Phong Reflectance Model for
//         Physically Based Rendering", 1994: f = kd/pi + ks (n+2)/(2 pi) (R.V)^n, reciprocal, and no more
//         energy out than in while kd + ks <= 1. phong_classic: B. Phong, 1975, as it is usually
//         programmed: kd (N.L) + ks (R.V)^n times the irradiance on a facing surface, without 1/pi; neither
//         reciprocal nor conserving. R = 2 (N.L) N - L; both dot products clamped at 0; nothing where N.L
//         <= 0.
#pragma once

#include "renderer/materials/bsdf.h"

namespace renderer {

Bsdf make_phong(const PhongMaterial& material);
Rgb eval_phong(const Bsdf& bsdf, Vec3f wo, Vec3f wi);
float pdf_phong(const Bsdf& bsdf, Vec3f wo, Vec3f wi);
Vec3f sample_phong(const Bsdf& bsdf, Vec3f wo, float u_lobe, Sample2 u);
Rgb albedo_phong(const Bsdf& bsdf); // at normal incidence, where it is largest

} // namespace renderer
