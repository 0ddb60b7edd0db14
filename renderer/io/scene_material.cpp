#include "renderer/io/scene_material.h"

#include "renderer/io/text.h"
#include "renderer/math/transcendental.h"

#include <assimp/GltfMaterial.h>
#include <assimp/material.h>
#include <assimp/scene.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>

namespace renderer {

namespace {

float factor_of(const aiMaterial& from, float otherwise, const char* key, unsigned type, unsigned index)
{
    ai_real value = otherwise;
    return from.Get(key, type, index, value) == AI_SUCCESS ? value : otherwise;
}

// glTF ignores alpha unless alphaMode says otherwise; many files say BLEND of what is wholly opaque.
bool is_transparent(const aiMaterial& from)
{
    if (factor_of(from, 0, AI_MATKEY_TRANSMISSION_FACTOR) > 0) return true;
    aiString mode;
    if (from.Get(AI_MATKEY_GLTF_ALPHAMODE, mode) != AI_SUCCESS)
        return factor_of(from, 1, AI_MATKEY_OPACITY) < 1; // of other formats
    if (std::string_view(mode.C_Str()) == "OPAQUE") return false;
    return factor_of(from, 1, AI_MATKEY_OPACITY) < 1 || from.GetTextureCount(aiTextureType_BASE_COLOR) > 0 ||
           from.GetTextureCount(aiTextureType_DIFFUSE) > 0;
}

// What a picture would light up in places must not shine all over: it is left out, and told.
void take_emission(const aiMaterial& from, MeshMaterial& to)
{
    aiColor4D light;
    if (from.Get(AI_MATKEY_COLOR_EMISSIVE, light) != AI_SUCCESS) return;
    const auto strength = [](float x) { return std::isfinite(x) && x > 0 ? x : 0.0f; };
    const Rgb emission{strength(light.r), strength(light.g), strength(light.b)};
    if (from.GetTextureCount(aiTextureType_EMISSIVE) > 0)
        to.emits = !is_black(emission);
    else
        to.emission = emission;
}

// A body that KHR_materials_volume fills; without a thickness light passes a thin sheet, which is not modelled.
void take_glass(const aiMaterial& from, MeshMaterial& to)
{
    to.is_glass = factor_of(from, 0, AI_MATKEY_TRANSMISSION_FACTOR) > 0.5f &&
                  factor_of(from, 0, AI_MATKEY_VOLUME_THICKNESS_FACTOR) > 0 && to.metallic < 0.5f;
    if (!to.is_glass) return;
    to.is_transparent = false;
    to.transmission = to.diffuse;
    to.ior = std::clamp(factor_of(from, 1.5f, AI_MATKEY_REFRACTI), 1.0f, kGreatestMeshIor);
    const float distance = factor_of(from, 0, AI_MATKEY_VOLUME_ATTENUATION_DISTANCE);
    aiColor3D left;
    if (!(distance > 0) || from.Get(AI_MATKEY_VOLUME_ATTENUATION_COLOR, left) != AI_SUCCESS) return;
    // After the distance the colour is left of white.
    const auto absorption = [distance](float share) {
        const double s = std::clamp(static_cast<double>(share), 1e-6, 1.0);
        return static_cast<float>(std::clamp(-log(s) / static_cast<double>(distance), 0.0, 1e6));
    };
    to.absorption = {absorption(left.r), absorption(left.g), absorption(left.b)};
}

// What is not modelled, to be told.
void take_left_out(const aiMaterial& from, MeshMaterial& to)
{
    to.is_transparent = is_transparent(from);
    to.is_metal = factor_of(from, 0, AI_MATKEY_METALLIC_FACTOR) > 0;
    to.has_roughness = factor_of(from, 1, AI_MATKEY_ROUGHNESS_FACTOR) < 1;
}

Rgb unit_color(const aiColor4D& c)
{
    return {std::clamp(c.r, 0.0f, 1.0f), std::clamp(c.g, 0.0f, 1.0f), std::clamp(c.b, 0.0f, 1.0f)};
}

// "*3": a picture within the file, whole as it was or as pixels, which no format that is read has.
std::optional<std::uint32_t> image_of(const aiString& name, const aiScene& scene, MeshImages& images)
{
    const auto [embedded, number] = scene.GetEmbeddedTextureAndIndex(name.C_Str());
    if (embedded == nullptr) return images.of_file(name.C_Str());
    if (embedded->mHeight != 0 || embedded->mWidth == 0) return std::nullopt;
    const auto* const bytes = reinterpret_cast<const std::byte*>(embedded->pcData);
    return images.of_bytes("embedded image " + std::to_string(number), {bytes, embedded->mWidth});
}

TextureWrap wrap_of(const aiTextureMapMode mode)
{
    switch (mode) {
    case aiTextureMapMode_Clamp:
    case aiTextureMapMode_Decal:
        return TextureWrap::clamp;
    case aiTextureMapMode_Mirror:
        return TextureWrap::mirror;
    default:
        return TextureWrap::repeat;
    }
}

class PictureReader {
public:
    PictureReader(const aiMaterial& from, const aiScene& scene, MeshImages& images)
        : from_(from), scene_(scene), images_(images)
    {
    }

    std::optional<TextureUse> use(aiTextureType type) const
    {
        aiString name;
        unsigned coordinates = 0;
        aiTextureMapMode modes[3] = {aiTextureMapMode_Wrap, aiTextureMapMode_Wrap, aiTextureMapMode_Wrap};
        if (from_.GetTexture(type, 0, &name, nullptr, &coordinates, nullptr, nullptr, modes) != AI_SUCCESS)
            return std::nullopt;
        if (coordinates != 0) return std::nullopt; // only the first set is kept
        const auto image = image_of(name, scene_, images_);
        if (!image) return std::nullopt;
        TextureUse use;
        use.image = *image;
        use.wrap = wrap_of(modes[0]);
        return use;
    }

private:
    const aiMaterial& from_;
    const aiScene& scene_;
    MeshImages& images_;
};

void name_textures(const aiMaterial& from, MeshMaterial& to)
{
    for (int type = aiTextureType_NONE; type <= AI_TEXTURE_TYPE_MAX; ++type) {
        aiString name;
        if (from.GetTexture(static_cast<aiTextureType>(type), 0, &name) != AI_SUCCESS) continue;
        const std::string clean = name.C_Str()[0] == '*' ? "embedded image " + clean_utf8(name.C_Str() + 1)
                                                         : clean_utf8(name.C_Str());
        if (std::find(to.textures.begin(), to.textures.end(), clean) == to.textures.end())
            to.textures.push_back(clean);
    }
}

// What glTF says of alpha; other formats make no holes.
void take_alpha(const aiMaterial& from, MeshImages& images, MeshMaterial& to)
{
    aiString mode;
    if (from.Get(AI_MATKEY_GLTF_ALPHAMODE, mode) != AI_SUCCESS) return;
    const std::string_view said = mode.C_Str();
    if (said == "OPAQUE" || !to.color_map || !images.has_alpha(to.color_map->image)) return;
    // What is to be blended is nearer to a hole than to nothing where it is thin.
    to.cutoff = said == "MASK" ? factor_of(from, 0.5f, AI_MATKEY_GLTF_ALPHACUTOFF) : 0.5f;
    if (!std::isfinite(to.cutoff)) to.cutoff = 0.5f;
    if (said == "MASK") to.is_transparent = false; // it is modelled
}

void take_pictures(const PictureReader& pictures, MeshMaterial& to)
{
    to.color_map = pictures.use(aiTextureType_BASE_COLOR);
    if (!to.color_map) to.color_map = pictures.use(aiTextureType_DIFFUSE);
    to.physical_map = pictures.use(aiTextureType_UNKNOWN);
    to.emission_map = pictures.use(aiTextureType_EMISSIVE);
    to.normal_map = pictures.use(aiTextureType_NORMALS);
}

} // namespace

void read_scene_material(
    const aiMaterial& from, const aiScene& scene, bool is_assimps_own, MeshImages& images, MeshMaterial& to)
{
    aiColor4D color;
    const bool has_base = from.Get(AI_MATKEY_BASE_COLOR, color) == AI_SUCCESS;
    const bool has_color = has_base || from.Get(AI_MATKEY_COLOR_DIFFUSE, color) == AI_SUCCESS;
    if (has_color) to.diffuse = unit_color(color);
    if (is_assimps_own) return; // it would be metal
    take_emission(from, to);
    take_left_out(from, to);
    take_pictures(PictureReader(from, scene, images), to);
    if (to.color_map && !has_color) to.diffuse = {1, 1, 1};
    to.is_physical = has_base;
    if (has_base) {
        to.metallic = std::clamp(factor_of(from, 1, AI_MATKEY_METALLIC_FACTOR), 0.0f, 1.0f);
        to.roughness = std::clamp(factor_of(from, 1, AI_MATKEY_ROUGHNESS_FACTOR), 0.0f, 1.0f);
        to.opacity = std::clamp(color.a, 0.0f, 1.0f);
        take_glass(from, to);
    }
    take_alpha(from, images, to);
    name_textures(from, to);
}

} // namespace renderer
