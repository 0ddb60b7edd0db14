// Layers: what a job may ask for beside its picture, of the first thing that each camera ray hits: the one table
// that film, encoders, content negotiation, the CLI and the documents take them from.
//
// What is first is so whatever it is made of: a pane of glass and a mirror are themselves, not what they show; holes
// of textures are not there. Samples are spread over a pixel as the picture's are, and every one counts alike.
#pragma once

#include "renderer/description/picture_formats.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace renderer {

enum class Layer : std::uint8_t { depth, normal, albedo, samples };

struct LayerEntry {
    Layer layer;
    std::string_view name;
    std::array<std::string_view, 3> channels; // in an OpenEXR file of its own; empty: it has no such
    std::string_view prefix;                  // of them in the picture's OpenEXR file
    bool has_codes;                           // it can be a PNG; OpenEXR and PFM hold every layer
    std::string_view what;

    constexpr std::size_t channel_count() const { return channels[1].empty() ? 1 : channels.size(); }
};

inline constexpr std::array kLayers{
    LayerEntry{
        Layer::depth,
        "depth",
        {"Z", "", ""},
        "",
        false,
        "metres from where a camera ray starts to what it hits, along the ray: the mean of the samples that "
        "hit something; infinity where none does"},
    LayerEntry{
        Layer::normal,
        "normal",
        {"N.X", "N.Y", "N.Z"},
        "",
        true,
        "the shading normal in the world, on the viewer's side: the mean of the unit vectors, shorter than 1 "
        "where they differ or where samples hit nothing, whose normal is 0; as a PNG (n + 1) / 2, linear"},
    LayerEntry{Layer::albedo,
               "albedo",
               {"R", "G", "B"},
               "albedo.",
               true,
               "the share of light from everywhere that the material sends to the camera, linear: 1 for "
               "glass, 0 for "
               "lights and where nothing is hit; as a PNG sRGB"},
    LayerEntry{Layer::samples, "samples", {"samples", "", ""}, "", false, "how many samples the pixel had"},
};

constexpr const LayerEntry& entry_of(Layer layer)
{
    return kLayers[static_cast<std::size_t>(layer)];
}

constexpr const LayerEntry* find_layer(std::string_view name)
{
    for (const LayerEntry& entry : kLayers)
        if (entry.name == name) return &entry;
    return nullptr;
}

constexpr bool holds(PictureFormat format, Layer layer)
{
    return format == PictureFormat::exr || format == PictureFormat::pfm ||
           (format == PictureFormat::png && entry_of(layer).has_codes);
}

// Any of them, in no order. `bits` is kept on disk: a layer's number never changes.
struct LayerSet {
    std::uint32_t bits = 0;

    constexpr bool empty() const { return bits == 0; }
    constexpr bool has(Layer layer) const { return (bits >> static_cast<unsigned>(layer) & 1) != 0; }
    constexpr void add(Layer layer) { bits |= 1u << static_cast<unsigned>(layer); }
    friend constexpr bool operator==(LayerSet, LayerSet) = default;
};

inline constexpr LayerSet kEveryLayer{(1u << kLayers.size()) - 1};

// In words: "depth, normal"; empty for none.
inline std::string names_of(LayerSet layers)
{
    std::string names;
    for (const LayerEntry& entry : kLayers)
        if (layers.has(entry.layer)) names.append(names.empty() ? "" : ", ").append(entry.name);
    return names;
}

} // namespace renderer
