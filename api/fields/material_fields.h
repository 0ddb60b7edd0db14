// The members of materials: see job_fields.h.
#pragma once

#include "api/fields/ranges.h"
#include "api/fields/sees.h"
#include "renderer/description/material.h"

namespace api {

template <typename V, Sees<renderer::SurfaceOptions> X>
void surface_fields(V& v, X& surface)
{
    v.boolean("two_sided", surface.two_sided, "false: from behind it is black");
    v.object("normal_map",
             surface.normal_map,
             "tilts the normals: red is right, green up, blue out of the surface, 1/2 is none");
}

template <typename V, Sees<renderer::DiffuseMaterial> X>
void fields(V& v, X& material)
{
    v.textured_color("color", material.color, kReflectance, "share of the light that is scattered");
    surface_fields(v, material.surface);
}

template <typename V, Sees<renderer::PhongMaterial> X>
void fields(V& v, X& material)
{
    v.textured_color("diffuse", material.diffuse, kReflectance, "k_d");
    v.textured_color("specular", material.specular, kReflectance, "k_s");
    v.number("shininess", material.shininess, kShininess, "exponent n of the highlight");
    v.color("ambient", material.ambient, kRadiometric, "radiance added whatever the light, W/(m^2 sr)");
    v.word("form", material.form, "classic: as Phong wrote it; normalized: conserves energy");
    surface_fields(v, material.surface);
}

inline constexpr const char* kMultiscatterDoc =
    "light that meets several facets; auto: where roughness is above 0.2 or a texture";

template <typename V, Sees<renderer::CookTorranceMaterial> X>
void fields(V& v, X& material)
{
    v.textured_color("base_color", material.base_color, kReflectance, "of the base, or of the metal");
    v.textured_number("metallic", material.metallic, kShare, "0: a base under varnish; 1: metal");
    v.textured_number("roughness", material.roughness, kShare, "0: smooth; the facets' alpha is its square");
    v.number("ior", material.ior, kIor, "index of refraction of the varnish");
    v.word("multiscatter", material.multiscatter, kMultiscatterDoc);
    surface_fields(v, material.surface);
}

template <typename V, Sees<renderer::MirrorMaterial> X>
void fields(V& v, X& material)
{
    v.textured_color("color", material.color, kReflectance, "share of the light that is reflected");
    surface_fields(v, material.surface);
}

template <typename V, Sees<renderer::GlassMaterial> X>
void fields(V& v, X& material)
{
    v.number("ior", material.ior, kIor, "index of refraction of what is within");
    v.textured_number("roughness", material.roughness, kShare, "0: clear; the facets' alpha is its square");
    v.color("absorption",
            material.absorption,
            kAbsorption,
            "1/m: exp(-absorption * way) is left of light within");
    v.integer(
        "priority", material.priority, kGlassPriority, "where bodies overlap the highest fills the place");
    v.object("normal_map", material.normal_map, "tilts the normals, as of other materials");
}

template <typename V, Sees<renderer::ConductorMaterial> X>
void fields(V& v, X& material)
{
    v.metal_of(material.ior);
    v.textured_number(
        "roughness", material.roughness, kShare, "0: a mirror; the facets' alpha is its square");
    v.word("multiscatter", material.multiscatter, kMultiscatterDoc);
    surface_fields(v, material.surface);
}

template <typename V, Sees<renderer::EmitterMaterial> X>
void fields(V& v, X& material)
{
    v.textured_color("radiance", material.radiance, kRadiometric, "W/(m^2 sr)");
    v.boolean("two_sided", material.two_sided, "false: only the front shines");
}

} // namespace api
