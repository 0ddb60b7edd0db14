#include "clients/cli/job_source.h"

#include "clients/cli/files.h"
#include "clients/cli/user_error.h"
#include "renderer/description/mesh_formats.h"

#include <cstdio>

namespace clients {
namespace {

bool names_mesh(const std::filesystem::path& path)
{
    return renderer::is_mesh_extension(lower_extension(path));
}

std::string scene_of_mesh(const std::string& mesh)
{
    api::JobRequest request;
    request.scene.meshes = {{mesh, ""}};
    request.scene.objects.emplace_back().shape = renderer::MeshShape{0, ""};
    return api::write_job(request);
}

} // namespace

JobSource read_job_source(const std::string& scene)
{
    if (scene == "-") return {"standard input", read_file(scene), "."};
    const std::filesystem::path path(scene);
    const std::filesystem::path folder = path.has_parent_path() ? path.parent_path() : ".";
    if (names_mesh(path)) return {scene, scene_of_mesh(path.filename().string()), folder};
    return {scene, read_file(path), folder};
}

void refuse_faults(const std::string& source, const std::vector<api::Problem>& faults)
{
    for (const api::Problem& fault : faults) {
        const char* pointer = fault.pointer.empty() ? "(the whole)" : fault.pointer.c_str();
        std::fprintf(
            stderr, "%s: %s: %s (%s)\n", source.c_str(), pointer, fault.detail.c_str(), fault.code.c_str());
    }
    throw UserError(ExitCode::faults,
                    source + ": " + std::to_string(faults.size()) +
                        (faults.size() == 1 ? " fault" : " faults"));
}

api::JobRequest read_request(const JobSource& source)
{
    api::ReadContext context;
    context.limits = renderer::Limits::none();
    context.local = true;
    auto result = api::read_job(source.json, context);
    if (const auto* problem = std::get_if<api::ProblemDetails>(&result)) {
        if (!problem->errors.empty()) refuse_faults(source.name, problem->errors);
        refuse_faults(source.name, {{"", problem->code, problem->detail}});
    }
    return std::get<api::JobRequest>(std::move(result));
}

} // namespace clients
