#include "clients/cli/files.h"
#include "clients/cli/layer_files.h"
#include "clients/cli/output_format.h"
#include "clients/cli/remote_commands.h"
#include "clients/cli/remote_job.h"
#include "clients/cli/service_errors.h"
#include "clients/cli/user_error.h"

#include <cstdio>

namespace clients {
namespace {

// The files that a command is to write.
struct Wanted {
    std::string picture; // empty: layers alone
    renderer::PictureEncoding encoding;
    std::vector<LayerFile> layers;
};

Wanted read_wanted(const std::string& output,
                   std::optional<std::uint32_t> bits,
                   const std::vector<std::string>& layers)
{
    Wanted wanted{.picture = output, .encoding = {}, .layers = read_layer_files(layers, bits)};
    if (output.empty() && layers.empty())
        throw UserError(ExitCode::usage, "nothing to fetch: give --output, --layer or both");
    if (!output.empty()) {
        wanted.encoding = encoding_of(output, bits);
        check_writable(output);
    }
    for (const LayerFile& file : wanted.layers)
        check_writable(file.path);
    return wanted;
}

void write_wanted(HttpClient& client, const std::string& id, const Wanted& wanted)
{
    if (!wanted.picture.empty()) write_file(wanted.picture, fetch_picture(client, id, wanted.encoding));
    for (const LayerFile& file : wanted.layers)
        write_file(file.path, fetch_layer(client, id, file));
}

} // namespace

ExitCode submit_command(const ServiceOptions& service, const SubmitOptions& options, std::stop_token stop)
{
    HttpClient client(parse_service_url(service.url), service.patience_s, std::move(stop));
    const api::JobView job = submit_job(client, options, service.quiet);
    std::printf("%s\n", job.id.c_str());
    return ExitCode::ok;
}

ExitCode wait_command(const ServiceOptions& service, const WaitOptions& options, std::stop_token stop)
{
    HttpClient client(parse_service_url(service.url), service.patience_s, std::move(stop));
    return tell_end(wait_for_job(client, options.id, options.timeout_s, service.quiet));
}

ExitCode fetch_command(const ServiceOptions& service, const FetchOptions& options, std::stop_token stop)
{
    const Wanted wanted = read_wanted(options.output, options.bits, options.layers);
    HttpClient client(parse_service_url(service.url), service.patience_s, std::move(stop));
    write_wanted(client, options.id, wanted);
    return ExitCode::ok;
}

namespace {

// After an interrupt, with the client's own stop token spent: one short try with a fresh one.
void cancel_quietly(const ServiceOptions& service, const std::string& id)
{
    try {
        HttpClient client(parse_service_url(service.url), 0, {});
        const HttpAnswer answer = client.send({.method = "POST", .path = path_of_job(id) + "/cancel"});
        if (answer.status != 200 && answer.status != 202) throw error_from("the service refused", answer);
        std::fprintf(stderr, "heliograph: %s was cancelled\n", id.c_str());
    } catch (const UserError& error) {
        std::fprintf(stderr, "heliograph: %s could not be cancelled: %s\n", id.c_str(), error.what());
    }
}

} // namespace

ExitCode run_command(const ServiceOptions& service, const RunOptions& options, const std::stop_token& stop)
{
    const Wanted wanted = read_wanted(options.output, options.bits, options.layers);
    SubmitOptions submit = options.submit;
    submit.layers.bits |= layers_of(wanted.layers).bits;
    HttpClient client(parse_service_url(service.url), service.patience_s, stop);
    api::JobView job = submit_job(client, submit, service.quiet);
    if (!service.quiet) std::fprintf(stderr, "note: job %s\n", job.id.c_str());
    try {
        if (!api::is_final(job.state)) job = wait_for_job(client, job.id, options.timeout_s, service.quiet);
        const ExitCode code = tell_end(job);
        if (code == ExitCode::ok) write_wanted(client, job.id, wanted);
        return code;
    } catch (const UserError&) {
        if (stop.stop_requested()) cancel_quietly(service, job.id);
        throw;
    }
}

} // namespace clients
