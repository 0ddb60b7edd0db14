// The texts of the flat form: words, lists and plain numbers one after the other, and back. What comes back is
// hostile: every size is checked, names are UTF-8.
#pragma once

#include "renderer/geometry/mesh.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace server {

inline constexpr std::uint32_t kLongestText = 4096;

bool is_utf8(std::string_view text);

class TextWriter {
public:
    template <typename T>
    requires std::is_arithmetic_v<T>
    void add(T value) { bytes_.append(reinterpret_cast<const char*>(&value), sizeof value); }
    void add(renderer::Rgb color)
    {
        add(color.r);
        add(color.g);
        add(color.b);
    }
    void add(const std::string& text)
    {
        const auto size = static_cast<std::uint32_t>(std::min<std::size_t>(text.size(), kLongestText));
        add(size);
        bytes_.append(text, 0, size);
    }
    template <typename T>
    void add(const std::vector<T>& list)
    {
        add(static_cast<std::uint32_t>(list.size()));
        for (const T& entry : list)
            add(entry);
    }
    void add(const renderer::MeshMaterial& m)
    {
        add(m.name);
        add(m.diffuse);
        add(m.specular);
        add(m.shininess);
        add(m.textures);
        for (const bool is :
             {m.emits, m.is_transparent, m.is_metal, m.has_roughness, m.is_physical, m.is_glass, m.two_sided})
            add(static_cast<std::uint8_t>(is));
        for (const float value : {m.metallic, m.roughness, m.ior, m.opacity, m.cutoff})
            add(value);
        add(m.absorption);
        add(m.transmission);
        add(m.emission);
        for (const auto* const map :
             {&m.color_map, &m.specular_map, &m.alpha_map, &m.physical_map, &m.emission_map, &m.normal_map})
            add(*map);
    }
    // Of a mesh's file nothing but these is ever said.
    void add(const std::optional<renderer::TextureUse>& map)
    {
        add(static_cast<std::uint8_t>(map.has_value()));
        if (!map) return;
        add(map->image);
        add(static_cast<std::uint8_t>(map->wrap));
        add(map->channel);
    }
    void add(const renderer::Image& image)
    {
        add(image.width);
        add(image.height);
        add(image.channels);
        add(static_cast<std::uint8_t>(image.type));
    }
    void add(const renderer::MeshImage& i)
    {
        add(i.name);
        add(i.image);
    }
    void add(const renderer::MeshPart& p)
    {
        add(p.name);
        add(p.first_triangle);
        add(p.triangle_count);
    }
    std::span<const std::byte> bytes() const { return std::as_bytes(std::span(bytes_)); }

private:
    std::string bytes_;
};

// Every take() returns false, and takes nothing more, once the bytes do not hold what is asked for.
class TextReader {
public:
    explicit TextReader(std::span<const std::byte> bytes) : rest_(bytes) {}

    template <typename T>
    requires std::is_arithmetic_v<T>
    bool take(T& value)
    {
        if (rest_.size() < sizeof value) return false;
        std::memcpy(&value, rest_.data(), sizeof value);
        rest_ = rest_.subspan(sizeof value);
        return true;
    }
    bool take_flag(bool& flag)
    {
        std::uint8_t byte = 0;
        if (!take(byte) || byte > 1) return false;
        flag = byte == 1;
        return true;
    }
    bool take(renderer::Rgb& color) { return take(color.r) && take(color.g) && take(color.b); }
    bool take(std::string& text)
    {
        std::uint32_t size = 0;
        if (!take(size) || size > kLongestText || size > rest_.size()) return false;
        text.assign(reinterpret_cast<const char*>(rest_.data()), size);
        rest_ = rest_.subspan(size);
        return is_utf8(text);
    }
    template <typename T>
    bool take(std::vector<T>& list)
    {
        std::uint32_t size = 0;
        if (!take(size) || size > rest_.size()) return false; // each entry takes a byte at least
        for (std::uint32_t i = 0; i < size; ++i)
            if (!take(list.emplace_back())) return false;
        return true;
    }
    bool take(renderer::MeshMaterial& m)
    {
        return take(m.name) && take(m.diffuse) && take(m.specular) && take(m.shininess) && take(m.textures) &&
               take_flag(m.emits) && take_flag(m.is_transparent) && take_flag(m.is_metal) &&
               take_flag(m.has_roughness) && take_flag(m.is_physical) && take_flag(m.is_glass) &&
               take_flag(m.two_sided) && take(m.metallic) && take(m.roughness) && take(m.ior) &&
               take(m.opacity) && take(m.cutoff) && take(m.absorption) && take(m.transmission) &&
               take(m.emission) && take_map(m.color_map) && take_map(m.specular_map) &&
               take_map(m.alpha_map) && take_map(m.physical_map) && take_map(m.emission_map) &&
               take_map(m.normal_map);
    }
    bool take_map(std::optional<renderer::TextureUse>& map)
    {
        bool is_there = false;
        if (!take_flag(is_there)) return false;
        if (!is_there) return true;
        std::uint8_t wrap = 0;
        renderer::TextureUse& use = map.emplace();
        if (!take(use.image) || !take(wrap) || wrap > 2 || !take(use.channel)) return false;
        use.wrap = static_cast<renderer::TextureWrap>(wrap);
        return true;
    }
    bool take(renderer::Image& image)
    {
        std::uint8_t type = 0;
        if (!take(image.width) || !take(image.height) || !take(image.channels) || !take(type)) return false;
        image.type = static_cast<renderer::PixelType>(type); // judged with the rest of it
        return true;
    }
    bool take(renderer::MeshImage& i) { return take(i.name) && take(i.image); }
    bool take(renderer::MeshPart& p)
    {
        return take(p.name) && take(p.first_triangle) && take(p.triangle_count);
    }
    bool at_end() const { return rest_.empty(); }

private:
    std::span<const std::byte> rest_;
};

} // namespace server
