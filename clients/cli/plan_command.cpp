#include "api/job_view.h"
#include "clients/cli/local_commands.h"
#include "clients/cli/local_job.h"

#include <cstdio>

namespace clients {

ExitCode plan_command(const PlanOptions& options)
{
    const JobSource source = read_job_source(options.scene);
    const LocalJob job = load_local_job(source, read_request(source));
    for (const std::string& note : job.notes)
        std::fprintf(stderr, "note: %s\n", note.c_str());
    const renderer::Plan plan = plan_of(job);
    const std::string text = api::write_plan({plan.models, plan.prediction});
    std::fwrite(text.data(), 1, text.size(), stdout);
    if (!text.ends_with('\n')) std::fputc('\n', stdout);
    return ExitCode::ok;
}

} // namespace clients
