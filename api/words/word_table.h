// Words of the contract that choose among things: what a `type` may be, which of them are built.
//
// One table each, here; the reader, the writer, the schema and /v1/capabilities all look there. A word that
// scene.md knows and this build does not answers `unsupported`, one that nobody knows `unknown_value`.
#pragma once

#include "renderer/description/atmosphere.h"
#include "renderer/description/scene_description.h"
#include "renderer/description/settings.h"

#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <variant>
#include <vector>

namespace api {

inline constexpr int kNotBuilt = -1;

struct Word {
    std::string_view name;
    int value = kNotBuilt; // enumerator, or index of the alternative in its variant

    [[nodiscard]] constexpr bool built() const { return value != kNotBuilt; }
};
using WordTable = std::span<const Word>;

// Index of alternative T in the variant V.
template <typename T, typename V>
inline constexpr int kIndexIn = -1;
template <typename T, typename... Ts>
inline constexpr int kIndexIn<T, std::variant<Ts...>> = [] {
    int index = 0;
    const bool found = ((std::is_same_v<T, Ts> || (++index, false)) || ...);
    return found ? index : -1;
}();

template <typename V, typename T>
constexpr Word alternative(std::string_view name)
{
    static_assert(kIndexIn<T, V> >= 0);
    return {name, kIndexIn<T, V>};
}

template <typename E>
constexpr Word enumerator(std::string_view name, E value)
{
    return {name, static_cast<int>(value)};
}

// The table of a variant or an enumeration of the description.
template <typename T>
WordTable words_for();
template <>
WordTable words_for<renderer::Material>();
template <>
WordTable words_for<renderer::Shape>(); // without mesh, which is no word but a member
template <>
WordTable words_for<renderer::Light>();
template <>
WordTable words_for<renderer::Environment>();
template <>
WordTable words_for<std::variant<renderer::AtmosphereDescription>>(); // an environment that stands alone
template <>
WordTable words_for<renderer::AtmospherePreset>();
template <>
WordTable words_for<renderer::MiePhase>();
template <>
WordTable words_for<renderer::SkyScattering>();
template <>
WordTable words_for<renderer::SkyMode>();
template <>
WordTable words_for<renderer::PhongForm>();
template <>
WordTable words_for<renderer::Multiscatter>();
template <>
WordTable words_for<renderer::Metal>();
template <>
WordTable words_for<renderer::Shading>();
template <>
WordTable words_for<renderer::TransportType>();
template <>
WordTable words_for<renderer::Projection>();
template <>
WordTable words_for<renderer::MeterQuantity>();
template <>
WordTable words_for<renderer::Tone>();
template <>
WordTable words_for<renderer::TextureWrap>();
template <>
WordTable words_for<renderer::TextureFilter>();
template <>
WordTable words_for<renderer::TextureEncoding>();
template <>
WordTable words_for<renderer::BvhSplit>();
template <>
WordTable words_for<renderer::BvhWidth>();
template <>
WordTable words_for<renderer::BvhLevels>();

// Words without a value of their own: the one that is built is what happens.
WordTable fail_on_words();

// Of renderer::Layer.
WordTable layer_words();

// What importer and encoder speak; held against them by tests.
WordTable mesh_format_words();
WordTable texture_format_words();
WordTable image_format_words();

const Word* find_word(WordTable words, std::string_view name);
// The name of an enumerator or alternative; it must be in the table.
std::string_view name_of(WordTable words, int value);
// Those that are built.
std::vector<std::string> names_of(WordTable words);

} // namespace api
