#include "renderer/io/read_mtl.h"

#include "renderer/io/import_bounds.h"
#include "renderer/io/text.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace renderer {

namespace {

// A texture's options and how many words follow each; the name is what comes after them and may hold blanks.
struct MapOption {
    std::string_view name;
    int most_words;
    bool numbers_only; // -o, -s, -t take one to three numbers
};
constexpr std::array kMapOptions{
    MapOption{"-blendu", 1, false},
    MapOption{"-blendv", 1, false},
    MapOption{"-boost", 1, false},
    MapOption{"-mm", 2, false},
    MapOption{"-o", 3, true},
    MapOption{"-s", 3, true},
    MapOption{"-t", 3, true},
    MapOption{"-texres", 1, false},
    MapOption{"-clamp", 1, false},
    MapOption{"-bm", 1, false},
    MapOption{"-imfchan", 1, false},
    MapOption{"-type", 1, false},
    MapOption{"-cc", 1, false},
};

std::string_view texture_name(std::string_view line)
{
    while (true) {
        std::string_view rest = line;
        const std::string_view word = take_word(rest);
        const auto option = std::find_if(
            kMapOptions.begin(), kMapOptions.end(), [&](const MapOption& o) { return o.name == word; });
        if (option == kMapOptions.end()) return trimmed(line);
        for (int i = 0; i < option->most_words; ++i) {
            std::string_view after = rest;
            const std::string_view value = take_word(after);
            if (option->numbers_only && !parse_float(value)) break;
            rest = after;
        }
        line = rest;
    }
}

// One number is a grey; values beyond [0, 1] would make energy.
bool take_color(std::string_view line, Rgb& color)
{
    const auto r = take_float(line);
    const std::string_view rest = trimmed(line);
    const auto g = rest.empty() ? r : take_float(line), b = rest.empty() ? r : take_float(line);
    if (!r || !g || !b || !is_finite(Vec3f{*r, *g, *b})) return false;
    color = {std::clamp(*r, 0.0f, 1.0f), std::clamp(*g, 0.0f, 1.0f), std::clamp(*b, 0.0f, 1.0f)};
    return true;
}

bool take_shininess(std::string_view line, float& shininess)
{
    const auto value = take_float(line);
    if (!value || !std::isfinite(*value) || *value < 0) return false;
    shininess = *value;
    return true;
}

bool is_map(std::string_view word)
{
    return word.starts_with("map_") || word == "bump" || word == "disp" || word == "decal" ||
           word == "refl" || word == "norm";
}

} // namespace

bool read_mtl(std::string_view text,
              std::string_view file,
              std::vector<MeshMaterial>& materials,
              std::vector<std::string>& notes)
{
    MeshMaterial* material = nullptr;
    Lines lines(text, true);
    while (const auto line = lines.next()) {
        std::string_view rest = *line;
        const std::string_view word = take_word(rest);
        bool good = true;
        if (word == "newmtl") {
            if (materials.size() == kMostMaterials) return false;
            materials.push_back({clean_utf8(trimmed(rest)), {}, {}, 0, {}});
            material = &materials.back();
        } else if (!material) {
            good = word != "Kd" && word != "Ks" && word != "Ns";
        } else if (word == "Kd") {
            good = take_color(rest, material->diffuse);
        } else if (word == "Ks") {
            good = take_color(rest, material->specular);
        } else if (word == "Ns") {
            good = take_shininess(rest, material->shininess);
        } else if (is_map(word) && material->textures.size() < 64) {
            const std::string name = clean_utf8(texture_name(rest));
            if (!name.empty()) material->textures.push_back(name);
        }
        if (!good && notes.size() < kMostNotes)
            notes.push_back("material file " + clean_utf8(file) + ", line " + std::to_string(lines.number()) +
                            ": " + quoted(trimmed(*line)) + " cannot be read; the default stays");
    }
    return true;
}

} // namespace renderer
