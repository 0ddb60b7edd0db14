// LocalJob: a job made ready to render here: words read, meshes imported, what was left open filled in.
#pragma once

#include "api/job_request.h"
#include "clients/cli/job_source.h"
#include "renderer/geometry/mesh.h"
#include "renderer/plan/plan.h"
#include "renderer/textures/image.h"

#include <memory>
#include <string>
#include <vector>

namespace clients {

struct LocalJob {
    api::JobRequest request; // with the digests of the meshes, so that its render key is the service's
    std::vector<renderer::Mesh> meshes; // as request.scene.meshes
    std::vector<renderer::MeshFacts> facts;
    std::vector<std::shared_ptr<const renderer::Image>> images; // as request.scene.images
    std::vector<renderer::ImageFacts> image_facts;
    renderer::AssumedScene assumed;
    std::vector<std::string> notes; // of the importers, with the mesh's name
};

// Imports, fills in and checks against a plan without limits. Prints every fault and throws
// UserError(faults).
LocalJob load_local_job(const JobSource& source, api::JobRequest request);

// The plan of a job that load_local_job accepted.
renderer::Plan plan_of(const LocalJob& job);

// "sha256:...": the same as a service of this build gives the job.
std::string render_key_of(const api::JobRequest& request);

} // namespace clients
