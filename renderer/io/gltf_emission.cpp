#include "renderer/io/gltf_emission.h"

#include "renderer/io/json_scan.h"
#include "renderer/io/text.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <limits>

namespace renderer {

namespace {

// Where a value stands in the JSON.
struct Place {
    std::size_t first = 0, end = 0;
};

struct Emission {
    std::optional<Place> factor, strength;
};

class EmissionReader {
public:
    explicit EmissionReader(std::string_view json) : scan_(json) {}

    // False: the JSON is not of glTF's shape.
    bool read(std::vector<Emission>& materials)
    {
        return scan_.object([&](std::string_view key) {
            if (key != "materials") return scan_.skip();
            return scan_.array([&] { return material(materials.emplace_back()); });
        });
    }

private:
    bool value(std::optional<Place>& place)
    {
        const std::size_t first = scan_.fault_offset();
        if (!scan_.skip()) return false;
        place = {first, scan_.fault_offset()};
        return true;
    }
    bool strength(Emission& emission)
    {
        return scan_.object([&](std::string_view key) {
            return key == "emissiveStrength" ? value(emission.strength) : scan_.skip();
        });
    }
    bool extensions(Emission& emission)
    {
        return scan_.object([&](std::string_view key) {
            return key == "KHR_materials_emissive_strength" ? strength(emission) : scan_.skip();
        });
    }
    bool material(Emission& emission)
    {
        return scan_.object([&](std::string_view key) {
            if (key == "emissiveFactor") return value(emission.factor);
            return key == "extensions" ? extensions(emission) : scan_.skip();
        });
    }

    JsonScan scan_;
};

// Without blanks around it; lines end wherever they like.
std::string_view bare(std::string_view text)
{
    constexpr std::string_view kBlanks = " \t\r\n";
    const std::size_t first = text.find_first_not_of(kBlanks);
    if (first == text.npos) return {};
    return text.substr(first, text.find_last_not_of(kBlanks) + 1 - first);
}

std::string_view text_at(std::string_view json, const Place& place)
{
    return bare(json.substr(place.first, place.end - place.first));
}

// "[1, 0.5, 0]"; nothing if it is anything else.
std::optional<std::array<float, 3>> three_numbers(std::string_view text)
{
    if (text.size() < 2 || text.front() != '[' || text.back() != ']') return std::nullopt;
    text = text.substr(1, text.size() - 2);
    std::array<float, 3> numbers{};
    for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t comma = std::min(text.find(','), text.size());
        if ((comma == text.size()) != (i == 2)) return std::nullopt;
        const auto number = parse_float(bare(text.substr(0, comma)));
        if (!number) return std::nullopt;
        numbers[i] = *number;
        text.remove_prefix(std::min(comma + 1, text.size()));
    }
    return numbers;
}

std::string scaled(const std::array<float, 3>& factor, float strength)
{
    std::string text = "[";
    for (const float number : factor) {
        char digits[32];
        constexpr double kMost = std::numeric_limits<float>::max();
        const double light = static_cast<double>(number) * static_cast<double>(strength);
        std::snprintf(digits, sizeof digits, "%.9g", std::min(light, kMost));
        text.append(text.size() > 1 ? "," : "").append(digits);
    }
    return text + "]";
}

void append_word(std::vector<std::byte>& bytes, std::size_t word)
{
    for (unsigned shift = 0; shift < 32; shift += 8)
        bytes.push_back(static_cast<std::byte>(word >> shift & 0xff));
}

} // namespace

std::optional<std::string> with_emissive_strength(std::string_view json)
{
    std::vector<Emission> materials;
    if (!EmissionReader(json).read(materials)) return std::nullopt;
    std::string out;
    std::size_t copied = 0;                      // of json
    for (const Emission& emission : materials) { // in the order of the text
        if (!emission.factor || !emission.strength) continue;
        const auto factor = three_numbers(text_at(json, *emission.factor));
        const auto strength = parse_float(text_at(json, *emission.strength));
        if (!factor || !strength || !std::isfinite(*strength) || *strength < 0 || *strength == 1) continue;
        out.append(json, copied, emission.factor->first - copied).append(scaled(*factor, *strength));
        copied = emission.factor->end;
    }
    if (copied == 0) return std::nullopt;
    return out.append(json, copied);
}

std::vector<std::byte>
glb_with_json(std::span<const std::byte> glb, std::size_t json_length, std::string_view json)
{
    constexpr std::size_t kHead = 12, kChunkHead = 8;
    const auto rest = glb.subspan(kHead + kChunkHead + json_length);
    const std::size_t padded = (json.size() + 3) / 4 * 4;
    const std::size_t length = kHead + kChunkHead + padded + rest.size();
    std::vector<std::byte> out;
    if (length > std::numeric_limits<std::uint32_t>::max()) return {glb.begin(), glb.end()};
    out.reserve(length);
    out.insert(out.end(), glb.begin(), glb.begin() + 8); // magic, version
    append_word(out, length);
    append_word(out, padded);
    out.insert(out.end(), glb.begin() + 16, glb.begin() + 20); // "JSON"
    for (std::size_t i = 0; i < padded; ++i)
        out.push_back(static_cast<std::byte>(i < json.size() ? json[i] : ' '));
    out.insert(out.end(), rest.begin(), rest.end());
    return out;
}

} // namespace renderer
