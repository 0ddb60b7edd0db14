#include "clients/cli/upload.h"

#include "clients/cli/digest.h"
#include "clients/cli/files.h"
#include "clients/cli/mesh_files.h"
#include "clients/cli/service_errors.h"

#include <utility>

namespace clients {
namespace {

// Only OBJ and glTF name other files, by these words; a mesh without them need not be imported to know that.
bool may_name_files(std::string_view bytes)
{
    return bytes.find("mtllib") != std::string_view::npos || bytes.find("\"uri\"") != std::string_view::npos;
}

// The files of a job while they are found: one name is one file.
class FileList {
public:
    // A fault if the name already stands for other bytes.
    std::optional<api::Problem> add(const JobFile& file, const std::string& pointer)
    {
        const auto [known, is_new] = by_name_.emplace(file.name, file);
        if (is_new || known->second.digest == file.digest) return std::nullopt;
        return api::Problem{pointer,
                            "name_conflict",
                            '"' + file.name + "\" means " + known->second.path.string() + " and " +
                                file.path.string() +
                                ", which differ: a job has one list of names, rename one of them"};
    }

    std::vector<JobFile> take() const
    {
        std::vector<JobFile> out;
        for (const auto& [name, file] : by_name_)
            out.push_back(file);
        return out;
    }

private:
    std::map<std::string, JobFile> by_name_;
};

std::vector<api::Problem> add_mesh(const api::JobRequest& request,
                                   std::uint32_t mesh,
                                   const std::filesystem::path& folder,
                                   FileList& files)
{
    const renderer::MeshReference& reference = request.scene.meshes[mesh];
    auto found = path_of_mesh(request, mesh, folder);
    if (auto* fault = std::get_if<api::Problem>(&found)) {
        if (!reference.digest.empty() || reference.name.starts_with("sha256:")) return {};
        return {std::move(*fault)};
    }
    const std::filesystem::path& path = std::get<std::filesystem::path>(found);
    const std::string pointer = pointer_to_mesh(request.scene, mesh);
    const std::string bytes = read_file(path);
    std::vector<api::Problem> faults;
    if (!may_name_files(bytes)) {
        if (auto fault = files.add({reference.name, path, digest_of(bytes)}, pointer))
            faults.push_back(*std::move(fault));
        return faults;
    }
    auto imported = import_mesh_file(request, mesh, folder);
    if (auto* fault = std::get_if<api::Problem>(&imported)) return {std::move(*fault)};
    const MeshFile& file = std::get<MeshFile>(imported);
    if (auto fault = files.add({reference.name, path, file.digest}, pointer))
        faults.push_back(*std::move(fault));
    for (const auto& [name, digest] : file.companions)
        if (auto fault = files.add({name, path.parent_path() / name, digest}, pointer))
            faults.push_back(*std::move(fault));
    return faults;
}

} // namespace

std::variant<std::vector<JobFile>, std::vector<api::Problem>>
find_job_files(const api::JobRequest& request, const std::filesystem::path& folder)
{
    FileList files;
    std::vector<api::Problem> faults;
    for (std::uint32_t mesh = 0; mesh < request.scene.meshes.size(); ++mesh)
        for (api::Problem& fault : add_mesh(request, mesh, folder, files))
            faults.push_back(std::move(fault));
    for (const renderer::ImageReference& image : request.scene.images) {
        auto found = path_of_picture(image, folder);
        if (auto* fault = std::get_if<api::Problem>(&found)) {
            if (image.digest.empty() && !image.name.starts_with("sha256:"))
                faults.push_back(std::move(*fault));
            continue;
        }
        const auto& path = std::get<std::filesystem::path>(found);
        if (auto fault = files.add({image.name, path, digest_of(read_file(path))}, image.pointer))
            faults.push_back(*std::move(fault));
    }
    if (!faults.empty()) return faults;
    return files.take();
}

bool upload(HttpClient& client, const JobFile& file)
{
    const std::string path = "/v1/assets/" + file.digest;
    const HttpAnswer head = client.send({.method = "HEAD", .path = path});
    if (head.status == 200) return false;
    if (head.status != 404) throw error_from("asking for " + file.name, head);
    HttpRequest put{.method = "PUT", .path = path, .headers = {{"Content-Type", "application/octet-stream"}}};
    put.body = read_file(file.path);
    const HttpAnswer answer = client.send(put);
    if (answer.status != 200 && answer.status != 201)
        throw error_from("uploading " + file.path.string(), answer);
    return true;
}

} // namespace clients
