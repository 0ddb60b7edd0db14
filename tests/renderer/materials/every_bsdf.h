// Bsdfs to hold every property of the set against: each kind, mild and extreme.
#pragma once

#include "renderer/materials/bsdf.h"
#include "renderer/math/transcendental.h"

#include <string>
#include <vector>

namespace tests {

// At an angle from the normal, degrees; beyond 90 below the surface.
inline renderer::Vec3f at_angle(double degrees, double phi_deg = 20)
{
    const auto [s, c] = renderer::sin_cos_deg(degrees);
    const auto [sp, cp] = renderer::sin_cos_deg(phi_deg);
    return renderer::to_float({s * cp, s * sp, c});
}

inline renderer::Bsdf diffuse(float albedo)
{
    return make_bsdf(renderer::DiffuseMaterial{{{albedo, albedo, albedo}}});
}

inline renderer::Bsdf phong(double shininess, renderer::PhongForm form, float kd = 0.4f, float ks = 0.6f)
{
    renderer::PhongMaterial m;
    m.diffuse.value = {kd, kd, kd};
    m.specular.value = {ks, ks, ks};
    m.shininess = shininess;
    m.form = form;
    return make_bsdf(m);
}

inline renderer::Bsdf glass(double ior, double roughness)
{
    return make_bsdf(renderer::GlassMaterial{.ior = ior, .roughness = {roughness}});
}

// Seen from within: the index behind is the air's.
inline renderer::Bsdf glass_from_within(double ior, double roughness)
{
    renderer::Bsdf bsdf = glass(ior, roughness);
    bsdf.eta = static_cast<float>(1 / ior);
    return bsdf;
}

inline renderer::Bsdf conductor(float eta, float k, double roughness)
{
    renderer::ConductorMaterial m;
    m.ior = renderer::ComplexIor{{eta, eta, eta}, {k, k, k}};
    m.roughness.value = roughness;
    return make_bsdf(m);
}

inline renderer::CookTorranceMaterial varnish(float base, double metallic, double roughness, double ior = 1.5)
{
    renderer::CookTorranceMaterial m;
    m.base_color.value = {base, base, base};
    m.metallic.value = metallic;
    m.roughness.value = roughness;
    m.ior = ior;
    return m;
}

// Facets that reflect all they get.
inline renderer::Bsdf white_facets(double roughness, renderer::Multiscatter multiscatter)
{
    renderer::CookTorranceMaterial m = varnish(1, 1, roughness);
    m.multiscatter = multiscatter;
    return make_bsdf(m);
}

struct NamedBsdf {
    std::string name;
    renderer::Bsdf bsdf;
};

inline std::vector<NamedBsdf> phong_bsdfs()
{
    std::vector<NamedBsdf> all;
    for (const double n : {0.0, 1.0, 30.0, 500.0}) {
        all.push_back({"phong_normalized " + std::to_string(n), phong(n, renderer::PhongForm::normalized)});
        all.push_back({"phong_classic " + std::to_string(n), phong(n, renderer::PhongForm::classic)});
    }
    return all;
}

// Of facets, by roughness; some with a base that stays where they are smooth.
inline std::vector<NamedBsdf> rough_bsdfs(double roughness)
{
    const std::string of = " of roughness " + std::to_string(roughness);
    return {{"conductor" + of, conductor(0.2f, 3.9f, roughness)},
            {"varnish" + of, make_bsdf(varnish(0.8f, 0, roughness))},
            {"half metal" + of, make_bsdf(varnish(0.5f, 0.5, roughness))},
            {"metal" + of, make_bsdf(varnish(0.9f, 1, roughness))},
            {"thin varnish" + of, make_bsdf(varnish(0.8f, 0.2, roughness, 0.7))},
            {"black varnish" + of, make_bsdf(varnish(0, 0, roughness, 1.5))},
            {"glass" + of, glass(1.5, roughness)},
            {"glass from within" + of, glass_from_within(1.5, roughness)},
            {"dense glass" + of, glass(1e3, roughness)},
            {"thin glass" + of, glass(1e-3, roughness)},
            {"faint glass" + of, glass(1.001, roughness)}};
}

inline std::vector<NamedBsdf> delta_bsdfs()
{
    std::vector<NamedBsdf> all;
    for (const NamedBsdf& named : rough_bsdfs(0))
        if (is_delta_only(named.bsdf)) all.push_back(named);
    all.push_back({"mirror", make_bsdf(renderer::MirrorMaterial{{{0.8f, 0.8f, 0.8f}}})});
    all.push_back({"no glass", glass(1, 0)});
    all.push_back({"no rough glass", glass(1, 0.5)});
    all.push_back({"emitter", make_bsdf(renderer::EmitterMaterial{})});
    return all;
}

inline std::vector<NamedBsdf> every_bsdf()
{
    std::vector<NamedBsdf> all{{"diffuse", diffuse(0.7f)}};
    const auto add = [&](const std::vector<NamedBsdf>& more) {
        all.insert(all.end(), more.begin(), more.end());
    };
    add(phong_bsdfs());
    for (const double roughness : {0.0, 1e-3, 0.03, 0.1, 0.5, 1.0})
        add(rough_bsdfs(roughness));
    add(delta_bsdfs());
    return all;
}

} // namespace tests
