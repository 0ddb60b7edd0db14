#include "api/job_view.h"
#include "api/json/json.h"
#include "api/write/problem_json.h"

namespace api {

namespace {

Json asset_json(const std::string& digest, std::uint64_t bytes)
{
    const std::string self = "/v1/assets/" + digest;
    return {{"digest", digest}, {"bytes", bytes}, {"links", {{"self", self}, {"info", self + "/info"}}}};
}

Json mesh_json(const AssetInfo::MeshInfo& mesh)
{
    return {{"format", mesh.format},
            {"triangles", mesh.triangles},
            {"vertices", mesh.vertices},
            {"degenerate_triangles", mesh.degenerate_triangles},
            {"bounds", {{"lower", mesh.lower}, {"upper", mesh.upper}}},
            {"materials", mesh.materials},
            {"textures", mesh.textures},
            {"parts", mesh.parts},
            {"notes", mesh.notes},
            {"has_normals", mesh.has_normals},
            {"has_uvs", mesh.has_uvs}};
}

Json image_json(const AssetInfo::ImageInfo& image)
{
    return {{"format", image.format},
            {"width", image.width},
            {"height", image.height},
            {"channels", image.channels},
            {"bits", image.bits}};
}

} // namespace

std::string write_asset(const std::string& digest, std::uint64_t bytes)
{
    return text_of(asset_json(digest, bytes));
}

std::string write_asset_info(const AssetInfo& info)
{
    Json json = asset_json(info.digest, info.bytes);
    if (info.mesh) json["mesh"] = mesh_json(*info.mesh);
    if (info.image) json["image"] = image_json(*info.image);
    if (info.fault) json["fault"] = fault_json(*info.fault);
    return text_of(json, true);
}

} // namespace api
