// The values of a material that a picture may give, walked in one order: who reads, prepares or looks up textures
// need not know the materials one by one.
//
// A new material takes part by naming its members as others do.
#pragma once

#include "renderer/description/material.h"
#include "renderer/description/texture.h"

#include <optional>
#include <variant>

namespace renderer {

// Calls f with each Textured<Rgb> and Textured<double> of the material.
template <typename M, typename F>
void for_each_textured_of(M& material, F&& f)
{
    if constexpr (requires { material.color.texture; }) f(material.color);
    if constexpr (requires { material.diffuse.texture; }) f(material.diffuse);
    if constexpr (requires { material.specular.texture; }) f(material.specular);
    if constexpr (requires { material.base_color.texture; }) f(material.base_color);
    if constexpr (requires { material.metallic.texture; }) f(material.metallic);
    if constexpr (requires { material.roughness.texture; }) f(material.roughness);
    if constexpr (requires { material.radiance.texture; }) f(material.radiance);
    if constexpr (requires { material.transmission.texture; }) f(material.transmission);
}

template <typename F>
void for_each_textured(Material& material, F&& f)
{
    std::visit([&](auto& m) { for_each_textured_of(m, f); }, material);
}
template <typename F>
void for_each_textured(const Material& material, F&& f)
{
    std::visit([&](const auto& m) { for_each_textured_of(m, f); }, material);
}

// The picture that tilts its normals; nothing of most.
inline const TextureUse* normal_map_of(const Material& material)
{
    return std::visit(
        [](const auto& m) -> const TextureUse* {
            if constexpr (requires { m.surface.normal_map; })
                return m.surface.normal_map ? &*m.surface.normal_map : nullptr;
            else if constexpr (requires { m.normal_map; })
                return m.normal_map ? &*m.normal_map : nullptr;
            else
                return nullptr;
        },
        material);
}

inline bool is_textured(const Material& material)
{
    bool found = normal_map_of(material) != nullptr;
    for_each_textured(material, [&](const auto& value) { found = found || value.texture.has_value(); });
    return found;
}

} // namespace renderer
