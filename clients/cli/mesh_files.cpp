#include "clients/cli/mesh_files.h"

#include "clients/cli/digest.h"
#include "clients/cli/files.h"

#include <span>

namespace clients {
namespace {

// Within the folder, whatever the name does: relative, and never above where it began.
bool stays_within(const std::filesystem::path& name)
{
    if (name.empty() || name.is_absolute()) return false;
    const std::filesystem::path normal = name.lexically_normal();
    return !normal.empty() && *normal.begin() != "..";
}

} // namespace

std::optional<std::span<const std::byte>> FolderFiles::open(std::string_view name)
{
    auto known = bytes_.find(name);
    if (known == bytes_.end()) {
        if (!stays_within(name) || !std::filesystem::is_regular_file(folder_ / name)) return std::nullopt;
        auto bytes = read_file_if_there(folder_ / name);
        if (!bytes) return std::nullopt;
        known = bytes_.emplace(name, *std::move(bytes)).first;
    }
    return std::as_bytes(std::span(known->second));
}

std::string pointer_to_mesh(const renderer::SceneDescription& scene, std::uint32_t mesh)
{
    for (std::size_t i = 0; i < scene.objects.size(); ++i) {
        const auto* shape = std::get_if<renderer::MeshShape>(&scene.objects[i].shape);
        if (shape && shape->mesh == mesh) return "/scene/objects/" + std::to_string(i) + "/mesh";
    }
    return "/scene/objects";
}

namespace {

std::variant<std::filesystem::path, api::Problem>
path_of(const std::string& name, const std::string& pointer, const std::filesystem::path& folder)
{
    if (name.starts_with("sha256:"))
        return api::Problem{pointer,
                            "missing_asset",
                            name + " names an uploaded asset, which only a service has: name a file instead"};
    const std::filesystem::path path = folder / name;
    if (!std::filesystem::is_regular_file(path))
        return api::Problem{pointer,
                            "missing_file",
                            "there is no file " + path.string() +
                                ": names are looked for from the scene's folder"};
    return path;
}

api::Problem digest_mismatch(const std::string& pointer,
                             const std::filesystem::path& path,
                             const std::string& found,
                             const std::string& wanted)
{
    return {
        pointer, "digest_mismatch", path.string() + " is " + found + ", but the job's files say " + wanted};
}

} // namespace

std::variant<std::filesystem::path, api::Problem>
path_of_mesh(const api::JobRequest& request, std::uint32_t mesh, const std::filesystem::path& folder)
{
    return path_of(request.scene.meshes[mesh].name, pointer_to_mesh(request.scene, mesh), folder);
}

std::variant<std::filesystem::path, api::Problem> path_of_picture(const renderer::ImageReference& image,
                                                                  const std::filesystem::path& folder)
{
    return path_of(image.name, image.pointer, folder);
}

std::variant<PictureFile, api::Problem> import_picture_file(const renderer::ImageReference& image,
                                                            const std::filesystem::path& folder)
{
    auto found = path_of_picture(image, folder);
    if (auto* problem = std::get_if<api::Problem>(&found)) return std::move(*problem);
    PictureFile out{.path = std::get<std::filesystem::path>(std::move(found)), .digest = {}, .image = {}};
    const std::string bytes = read_file(out.path);
    out.digest = digest_of(bytes);
    if (!image.digest.empty() && image.digest != out.digest)
        return digest_mismatch(image.pointer, out.path, out.digest, image.digest);
    auto result = renderer::import_image(
        out.path.filename().string(), std::as_bytes(std::span(bytes)), renderer::Limits::none());
    if (const auto* fault = std::get_if<renderer::ImportFault>(&result))
        return api::Problem{image.pointer, fault->code, out.path.string() + ": " + fault->detail};
    out.image = std::move(std::get<renderer::ImportedImage>(result).image);
    return out;
}

std::variant<MeshFile, api::Problem>
import_mesh_file(const api::JobRequest& request, std::uint32_t mesh, const std::filesystem::path& folder)
{
    auto found = path_of_mesh(request, mesh, folder);
    if (auto* problem = std::get_if<api::Problem>(&found)) return std::move(*problem);
    MeshFile out{.path = std::get<std::filesystem::path>(std::move(found)),
                 .digest = {},
                 .imported = {},
                 .companions = {}};
    const std::string bytes = read_file(out.path);
    out.digest = digest_of(bytes);
    const std::string& wanted = request.scene.meshes[mesh].digest;
    const std::string pointer = pointer_to_mesh(request.scene, mesh);
    if (!wanted.empty() && wanted != out.digest)
        return digest_mismatch(pointer, out.path, out.digest, wanted);

    FolderFiles companions(out.path.parent_path());
    auto result = renderer::import_mesh(
        out.path.filename().string(),
        std::as_bytes(std::span(bytes)),
        [&companions](std::string_view name) { return companions.open(name); },
        renderer::Limits::none());
    if (const auto* fault = std::get_if<renderer::ImportFault>(&result))
        return api::Problem{pointer, fault->code, out.path.string() + ": " + fault->detail};
    out.imported = std::get<renderer::ImportedMesh>(std::move(result));
    for (const std::string& name : out.imported.opened_files) {
        const auto opened = companions.open(name);
        if (opened)
            out.companions[name] = digest_of({reinterpret_cast<const char*>(opened->data()), opened->size()});
    }
    return out;
}

} // namespace clients
