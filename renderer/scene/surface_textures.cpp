#include "renderer/scene/surface_textures.h"

#include "renderer/description/textured_values.h"

#include <algorithm>
#include <cmath>
#include <type_traits>
#include <variant>

namespace renderer {

namespace {

constexpr float kUsualCutoff = 0.5f;

float unit(float x)
{
    return x > 0 ? std::min(x, 1.0f) : 0.0f;
}

Rgb unit(Rgb c)
{
    return {unit(c.r), unit(c.g), unit(c.b)};
}

// The value that a colour would be without its picture; that of a picture with alpha may make holes.
const TextureUse* main_color(const Material& material)
{
    const TextureUse* found = nullptr;
    for_each_textured(material, [&](const auto& value) {
        if constexpr (std::is_same_v<std::decay_t<decltype(value.value)>, Rgb>)
            if (found == nullptr && value.texture) found = &*value.texture;
    });
    return found;
}

constexpr TextureFootprint kEverything{{1e9, 0}, {0, 1e9}};

} // namespace

std::uint32_t
SurfaceTextures::texture(const SharedImage& image, TextureEncoding encoding, TextureFilter filter)
{
    const auto [entry, is_new] =
        known_.try_emplace({image.get(), encoding, filter}, static_cast<std::uint32_t>(textures_.size()));
    // Nearest texels need no levels but for their mean, which is a light's.
    if (is_new) textures_.emplace_back(image, encoding, filter == TextureFilter::linear);
    return entry->second;
}

bool SurfaceTextures::take(std::optional<TextureUse>& use, std::span<const SharedImage> images, bool is_color)
{
    if (!use) return false;
    const SharedImage& image = images[use->image];
    use->image = texture(image, encoding_of(*use, *image, is_color), use->filter);
    return true;
}

Material SurfaceTextures::add(std::uint32_t material,
                              const TexturedMaterial& textured,
                              std::span<const SharedImage> images)
{
    TexturedMaterial entry = textured;
    bool any = false;
    for_each_textured(entry.material, [&](auto& value) {
        any = take(value.texture, images, std::is_same_v<std::decay_t<decltype(value.value)>, Rgb>) || any;
    });
    any = take(entry.normal_map, images, false) || any;
    if (take(entry.alpha_map, images, false)) {
        any = true;
        if (!textures_[entry.alpha_map->image].has_alpha()) entry.alpha_map->channel = 0;
    } else if (const TextureUse* const color = main_color(entry.material)) {
        const bool makes_holes = !entry.values_are_factors || entry.cutoff > 0;
        if (makes_holes && textures_[color->image].has_alpha()) {
            entry.alpha_map = *color;
            entry.alpha_map->channel = 3;
            if (entry.cutoff == 0) entry.cutoff = kUsualCutoff;
        }
    }
    if (!any) return textured.material;
    has_holes_ = has_holes_ || (entry.alpha_map && entry.cutoff > 0);
    of_material_.resize(std::max<std::size_t>(of_material_.size(), material + std::size_t{1}), kNone);
    of_material_[material] = static_cast<std::uint32_t>(entries_.size());
    entries_.push_back(entry);

    Material mean = entry.material;
    for_each_textured(mean, [&](auto& value) {
        if (!value.texture) return;
        const Rgba found = lookup(*value.texture, {0.5, 0.5}, kEverything);
        using Value = std::decay_t<decltype(value.value)>;
        if constexpr (std::is_same_v<Value, Rgb>)
            value.value = entry.values_are_factors ? value.value * found.color : found.color;
        else
            value.value = static_cast<double>(number_of(*value.texture, found)) *
                          (entry.values_are_factors ? value.value : 1);
        value.texture.reset();
    });
    return mean;
}

Rgba SurfaceTextures::lookup(const TextureUse& use, TexturePoint at, const TextureFootprint& footprint) const
{
    const TexturePoint scaled{at.u * use.scale_u, at.v * use.scale_v};
    const TextureFootprint wide{{footprint.long_axis.u * use.scale_u, footprint.long_axis.v * use.scale_v},
                                {footprint.short_axis.u * use.scale_u, footprint.short_axis.v * use.scale_v}};
    return textures_[use.image].lookup(scaled, use.wrap, use.filter, wide);
}

float SurfaceTextures::number_of(const TextureUse& use, const Rgba& found) const
{
    const float number = use.channel == 0   ? found.color.r
                         : use.channel == 1 ? found.color.g
                         : use.channel == 2 ? found.color.b
                                            : found.alpha;
    return unit(number);
}

Bsdf SurfaceTextures::bsdf_at(const TexturedMaterial& textured,
                              TexturePoint at,
                              const TextureFootprint& footprint,
                              bool from_camera) const
{
    Material material = textured.material;
    const bool shines = std::holds_alternative<EmitterMaterial>(material);
    for_each_textured(material, [&](auto& value) {
        if (!value.texture) return;
        const Rgba found = lookup(*value.texture, at, shines && !from_camera ? kEverything : footprint);
        using Value = std::decay_t<decltype(value.value)>;
        if constexpr (std::is_same_v<Value, Rgb>) {
            const Rgb color = shines ? found.color : unit(found.color);
            value.value = textured.values_are_factors ? value.value * color : color;
        } else {
            value.value = static_cast<double>(number_of(*value.texture, found)) *
                          (textured.values_are_factors ? value.value : 1);
        }
    });
    Bsdf bsdf = make_bsdf(material);
    bsdf.emission += textured.emission;
    return bsdf;
}

Vec3d SurfaceTextures::tilt_at(const TextureUse& use,
                               TexturePoint at,
                               const TextureFootprint& footprint) const
{
    const Rgb code = lookup(use, at, footprint).color;
    const auto component = [](float x) { return 2 * static_cast<double>(x) - 1; };
    return {component(code.r), component(code.g), std::max(component(code.b), 0.0)};
}

bool SurfaceTextures::is_hole(const TexturedMaterial& textured, TexturePoint at) const
{
    if (!textured.alpha_map || !(textured.cutoff > 0)) return false;
    const float alpha = number_of(*textured.alpha_map, lookup(*textured.alpha_map, at, {}));
    return alpha * textured.opacity < textured.cutoff;
}

std::uint64_t SurfaceTextures::size_bytes() const
{
    std::uint64_t bytes = 0;
    for (const Texture& texture : textures_)
        bytes += texture.size_bytes();
    return bytes;
}

} // namespace renderer
