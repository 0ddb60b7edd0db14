// Material: what a surface is made of, as a user wrote it.
//
// Units  colours are shares of light, linear Rec. 709; radiance W/(m^2 sr); absorption 1/m. Roughness is
//        what a user sees as even steps: the microfacets' alpha is its square. Below kSmoothBelow a surface
//        is a mirror.
#pragma once

#include "renderer/color/rgb.h"
#include "renderer/description/metals.h"
#include "renderer/description/texture.h"

#include <cstdint>
#include <optional>
#include <string>
#include <variant>

namespace renderer {

// Below this roughness facets do not scatter: a mirror's or a pane's single direction.
inline constexpr double kSmoothBelow = 1e-3;

// What every material says of the surface itself.
struct SurfaceOptions {
    bool two_sided = true;                  // false: from behind it is black
    std::optional<TextureUse> normal_map{}; // tilts the shading normal
    friend bool operator==(const SurfaceOptions&, const SurfaceOptions&) = default;
};

struct DiffuseMaterial {
    TexturedColor color{{0.5f, 0.5f, 0.5f}};
    SurfaceOptions surface{};
    friend bool operator==(const DiffuseMaterial&, const DiffuseMaterial&) = default;
};

enum class PhongForm : std::uint8_t { classic, normalized };

struct PhongMaterial {
    TexturedColor diffuse{{0.5f, 0.5f, 0.5f}};
    TexturedColor specular{{0.2f, 0.2f, 0.2f}};
    double shininess = 32;
    Rgb ambient{0, 0, 0}; // radiance added whatever the light: the k_a i_a of the model, already multiplied
    PhongForm form = PhongForm::normalized;
    SurfaceOptions surface{};
    friend bool operator==(const PhongMaterial&, const PhongMaterial&) = default;
};

struct MirrorMaterial {
    TexturedColor color{{1, 1, 1}};
    SurfaceOptions surface{};
    friend bool operator==(const MirrorMaterial&, const MirrorMaterial&) = default;
};

// The boundary of a body that light passes through; its inside is where its normals do not point.
struct GlassMaterial {
    double ior = 1.5;
    TexturedNumber roughness{0};
    Rgb absorption{0, 0, 0}; // 1/m: of light within, exp(-absorption * way) is left
    // Where bodies overlap, the one of the highest priority fills the place.
    std::uint32_t priority = 0;
    std::optional<TextureUse> normal_map{};
    TexturedColor transmission{{1, 1, 1}}; // of what passes its boundary; only a mesh's own says so
    friend bool operator==(const GlassMaterial&, const GlassMaterial&) = default;
};

// Whether light that meets several facets is modelled.
enum class Multiscatter : std::uint8_t { automatic, on, off };

// Up to this roughness less than 0.6 % of the light meets more than one facet.
inline constexpr double kMultiscatterAbove = 0.2;

inline bool compensates(Multiscatter multiscatter, const TexturedNumber& roughness)
{
    if (multiscatter != Multiscatter::automatic) return multiscatter == Multiscatter::on;
    return roughness.texture || roughness.value > kMultiscatterAbove;
}

// A varnished base, or metal in the share `metallic`.
struct CookTorranceMaterial {
    TexturedColor base_color{{0.5f, 0.5f, 0.5f}};
    TexturedNumber metallic{0};
    TexturedNumber roughness{0.5};
    double ior = 1.5; // of the varnish
    Multiscatter multiscatter = Multiscatter::automatic;
    SurfaceOptions surface{};
    friend bool operator==(const CookTorranceMaterial&, const CookTorranceMaterial&) = default;
};

struct ConductorMaterial {
    std::variant<Metal, ComplexIor> ior{Metal::aluminium};
    TexturedNumber roughness{0};
    Multiscatter multiscatter = Multiscatter::automatic;
    SurfaceOptions surface{};
    friend bool operator==(const ConductorMaterial&, const ConductorMaterial&) = default;
};

// Shines and reflects nothing; from the front only unless two_sided.
struct EmitterMaterial {
    TexturedColor radiance{{1, 1, 1}};
    bool two_sided = false;
    friend bool operator==(const EmitterMaterial&, const EmitterMaterial&) = default;
};

inline ComplexIor complex_ior(const std::variant<Metal, ComplexIor>& ior)
{
    const auto* const metal = std::get_if<Metal>(&ior);
    return metal != nullptr ? complex_ior(*metal) : std::get<ComplexIor>(ior);
}

using Material = std::variant<DiffuseMaterial,
                              PhongMaterial,
                              CookTorranceMaterial,
                              MirrorMaterial,
                              GlassMaterial,
                              ConductorMaterial,
                              EmitterMaterial>;

struct NamedMaterial {
    std::string name;
    Material material;
    friend bool operator==(const NamedMaterial&, const NamedMaterial&) = default;
};

} // namespace renderer
