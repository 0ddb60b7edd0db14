#include "renderer/io/read_mtl.h"

#include "renderer/io/import_bounds.h"
#include "renderer/io/text.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

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

// One number is a grey.
bool take_numbers(std::string_view line, Rgb& color)
{
    const auto r = take_float(line);
    const std::string_view rest = trimmed(line);
    const auto g = rest.empty() ? r : take_float(line), b = rest.empty() ? r : take_float(line);
    if (!r || !g || !b || !is_finite(Vec3f{*r, *g, *b})) return false;
    color = {*r, *g, *b};
    return true;
}

// Values beyond [0, 1] would make energy.
bool take_color(std::string_view line, Rgb& color)
{
    Rgb found;
    if (!take_numbers(line, found)) return false;
    color = {
        std::clamp(found.r, 0.0f, 1.0f), std::clamp(found.g, 0.0f, 1.0f), std::clamp(found.b, 0.0f, 1.0f)};
    return true;
}

std::optional<float> take_number(std::string_view line)
{
    const auto value = take_float(line);
    return value && std::isfinite(*value) ? value : std::nullopt;
}

bool take_shininess(std::string_view line, float& shininess)
{
    const auto value = take_number(line);
    if (!value || *value < 0) return false;
    shininess = *value;
    return true;
}

bool is_map(std::string_view word)
{
    return word.starts_with("map_") || word == "bump" || word == "disp" || word == "decal" ||
           word == "refl" || word == "norm";
}

bool is_bump(std::string_view word)
{
    return word == "bump" || word == "map_bump" || word == "map_Bump";
}

// Whether the material's line has a value beyond `least`: for what is told and not modelled.
bool take_above(std::string_view line, float least, bool& above)
{
    const auto value = take_number(line);
    if (value) above = *value > least;
    return value.has_value();
}

bool take_below(std::string_view line, float most, bool& below)
{
    const auto value = take_number(line);
    if (value) below = *value < most;
    return value.has_value();
}

bool take_dissolve(std::string_view line, bool& is_transparent)
{
    std::string_view rest = line;
    if (take_word(rest) == "-halo") line = rest;
    return take_below(line, 1, is_transparent);
}

// Light may be of any strength, but not below nothing.
bool take_emission(std::string_view line, Rgb& emission)
{
    Rgb light;
    if (!take_numbers(line, light)) return false;
    emission = {std::max(light.r, 0.0f), std::max(light.g, 0.0f), std::max(light.b, 0.0f)};
    return true;
}

class MtlReader {
public:
    MtlReader(std::string_view text,
              std::string_view file,
              MeshImages& images,
              std::vector<MeshMaterial>& materials,
              std::vector<std::string>& notes)
        : lines_(text, true), file_(file), images_(images), materials_(materials), notes_(notes)
    {
    }
    bool read();

private:
    bool statement(std::string_view word, std::string_view rest);
    bool property(std::string_view word, std::string_view rest);
    void map(std::string_view word, std::string_view rest);
    bool take_glass(std::string_view line);
    bool take_ior(std::string_view line);
    void end_material();
    void note(const std::string& what)
    {
        if (notes_.size() < kMostNotes) notes_.push_back("material file " + what);
    }

    Lines lines_;
    std::string_view file_;
    MeshImages& images_;
    std::vector<MeshMaterial>& materials_;
    std::vector<std::string>& notes_;
    MeshMaterial* material_ = nullptr;
    bool has_color_ = false;
    bool has_bumps_ = false;
    std::size_t colorless_ = 0, bumpy_ = 0;
    std::string colorless_names_; // of the first few
};

// False where the line cannot be read.
bool MtlReader::property(std::string_view word, std::string_view rest)
{
    MeshMaterial& m = *material_;
    if (word == "Kd") {
        const bool good = take_color(rest, m.diffuse);
        has_color_ = has_color_ || good;
        return good;
    }
    if (word == "Ks") return take_color(rest, m.specular);
    if (word == "Ns") return take_shininess(rest, m.shininess);
    if (word == "Tf") return take_color(rest, m.transmission);
    if (word == "Ke") return take_emission(rest, m.emission);
    if (word == "d") return take_dissolve(rest, m.is_transparent);
    if (word == "Tr") return take_above(rest, 0, m.is_transparent);
    if (word == "illum") return take_glass(rest);
    if (word == "Ni") return take_ior(rest);
    if (word == "Pm") return take_above(rest, 0, m.is_metal);
    if (word == "Pr") return take_below(rest, 1, m.has_roughness);
    if (is_map(word)) map(word, rest);
    return true;
}

// Models 4, 6 and 7 are glass that rays are traced through. 9 is what exporters write of whatever is thin.
bool MtlReader::take_glass(std::string_view line)
{
    const auto model = take_number(line);
    if (model) material_->is_glass = *model == 4 || *model == 6 || *model == 7;
    return model.has_value();
}

bool MtlReader::take_ior(std::string_view line)
{
    const auto ior = take_number(line);
    if (!ior || *ior < 1) return false;
    material_->ior = std::min(*ior, kGreatestMeshIor);
    return true;
}

void MtlReader::map(std::string_view word, std::string_view rest)
{
    MeshMaterial& m = *material_;
    const std::string_view name = texture_name(rest);
    if (name.empty() || m.textures.size() == 64) return;
    m.textures.push_back(clean_utf8(name));
    if (word == "map_Ke") m.emits = true;
    if (is_bump(word)) has_bumps_ = true;
    std::optional<TextureUse>* const use = word == "map_Kd"                       ? &m.color_map
                                           : word == "map_Ks"                     ? &m.specular_map
                                           : word == "map_d"                      ? &m.alpha_map
                                           : word == "norm" || word == "map_norm" ? &m.normal_map
                                                                                  : nullptr;
    if (use == nullptr || *use) return;
    const auto image = images_.of_file(name);
    if (!image) return;
    use->emplace().image = *image;
    if (rest.find("-clamp on") != rest.npos) (*use)->wrap = TextureWrap::clamp;
    if (use != &m.alpha_map) return;
    (*use)->channel = images_.has_alpha(*image) ? 3 : 0;
    m.cutoff = 0.5f;
}

// Grey and not black: a material without a colour is one whose colour is not known. It is so too where a
// texture that is not there would give the colour, which is nearer to most textures than white.
void MtlReader::end_material()
{
    constexpr std::size_t kMostNames = 4;
    if (!material_) return;
    if (has_bumps_) ++bumpy_;
    if (material_->is_glass) material_->is_transparent = false; // it is modelled
    // What a picture would light up in places must not shine all over.
    if (material_->emits) material_->emission = {};
    if (has_color_) return;
    if (material_->color_map) {
        material_->diffuse = {1, 1, 1};
        return;
    }
    if (++colorless_ <= kMostNames)
        colorless_names_ += (colorless_ > 1 ? ", " : "") + in_quotes(material_->name);
    else if (colorless_ == kMostNames + 1)
        colorless_names_ += ", ...";
}

bool MtlReader::statement(std::string_view word, std::string_view rest)
{
    if (!material_) return word != "Kd" && word != "Ks" && word != "Ns";
    return property(word, rest);
}

bool MtlReader::read()
{
    constexpr std::size_t kMostBadLines = 8; // told one by one: there must be room for other notes
    std::size_t bad_lines = 0;
    while (const auto line = lines_.next()) {
        std::string_view rest = *line;
        const std::string_view word = take_word(rest);
        if (word == "newmtl") {
            end_material();
            if (materials_.size() == kMostMaterials) return false;
            material_ = &materials_.emplace_back();
            material_->name = clean_utf8(trimmed(rest));
            has_color_ = has_bumps_ = false;
        } else if (!statement(word, rest) && ++bad_lines <= kMostBadLines) {
            note(clean_utf8(file_) + ", line " + std::to_string(lines_.number()) + ": " +
                 in_quotes(trimmed(*line)) + " cannot be read; the default stays");
        }
    }
    end_material();
    if (colorless_)
        note(in_quotes(file_) + ": " + std::to_string(colorless_) +
             (colorless_ == 1 ? " material has no readable Kd and is grey (0.5): "
                              : " materials have no readable Kd and are grey (0.5): ") +
             colorless_names_);
    if (bumpy_)
        note(in_quotes(file_) + ": " + std::to_string(bumpy_) +
             (bumpy_ == 1 ? " material has a bump map" : " materials have bump maps") +
             ", heights in no known unit, which are left out; a map of normals is named by norm");
    return true;
}

} // namespace

bool read_mtl(std::string_view text,
              std::string_view file,
              MeshImages& images,
              std::vector<MeshMaterial>& materials,
              std::vector<std::string>& notes)
{
    return MtlReader(text, file, images, materials, notes).read();
}

} // namespace renderer
