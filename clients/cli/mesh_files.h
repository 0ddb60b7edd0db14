// MeshFiles: the meshes and pictures of a job, read from disk with the files that they name, imported and checked.
//
// Errors  faults with the pointer of the object that first names the mesh; UserError(usage) for unreadable
//         files.
// Cost    holds the bytes of one mesh and its companions while that mesh is imported.
#pragma once

#include "api/job_request.h"
#include "renderer/io/import_image.h"
#include "renderer/io/import_mesh.h"

#include <filesystem>
#include <map>
#include <string>
#include <variant>
#include <vector>

namespace clients {

// Files of one folder and below, as an importer may see them; the bytes stay until the end.
class FolderFiles {
public:
    explicit FolderFiles(std::filesystem::path folder) : folder_(std::move(folder)) {}

    // Nothing for names that are absolute, that climb above the folder, or of what is not there.
    std::optional<std::span<const std::byte>> open(std::string_view name);
    std::filesystem::path path_of(std::string_view name) const { return folder_ / name; }

private:
    std::filesystem::path folder_;
    std::map<std::string, std::string, std::less<>> bytes_;
};

struct MeshFile {
    std::filesystem::path path;
    std::string digest;
    renderer::ImportedMesh imported;
    std::map<std::string, std::string> companions; // name -> digest, of imported.opened_files
};

// The object that first names mesh `mesh`: "/scene/objects/3/mesh".
std::string pointer_to_mesh(const renderer::SceneDescription& scene, std::uint32_t mesh);

// The path of a mesh of a local job, or the fault that it has none (an uploaded asset's digest is not a
// file).
std::variant<std::filesystem::path, api::Problem>
path_of_mesh(const api::JobRequest& request, std::uint32_t mesh, const std::filesystem::path& folder);

// One mesh: read, digest compared with the job's `files` where they name it, imported.
std::variant<MeshFile, api::Problem>
import_mesh_file(const api::JobRequest& request, std::uint32_t mesh, const std::filesystem::path& folder);

struct PictureFile {
    std::filesystem::path path;
    std::string digest;
    renderer::Image image;
};

// One picture, likewise.
std::variant<PictureFile, api::Problem> import_picture_file(const renderer::ImageReference& image,
                                                            const std::filesystem::path& folder);

// Where a picture of a local job lies, or the fault that it does not.
std::variant<std::filesystem::path, api::Problem> path_of_picture(const renderer::ImageReference& image,
                                                                  const std::filesystem::path& folder);

} // namespace clients
