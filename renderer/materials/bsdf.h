// Bsdf: how a surface scatters light: a closed set, as eval / sample / pdf.
//
// Frame   local: z is the shading normal, on the viewer's side; wo and wi are unit and point away from the
//         surface. wi.z < 0 is light from the other side, which only glass lets through.
// Units   eval is f(wo, wi) |cos(wi)| in 1/sr; pdfs per steradian. Radiance is what is carried:
//         transmission has its factor 1 / eta^2 (E. Veach, thesis, 1997, 5.2). Directions that a surface
//         reflects or refracts without scattering (delta lobes) have no eval and no pdf; sample and
//         delta_lobes give them.
// Source  diffuse: Lambert. phong.h, microfacet.h, layers.h, cook_torrance.h, conductor.h, glass.h name
//         theirs.
// Cost    a switch, no virtual call, no allocation.
#pragma once

#include "renderer/color/rgb.h"
#include "renderer/description/material.h"
#include "renderer/materials/layers.h"
#include "renderer/math/vec3.h"
#include "renderer/sampling/sampler.h"

#include <array>
#include <cstddef>
#include <cstdint>

namespace renderer {

enum class BsdfKind : std::uint8_t {
    diffuse,
    phong_classic,
    phong_normalized,
    cook_torrance,
    smooth_cook_torrance,
    mirror,
    glass,
    rough_glass,
    conductor,
    rough_conductor,
    black // an emitter, or a one-sided surface seen from behind
};

// What fills a body of glass.
struct GlassMedium {
    float ior = 1.5f;
    std::uint32_t priority = 0;
    Rgb absorption{}; // 1/m
    friend bool operator==(const GlassMedium&, const GlassMedium&) = default;
};

struct Bsdf {
    BsdfKind kind = BsdfKind::diffuse;
    bool two_sided = true; // else seen from behind it is black
    float lobe_share = 0;  // Phong: of the samples, drawn around the mirror direction
    float roughness = 0;   // its square is alpha, the width of the facets' slopes
    float eta = 1; // glass: index behind over index on wo's side, at first as from vacuum; cook_torrance: ior
    Rgb diffuse{0.5f, 0.5f, 0.5f}; // glass: of what passes, the share that is let through
    Rgb specular{};                // Phong: k_s; mirror: its colour; conductor: eta
    Rgb k{};                       // conductor
    Rgb ambient{};                 // radiance added whatever the light
    Rgb emission{};                // radiance that an emitter sends out, from its front or both sides
    double shininess = 0;
    float share_below_one = 0; // cook_torrance: the share that is a dielectric, if its ior is below 1
    Layers layers{};           // cook_torrance, conductor
    GlassMedium medium{};
};

// From the plain values, without textures.
Bsdf make_bsdf(const Material& material);

// Nothing that light could be sent to: eval and pdf are 0 everywhere.
bool is_delta_only(const Bsdf& bsdf);
// Some light passes to the other side.
bool transmits(const Bsdf& bsdf);

struct BsdfSample {
    Vec3f wi{};
    Rgb weight{};  // eval / pdf; of a delta lobe its share of the light over its probability
    float pdf = 0; // of a delta lobe its probability; 0: no direction was drawn
    bool is_delta = false;
    bool is_transmission = false;
};

Rgb eval(const Bsdf& bsdf, Vec3f wo, Vec3f wi);
float pdf(const Bsdf& bsdf, Vec3f wo, Vec3f wi);
// Both at once, for less than twice the work.
struct BsdfValue {
    Rgb f{};
    float pdf = 0;
};
BsdfValue evaluate(const Bsdf& bsdf, Vec3f wo, Vec3f wi);
// u_lobe chooses what to draw from, u where.
BsdfSample sample(const Bsdf& bsdf, Vec3f wo, float u_lobe, Sample2 u);
// The same of a diffuse one, by a direction that was drawn by its cosine.
BsdfSample diffuse_sample(const Bsdf& bsdf, Vec3f drawn);

// Every direction that is reflected or refracted without scattering, each with its whole share: for
// recursion that follows all.
struct DeltaLobe {
    Vec3f wi{};
    Rgb weight{};
    bool is_transmission = false;
};
struct DeltaLobes {
    std::array<DeltaLobe, 2> lobes;
    std::size_t count = 0;
};
DeltaLobes delta_lobes(const Bsdf& bsdf, Vec3f wo);

// Share of the light from everywhere that goes to wo, both sides together; where no closed form is known an
// estimate.
Rgb albedo(const Bsdf& bsdf, Vec3f wo);

} // namespace renderer
