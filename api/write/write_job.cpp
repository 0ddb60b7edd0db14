#include "api/build_info.h"
#include "api/fields/job_fields.h"
#include "api/job_request.h"
#include "api/write/write_fields.h"

#include <algorithm>

namespace api {

WriteFields::WriteFields(Json& out, const renderer::SceneDescription& scene) : out_(out), scene_(scene) {}

void WriteFields::point(const char* name, const renderer::Vec3d& value, const char*)
{
    out_[name] = Json::array({value.x, value.y, value.z});
}

void WriteFields::color(const char* name, const renderer::Rgb& value, const Range&, const char*)
{
    out_[name] = Json::array({shortest_double(value.r), shortest_double(value.g), shortest_double(value.b)});
}

void WriteFields::table(const char* name, const std::vector<renderer::NamedMaterial>& materials, const char*)
{
    Json json = Json::object();
    for (const renderer::NamedMaterial& named : materials)
        json[named.name] = written(named.material);
    out_[name] = std::move(json);
}

void WriteFields::aim(const renderer::CameraDescription& camera)
{
    point(camera.aim_is_direction ? "direction" : "look_at", camera.aim, nullptr);
}

void WriteFields::geometry(const renderer::Shape& shape)
{
    if (const auto* mesh = std::get_if<renderer::MeshShape>(&shape)) {
        out_["mesh"] = scene_.meshes.at(mesh->mesh).name;
        if (!mesh->part.empty()) out_["part"] = mesh->part;
        return;
    }
    out_["shape"] = name_of(words_for<renderer::Shape>(), static_cast<int>(shape.index()));
    std::visit([this](const auto& alternative) { fields(*this, alternative); }, shape);
}

void WriteFields::material_of(const std::optional<std::uint32_t>& material)
{
    if (material) out_["material"] = scene_.materials.at(*material).name;
}

void WriteFields::metal_of(const std::variant<renderer::Metal, renderer::ComplexIor>& ior)
{
    if (const auto* metal = std::get_if<renderer::Metal>(&ior)) return word("metal", *metal, nullptr);
    const auto& given = std::get<renderer::ComplexIor>(ior);
    color("eta", given.eta, kIor, nullptr);
    color("k", given.k, kExtinction, nullptr);
}

void WriteFields::placement(const renderer::Affine3& world_from_object)
{
    Json matrix = Json::array();
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 4; ++j)
            matrix.push_back(j < 3 ? world_from_object.rows[i][j] : world_from_object.translation[i]);
    for (const double last : {0.0, 0.0, 0.0, 1.0})
        matrix.push_back(last);
    out_["matrix"] = std::move(matrix);
}

namespace {

Json job_as_json(const JobRequest& request)
{
    Json json = Json::object();
    WriteFields writer(json, request.scene);
    fields(writer, request);
    return json;
}

} // namespace

std::string write_job(const JobRequest& request, bool pretty)
{
    return text_of(job_as_json(request), pretty);
}

std::string canonical_render_text(const JobRequest& request)
{
    Json json = job_as_json(request);
    for (const char* no_part_of_the_picture : {"labels", "priority", "limits", "acceleration"})
        json.erase(no_part_of_the_picture);
    std::sort(json["fail_on"].begin(), json["fail_on"].end());
    // Names stay beside digests: by them a mesh finds its MTL, and their endings may tell the format. Without
    // a mesh or a picture no file is ever opened.
    if (request.scene.meshes.empty() && request.scene.images.empty()) json.erase("files");
    Json& images = json["images"] = Json::object();
    for (const renderer::ImageReference& image : request.scene.images)
        images[image.name] = image.digest;
    Json& meshes = json["meshes"] = Json::object();
    for (const renderer::MeshReference& mesh : request.scene.meshes)
        meshes[mesh.name] = mesh.digest;
    json["build"] = {{"version", build_info().version}, {"commit", build_info().commit}};
    return text_of(json);
}

} // namespace api
