#include "server/import/import_request.h"

#include "renderer/description/mesh_formats.h"
#include "server/import/flat_mesh.h"

#include <filesystem>

namespace server {

std::string extension_of(const std::string& name)
{
    std::string extension = std::filesystem::path(name).extension().string();
    for (char& c : extension)
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    const bool is_known = renderer::is_mesh_extension(extension) || extension == ".tga"; // which has no mark
    return is_known ? extension : std::string();
}

std::string main_key(const ImportRequest& request)
{
    return request.digest + (request.is_picture ? std::string(kPictureWord) : "") +
           extension_of(request.name);
}

renderer::MeshTree tree_for(const ImportRequest& request, std::uint64_t triangles)
{
    return request.tree_for ? request.tree_for(triangles) : renderer::MeshTree::wide_sah;
}

} // namespace server
