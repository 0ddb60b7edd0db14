#include "renderer/scene/mesh_materials.h"

#include <algorithm>
#include <cstdint>
#include <optional>

namespace renderer {

namespace {

// glTF's: metallic in the blue of its picture, roughness in the green.
Material physical(const MeshMaterial& m)
{
    const auto channel_of = [&m](std::uint8_t channel) {
        std::optional<TextureUse> use = m.physical_map;
        if (use) use->channel = channel;
        return use;
    };
    CookTorranceMaterial out;
    out.base_color = {m.diffuse, m.color_map};
    out.metallic = {static_cast<double>(m.metallic), channel_of(2)};
    out.roughness = {static_cast<double>(m.roughness), channel_of(1)};
    out.ior = static_cast<double>(m.ior);
    out.surface.two_sided = m.two_sided;
    return out;
}

Material glass(const MeshMaterial& m)
{
    GlassMaterial out;
    out.ior = static_cast<double>(m.ior);
    out.absorption = {m.absorption};
    out.transmission = {m.transmission, {}};
    if (!m.is_physical) return out; // smooth, and its picture is of what it reflects
    out.transmission.texture = m.color_map;
    std::optional<TextureUse> map = m.physical_map;
    if (map) map->channel = 1;
    out.roughness = {static_cast<double>(m.roughness), map};
    return out;
}

Material plain(const MeshMaterial& m)
{
    if (m.is_glass) return glass(m);
    if (m.is_physical) return physical(m);
    if (is_black(m.specular) || !(m.shininess > 0)) {
        DiffuseMaterial diffuse;
        diffuse.color = {m.diffuse, m.color_map};
        return diffuse;
    }
    const Rgb sum = m.diffuse + m.specular;
    const float scale = 1 / std::max({1.0f, sum.r, sum.g, sum.b});
    PhongMaterial phong;
    phong.diffuse = {m.diffuse * scale, m.color_map};
    phong.specular = {m.specular * scale, m.specular_map};
    phong.shininess = static_cast<double>(m.shininess);
    return phong;
}

} // namespace

TexturedMaterial from_mesh(const MeshMaterial& m)
{
    return {.material = plain(m),
            .values_are_factors = true,
            .normal_map = m.normal_map,
            .alpha_map = m.alpha_map,
            .opacity = m.opacity,
            .cutoff = m.cutoff,
            .emission = m.emission};
}

} // namespace renderer
