#include "api/words/word_table.h"

#include "renderer/description/image_formats.h"
#include "renderer/description/layers.h"
#include "renderer/description/mesh_formats.h"
#include "renderer/description/picture_formats.h"

#include <array>
#include <cassert>
#include <cstddef>

namespace api {

using renderer::BvhLevels;
using renderer::BvhSplit;
using renderer::BvhWidth;
using renderer::Environment;
using renderer::Light;
using renderer::Material;
using renderer::Metal;
using renderer::MeterQuantity;
using renderer::Multiscatter;
using renderer::PhongForm;
using renderer::Projection;
using renderer::Shading;
using renderer::Shape;
using renderer::Tone;
using renderer::TransportType;

template <>
WordTable words_for<Material>()
{
    static constexpr std::array words{alternative<Material, renderer::DiffuseMaterial>("diffuse"),
                                      alternative<Material, renderer::PhongMaterial>("phong"),
                                      alternative<Material, renderer::CookTorranceMaterial>("cook_torrance"),
                                      alternative<Material, renderer::MirrorMaterial>("mirror"),
                                      alternative<Material, renderer::GlassMaterial>("glass"),
                                      alternative<Material, renderer::ConductorMaterial>("conductor"),
                                      alternative<Material, renderer::EmitterMaterial>("emitter")};
    return words;
}

template <>
WordTable words_for<Shape>()
{
    static constexpr std::array words{alternative<Shape, renderer::RectangleShape>("rectangle"),
                                      alternative<Shape, renderer::DiskShape>("disk"),
                                      alternative<Shape, renderer::BoxShape>("box"),
                                      alternative<Shape, renderer::SphereShape>("sphere")};
    return words;
}

template <>
WordTable words_for<Light>()
{
    static constexpr std::array words{alternative<Light, renderer::PointLight>("point"),
                                      alternative<Light, renderer::SpotLight>("spot"),
                                      alternative<Light, renderer::DirectionalLight>("directional"),
                                      alternative<Light, renderer::SunLight>("sun"),
                                      alternative<Light, renderer::RectangleLight>("rectangle"),
                                      alternative<Light, renderer::DiskLight>("disk"),
                                      alternative<Light, renderer::SphereLight>("sphere")};
    return words;
}

template <>
WordTable words_for<Environment>()
{
    static constexpr std::array words{
        alternative<Environment, renderer::NoEnvironment>("none"),
        alternative<Environment, renderer::ColorEnvironment>("color"),
        alternative<Environment, renderer::ImageEnvironment>("image"),
        alternative<Environment, renderer::AtmosphereDescription>("atmosphere")};
    return words;
}

template <>
WordTable words_for<PhongForm>()
{
    static constexpr std::array words{enumerator("classic", PhongForm::classic),
                                      enumerator("normalized", PhongForm::normalized)};
    return words;
}

template <>
WordTable words_for<Multiscatter>()
{
    static constexpr std::array words{enumerator("auto", Multiscatter::automatic),
                                      enumerator("on", Multiscatter::on),
                                      enumerator("off", Multiscatter::off)};
    return words;
}

template <>
WordTable words_for<Metal>()
{
    static constexpr std::array words{enumerator("aluminium", Metal::aluminium),
                                      enumerator("chromium", Metal::chromium),
                                      enumerator("copper", Metal::copper),
                                      enumerator("gold", Metal::gold),
                                      enumerator("iron", Metal::iron),
                                      enumerator("nickel", Metal::nickel),
                                      enumerator("platinum", Metal::platinum),
                                      enumerator("silver", Metal::silver),
                                      enumerator("titanium", Metal::titanium),
                                      enumerator("tungsten", Metal::tungsten)};
    return words;
}

template <>
WordTable words_for<Shading>()
{
    static constexpr std::array words{enumerator("auto", Shading::automatic),
                                      enumerator("smooth", Shading::smooth),
                                      enumerator("flat", Shading::flat)};
    return words;
}

template <>
WordTable words_for<TransportType>()
{
    static constexpr std::array words{enumerator("auto", TransportType::automatic),
                                      enumerator("direct", TransportType::direct),
                                      enumerator("whitted", TransportType::whitted),
                                      enumerator("path", TransportType::path),
                                      enumerator("ambient_occlusion", TransportType::ambient_occlusion),
                                      enumerator("normals", TransportType::normals)};
    return words;
}

template <>
WordTable words_for<Tone>()
{
    static constexpr std::array words{enumerator("srgb", Tone::srgb),
                                      enumerator("linear", Tone::linear),
                                      enumerator("filmic", Tone::filmic)};
    return words;
}

template <>
WordTable words_for<renderer::TextureWrap>()
{
    static constexpr std::array words{enumerator("repeat", renderer::TextureWrap::repeat),
                                      enumerator("clamp", renderer::TextureWrap::clamp),
                                      enumerator("mirror", renderer::TextureWrap::mirror)};
    return words;
}

template <>
WordTable words_for<renderer::TextureFilter>()
{
    static constexpr std::array words{enumerator("linear", renderer::TextureFilter::linear),
                                      enumerator("nearest", renderer::TextureFilter::nearest)};
    return words;
}

template <>
WordTable words_for<renderer::TextureEncoding>()
{
    static constexpr std::array words{enumerator("srgb", renderer::TextureEncoding::srgb),
                                      enumerator("linear", renderer::TextureEncoding::linear)};
    return words;
}

template <>
WordTable words_for<BvhSplit>()
{
    static constexpr std::array words{enumerator("sah", BvhSplit::sah),
                                      enumerator("midpoint", BvhSplit::midpoint),
                                      enumerator("spatial", BvhSplit::spatial)};
    return words;
}

template <>
WordTable words_for<BvhWidth>()
{
    static constexpr std::array words{enumerator("wide", BvhWidth::wide),
                                      enumerator("binary", BvhWidth::binary)};
    return words;
}

template <>
WordTable words_for<BvhLevels>()
{
    static constexpr std::array words{enumerator("two", BvhLevels::two),
                                      enumerator("mesh", BvhLevels::mesh),
                                      enumerator("none", BvhLevels::none)};
    return words;
}

template <>
WordTable words_for<Projection>()
{
    static constexpr std::array words{enumerator("perspective", Projection::perspective),
                                      enumerator("orthographic", Projection::orthographic),
                                      enumerator("panorama", Projection::panorama),
                                      enumerator("meter", Projection::meter)};
    return words;
}

template <>
WordTable words_for<MeterQuantity>()
{
    static constexpr std::array words{enumerator("radiance", MeterQuantity::radiance),
                                      enumerator("irradiance", MeterQuantity::irradiance)};
    return words;
}

WordTable fail_on_words()
{
    static constexpr std::array words{Word{"non_finite", 0}, Word{"target_missed"}};
    return words;
}

WordTable layer_words()
{
    static constexpr auto words = [] {
        std::array<Word, renderer::kLayers.size() + 1> all{};
        for (std::size_t i = 0; i < renderer::kLayers.size(); ++i)
            all[i] = enumerator(renderer::kLayers[i].name, renderer::kLayers[i].layer);
        all.back() = Word{"error"};
        return all;
    }();
    return words;
}

WordTable mesh_format_words()
{
    static constexpr auto words = [] {
        std::array<Word, renderer::kMeshFormats.size()> all{};
        for (std::size_t i = 0; i < all.size(); ++i)
            all[i] = Word{renderer::kMeshFormats[i].name, static_cast<int>(i)};
        return all;
    }();
    return words;
}

WordTable texture_format_words()
{
    static constexpr auto words = [] {
        std::array<Word, renderer::kImageFormats.size()> all{};
        for (std::size_t i = 0; i < all.size(); ++i)
            all[i] = Word{renderer::kImageFormats[i].name, static_cast<int>(i)};
        return all;
    }();
    return words;
}

WordTable image_format_words()
{
    static constexpr auto words = [] {
        std::array<Word, renderer::kPictureFormats.size()> all{};
        for (std::size_t i = 0; i < all.size(); ++i)
            all[i] = Word{renderer::kPictureFormats[i].media_type, static_cast<int>(i)};
        return all;
    }();
    return words;
}

const Word* find_word(WordTable words, std::string_view name)
{
    for (const Word& word : words)
        if (word.name == name) return &word;
    return nullptr;
}

std::string_view name_of(WordTable words, int value)
{
    for (const Word& word : words)
        if (word.value == value) return word.name;
    assert(false && "every alternative has its word");
    return "unknown";
}

std::vector<std::string> names_of(WordTable words)
{
    std::vector<std::string> names;
    for (const Word& word : words)
        if (word.built()) names.emplace_back(word.name);
    return names;
}

} // namespace api
