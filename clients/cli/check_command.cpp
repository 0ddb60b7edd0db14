#include "clients/cli/local_commands.h"
#include "clients/cli/local_job.h"

#include <cstdio>

namespace clients {
namespace {

void print_choices(const std::vector<renderer::ModelChoice>& choices)
{
    for (const renderer::ModelChoice& choice : choices)
        std::fprintf(stderr, "note: %s: %s\n", choice.name.c_str(), choice.why.c_str());
}

} // namespace

ExitCode check_command(const CheckOptions& options)
{
    const JobSource source = read_job_source(options.scene);
    const LocalJob job = load_local_job(source, read_request(source));
    for (const std::string& note : job.notes)
        std::fprintf(stderr, "note: %s\n", note.c_str());
    print_choices(job.assumed.assumed);
    if (!options.expand) {
        std::printf("%s: no faults\n", source.name.c_str());
        return ExitCode::ok;
    }
    api::JobRequest expanded = job.request;
    expanded.scene = job.assumed.description;
    expanded.settings.image.exposure_ev = plan_of(job).exposure_ev;
    const std::string text = api::write_job(expanded);
    std::fwrite(text.data(), 1, text.size(), stdout);
    if (!text.ends_with('\n')) std::fputc('\n', stdout);
    return ExitCode::ok;
}

} // namespace clients
