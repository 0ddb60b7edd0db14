#include "clients/cli/local_job.h"

#include "clients/cli/digest.h"
#include "clients/cli/mesh_files.h"
#include "renderer/plan/mesh_use.h"

#include <utility>

namespace clients {
namespace {

double aspect_of(const renderer::ImageSettings& image)
{
    return static_cast<double>(image.width_px) / static_cast<double>(image.height_px);
}

// Adds a mesh's own digest and those of its companions to the job's files. Two files of one name and
// different bytes (in two folders) keep the first here; only an upload has to refuse that.
void add_digests(api::JobRequest& request, std::uint32_t mesh, const MeshFile& file)
{
    renderer::MeshReference& reference = request.scene.meshes[mesh];
    reference.digest = file.digest;
    request.files.emplace(reference.name, file.digest);
    for (const auto& [name, digest] : file.companions)
        request.files.emplace(name, digest);
}

} // namespace

LocalJob load_local_job(const JobSource& source, api::JobRequest request)
{
    LocalJob job{.request = std::move(request),
                 .meshes = {},
                 .facts = {},
                 .images = {},
                 .image_facts = {},
                 .assumed = {},
                 .notes = {}};
    std::vector<api::Problem> faults;
    const auto count = static_cast<std::uint32_t>(job.request.scene.meshes.size());
    for (std::uint32_t i = 0; i < count; ++i) {
        auto result = import_mesh_file(job.request, i, source.folder);
        if (auto* fault = std::get_if<api::Problem>(&result)) {
            faults.push_back(std::move(*fault));
            continue;
        }
        MeshFile& file = std::get<MeshFile>(result);
        add_digests(job.request, i, file);
        for (const std::string& note : file.imported.notes)
            job.notes.push_back(job.request.scene.meshes[i].name + ": " + note);
        job.facts.push_back(renderer::facts_of(file.imported.mesh));
        job.meshes.push_back(std::move(file.imported.mesh));
    }
    for (renderer::ImageReference& image : job.request.scene.images) {
        auto result = import_picture_file(image, source.folder);
        if (auto* fault = std::get_if<api::Problem>(&result)) {
            faults.push_back(std::move(*fault));
            continue;
        }
        PictureFile& file = std::get<PictureFile>(result);
        image.digest = file.digest;
        job.request.files.emplace(image.name, file.digest);
        job.images.push_back(std::make_shared<const renderer::Image>(std::move(file.image)));
        job.image_facts.push_back(renderer::facts_of(*job.images.back()));
    }
    if (!faults.empty()) refuse_faults(source.name, faults);

    job.assumed =
        renderer::assume_defaults(job.request.scene, job.facts, aspect_of(job.request.settings.image));
    auto plan = renderer::make_plan(
        job.assumed, job.facts, job.request.settings, renderer::Limits::none(), job.image_facts);
    if (const auto* found = std::get_if<std::vector<renderer::Fault>>(&plan)) {
        for (const renderer::Fault& fault : *found)
            faults.push_back({fault.pointer, fault.code, fault.detail});
        refuse_faults(source.name, faults);
    }
    const std::vector<renderer::MeshUse> uses = renderer::uses_of(job.assumed.description, job.facts);
    for (std::size_t i = 0; i < uses.size(); ++i)
        renderer::drop_unused(job.meshes[i], uses[i]);
    return job;
}

renderer::Plan plan_of(const LocalJob& job)
{
    return std::get<renderer::Plan>(renderer::make_plan(
        job.assumed, job.facts, job.request.settings, renderer::Limits::none(), job.image_facts));
}

std::string render_key_of(const api::JobRequest& request)
{
    return digest_of(api::canonical_render_text(request));
}

} // namespace clients
