// Every way the job service says no, as the answer that the client gets.
#pragma once

#include "api/problem.h"
#include "renderer/description/fault_list.h"
#include "renderer/description/layers.h"
#include "renderer/description/limits.h"
#include "renderer/description/picture_formats.h"
#include "renderer/description/scene_description.h"
#include "server/import/import_service.h"
#include "server/store/store.h"

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace server {

api::ProblemDetails draining_problem();
api::ProblemDetails storage_full_problem();
// The limit, not the disk.
api::ProblemDetails results_full_problem(std::uint64_t limit);
api::ProblemDetails queue_full_problem(std::uint64_t limit);
api::ProblemDetails key_reused_problem();
api::ProblemDetails bad_cursor_problem();
api::ProblemDetails not_found_problem(const JobId& id);
api::ProblemDetails still_running_problem(const JobId& id);
api::ProblemDetails still_ending_problem(const JobId& id); // canceled, but its worker is not done with it
api::ProblemDetails render_failed_problem(const JobId& id,
                                          const api::ProblemDetails* why); // nullptr: canceled
api::ProblemDetails expired_problem(const JobId& id);
// The stored picture was lost, so the job waits again.
api::ProblemDetails renders_again_problem(const JobId& id);
// The same, but it cannot render: an asset that it takes is gone.
api::ProblemDetails picture_lost_problem(const JobId& id, const std::string& asset);

// 406: of a picture that an older build kept, and of one that has more pixels a side than the format.
api::ProblemDetails png_alone_problem(const JobId& id);
api::ProblemDetails format_too_small_problem(renderer::PictureFormat format);

// 404: the job was not asked for it.
api::ProblemDetails no_such_layer_problem(const JobId& id, renderer::Layer layer, renderer::LayerSet asked);

// How a job fails.
api::ProblemDetails result_too_large_problem(std::uint64_t bytes, const renderer::Limits& limits);
api::ProblemDetails time_limit_problem(double limit_s);
api::ProblemDetails non_finite_problem(std::uint64_t samples);
api::ProblemDetails too_many_attempts_problem(const JobId& id, std::uint32_t attempts);
api::ProblemDetails out_of_memory_problem(const JobId& id);
api::ProblemDetails internal_problem(const JobId& id);                   // the log has the rest
api::ProblemDetails faults_problem(std::vector<renderer::Fault> faults); // as one list holds them

// As the store keeps it.
JobFailure failure_of(const api::ProblemDetails& problem);

// Meshes that do not import, by their place in the scene, told at every object that uses one.
using FailedMeshes = std::map<std::uint32_t, ImportFailure>;
void add_faults(const FailedMeshes& failed,
                const renderer::SceneDescription& scene,
                renderer::FaultList& faults);
// A picture that does not import.
void add_fault(const renderer::ImageReference& image, ImportFailure failure, renderer::FaultList& faults);

} // namespace server
