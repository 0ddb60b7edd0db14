// RemoteJob: the steps that the remote commands are made of: submit, look, wait, fetch.
//
// Errors  UserError with the exit code that the service's answer stands for.
#pragma once

#include "api/job_view.h"
#include "clients/cli/http_client.h"
#include "clients/cli/layer_files.h"
#include "clients/cli/remote_commands.h"
#include "renderer/description/picture_formats.h"

#include <optional>
#include <string>

namespace clients {

// "/v1/jobs/ID", refusing what can be no id.
std::string path_of_job(const std::string& id);

// Checks the scene here, uploads what the service lacks, posts the job.
api::JobView submit_job(HttpClient& client, const SubmitOptions& options, bool quiet);

// The job object; `text` gets the service's own words if given.
api::JobView get_job(HttpClient& client, const std::string& id, std::string* text = nullptr);

// Until the job is final; progress on a terminal unless `quiet`. UserError(timed_out) after `timeout_s`.
api::JobView
wait_for_job(HttpClient& client, const std::string& id, std::optional<double> timeout_s, bool quiet);

// ok for a success; else prints why there is no picture and gives the code for it.
ExitCode tell_end(const api::JobView& job);

// The picture's bytes, compared with their Repr-Digest.
std::string
fetch_picture(HttpClient& client, const std::string& id, const renderer::PictureEncoding& encoding);
// Likewise those of a layer beside it.
std::string fetch_layer(HttpClient& client, const std::string& id, const LayerFile& file);

} // namespace clients
