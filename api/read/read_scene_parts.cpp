// The parts of a scene whose words refer to other parts: cameras' aims, materials, meshes.
#include "api/fields/job_fields.h"
#include "api/json/pointer.h"
#include "api/read/read_fields.h"
#include "api/words/digest.h"
#include "api/words/sentences.h"
#include "renderer/math/transcendental.h"

namespace api {

namespace {

constexpr const char* kDigestForm = "a digest is \"sha256:\" and 64 lower-case hex digits";

}

void ReadFields::aim(renderer::CameraDescription& camera)
{
    exclude("look_at", "direction", "give the point that is looked at, or the way, not both");
    const bool aimed_at_point = node_ && node_->contains("look_at");
    renderer::Vec3d way = camera.aim;
    const bool has_direction = direction("direction", way, nullptr);
    point("look_at", camera.aim, nullptr);
    if (has_direction && !aimed_at_point) {
        camera.aim = way;
        camera.aim_is_direction = true;
    }
    if (!node_ || node_->contains("direction") || camera.aim != camera.position ||
        state_.faults.touches(pointer_))
        return;
    if (aimed_at_point)
        fault(at("look_at"), "zero_length", "look_at equals position: give another point, or a direction");
    else
        fault(at("position"),
              "zero_length",
              "position equals the default look_at: give look_at or a direction");
}

void ReadFields::sun_angles(renderer::Vec3d& travels)
{
    double elevation = 0, azimuth = 0;
    const bool has_elevation = number("elevation_deg", elevation, kElevation, nullptr),
               has_azimuth = number("azimuth_deg", azimuth, kTurn, nullptr);
    exclude("direction", "elevation_deg", "give the way the light travels, or where the sun stands");
    exclude("direction", "azimuth_deg", "give the way the light travels, or where the sun stands");
    if (!has_elevation && !has_azimuth) return;
    const auto [sin_e, cos_e] = renderer::sin_cos_deg(elevation);
    const auto [sin_a, cos_a] = renderer::sin_cos_deg(azimuth);
    travels = {-cos_e * sin_a, -sin_e, cos_e * cos_a};
}

void ReadFields::table(const char* name, std::vector<renderer::NamedMaterial>& materials, const char*)
{
    const Json* node = find(name);
    if (!node) return;
    if (!node->is_object()) {
        state_.materials_unreadable = true;
        return wrong_type(at(name), "an object of materials by name", *node);
    }
    for (const auto& [key, value] : node->items()) {
        const std::string pointer = pointer_to(at(name), key);
        if (!name_fits(pointer, key)) continue;
        state_.materials.emplace(key, static_cast<std::uint32_t>(materials.size()));
        state_.material_names.push_back(key);
        read_kind(value, pointer, materials.emplace_back(renderer::NamedMaterial{key, {}}).material);
    }
}

void ReadFields::material_of(std::optional<std::uint32_t>& material)
{
    const Json* node = find("material");
    if (!node) return;
    if (!node->is_string())
        return fault(at("material"),
                     "wrong_type",
                     std::string("expected the name of a material, got ") + type_words(*node) +
                         ": describe it in /scene/materials and give its name here");
    const auto& name = node->get_ref<const std::string&>();
    const auto found = state_.materials.find(name);
    if (found != state_.materials.end())
        material = found->second;
    else if (!state_.materials_unreadable)
        fault(at("material"),
              "unknown_reference",
              "there is no material " + in_quotes(name) + "; there are: " + listed(state_.material_names) +
                  did_you_mean(name, state_.material_names));
}

void ReadFields::metal_of(std::variant<renderer::Metal, renderer::ComplexIor>& ior)
{
    constexpr const char* one_of_them = "give the metal's name, or its eta and k";
    exclude("metal", "eta", one_of_them);
    exclude("metal", "k", one_of_them);
    renderer::Metal metal{};
    const bool is_named = node_ && node_->contains("metal");
    word("metal", metal, nullptr);
    renderer::ComplexIor given;
    color("eta", given.eta, kIor, nullptr);
    color("k", given.k, kExtinction, nullptr);
    if (is_named) {
        ior = metal;
    } else if (node_ && (node_->contains("eta") || node_->contains("k"))) {
        needs({"eta", "k"});
        ior = given;
    }
}

void ReadFields::geometry(renderer::Shape& shape)
{
    if (!node_) return;
    if (node_->contains("mesh")) {
        exclude("mesh", "shape", "an object is one of them");
        forgiving_ = node_->contains("shape"); // then size and radius are no further fault
        known_.push_back("shape");
        shape = renderer::MeshShape{};
        return mesh_of(std::get<renderer::MeshShape>(shape));
    }
    if (!node_->contains("shape")) {
        find("mesh"), find("part"), find("shape");
        forgiving_ = true;
        return fault(pointer_,
                     "missing_member",
                     "an object needs \"mesh\", the name or digest of a file, or \"shape\", one of " +
                         listed(names_of(words_for<renderer::Shape>())));
    }
    forgiving_ = !alternative_named("shape", shape);
}

void ReadFields::mesh_of(renderer::MeshShape& shape)
{
    if (const std::string* part = text("part", kLongestName)) shape.part = *part;
    const std::string* name = text("mesh", kLongestName);
    if (!name) return;
    const auto [found, is_new] =
        state_.meshes.emplace(*name, static_cast<std::uint32_t>(state_.job.scene.meshes.size()));
    shape.mesh = found->second;
    if (is_new) state_.job.scene.meshes.push_back({*name, digest_for(*name, at("mesh"))});
}

bool ReadFields::texture(const char* name, std::optional<renderer::TextureUse>& use)
{
    if (!node_ || !node_->contains(name) || !node_->at(name).is_object()) return false;
    read_object(*find(name), at(name), use.emplace());
    return true;
}

void ReadFields::image_of(std::uint32_t& image)
{
    const std::string* name = text("image", kLongestName);
    if (!name) return;
    std::vector<renderer::ImageReference>& images = state_.job.scene.images;
    const auto [found, is_new] = state_.images.emplace(*name, static_cast<std::uint32_t>(images.size()));
    image = found->second;
    if (is_new) images.push_back({*name, digest_for(*name, at("image")), at("image")});
}

// Empty where the name is a path of a local render, or a fault was told.
std::string ReadFields::digest_for(const std::string& name, const std::string& pointer)
{
    if (const auto file = state_.job.files.find(name); file != state_.job.files.end()) return file->second;
    if (is_digest(name)) {
        digest_check(name, pointer);
        return name;
    }
    if (names_digest(name)) {
        fault(pointer, "bad_digest", in_quotes(name) + " is no digest: " + kDigestForm);
    } else if (!state_.context.local && !state_.files_unreadable) {
        std::vector<std::string> names;
        for (const auto& file : state_.job.files)
            names.push_back(file.first);
        fault(pointer,
              "missing_asset",
              "there is no file " + in_quotes(name) +
                  ": name its digest in \"files\", or send it along as a part of "
                  "that name; files are: " +
                  listed(names) + did_you_mean(name, names));
    }
    return {};
}

void ReadFields::digest_check(const std::string& digest, const std::string& pointer)
{
    if (state_.context.has_asset && !state_.context.has_asset(digest))
        fault(pointer, "missing_asset", digest + " is not uploaded: PUT /v1/assets/" + digest);
}

void ReadFields::files(std::map<std::string, std::string>& files)
{
    const Json* node = find("files");
    if (node && !node->is_object()) {
        state_.files_unreadable = true;
        wrong_type(at("files"), "an object of digests by name", *node);
    } else if (node) {
        for (const auto& [name, value] : node->items())
            file(name, value, files);
    }
    for (const auto& [name, digest] : state_.context.files) {
        const std::string pointer = pointer_to(at("files"), name);
        if (!is_utf8(name)) {
            fault(at("files"), "not_utf8", "a part's name is not UTF-8: rename it");
        } else if (name_fits(pointer, name)) {
            const auto [known, is_new] = files.emplace(name, digest);
            if (!is_new && known->second != digest)
                fault(pointer,
                      "conflict",
                      "a part of this name came along whose digest is " + digest + ": drop one");
        }
    }
}

void ReadFields::file(const std::string& name, const Json& value, std::map<std::string, std::string>& files)
{
    const std::string pointer = pointer_to(at("files"), name);
    if (!name_fits(pointer, name)) return;
    std::string& digest = files[name]; // named, whatever its digest: a mesh that asks for it is not at fault
    if (!value.is_string()) return wrong_type(pointer, "a digest", value);
    const auto& text = value.get_ref<const std::string&>();
    if (!is_digest(text))
        return fault(pointer, "bad_digest", in_quotes(text) + " is no digest: " + kDigestForm);
    digest = text;
    digest_check(digest, pointer);
}

} // namespace api
