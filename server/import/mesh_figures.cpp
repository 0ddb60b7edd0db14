#include "server/import/mesh_figures.h"

#include <algorithm>
#include <set>

namespace server {

namespace {

bool is_degenerate(const renderer::Mesh& mesh, const renderer::Triangle& triangle)
{
    const renderer::Vec3d a = mesh.position(triangle[0]);
    const renderer::Vec3d area = cross(mesh.position(triangle[1]) - a, mesh.position(triangle[2]) - a);
    return area == renderer::Vec3d{};
}

} // namespace

api::AssetInfo::MeshInfo mesh_figures(const ImportedAsset& asset)
{
    const renderer::Mesh& mesh = asset.mesh;
    api::AssetInfo::MeshInfo figures;
    figures.format = asset.format;
    figures.triangles = mesh.triangles.size();
    figures.vertices = mesh.positions.size();
    figures.degenerate_triangles = static_cast<std::uint64_t>(
        std::count_if(mesh.triangles.begin(), mesh.triangles.end(), [&](const auto& triangle) {
            return is_degenerate(mesh, triangle);
        }));
    const renderer::Bounds3d bounds = mesh.bounds_in_file();
    for (std::size_t axis = 0; axis < 3; ++axis) {
        figures.lower[axis] = bounds.lower[axis];
        figures.upper[axis] = bounds.upper[axis];
    }
    std::set<std::string> textures;
    for (const renderer::MeshMaterial& material : mesh.materials) {
        figures.materials.push_back(material.name);
        textures.insert(material.textures.begin(), material.textures.end());
    }
    figures.textures.assign(textures.begin(), textures.end());
    for (const renderer::MeshPart& part : mesh.parts)
        figures.parts.push_back(part.name);
    figures.notes = asset.notes;
    figures.has_normals = !mesh.normals.empty();
    figures.has_uvs = !mesh.uvs.empty();
    return figures;
}

api::AssetInfo::ImageInfo picture_figures(const ImportedPicture& picture)
{
    const renderer::Image& image = picture.image;
    return {picture.format,
            image.width,
            image.height,
            image.channels,
            static_cast<std::uint32_t>(8 * bytes_of(image.type))};
}

api::AssetInfo info_of(const std::string& digest, std::uint64_t bytes, const KnownImport& known)
{
    api::AssetInfo info;
    info.digest = digest;
    info.bytes = bytes;
    info.mesh = known.figures;
    info.image = known.picture_figures;
    if (known.failure) info.fault = api::Problem{"", known.failure->code, known.failure->detail};
    return info;
}

} // namespace server
