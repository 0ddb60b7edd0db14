// Commands that speak to a service: submit, wait, fetch, run, status, list, cancel, rm, health.
//
// Each prints what it has to say on standard output and returns the exit code; UserError for everything else.
#pragma once

#include "clients/cli/exit_code.h"
#include "renderer/description/layers.h"

#include <cstdint>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

namespace clients {

struct ServiceOptions {
    std::string url = "http://127.0.0.1:8080";
    double patience_s = 60; // how long to go on asking a service that is busy or restarts
    bool quiet = false;     // no progress bar, no notes
};

struct SubmitOptions {
    std::string scene;
    std::string idempotency_key; // empty: a fresh one
    std::optional<int> priority;
    std::vector<std::string> labels; // "name=value"
    bool force = false;              // no result of an equal job is reused
    renderer::LayerSet layers{};     // to keep beside those that the scene asks for
};
ExitCode submit_command(const ServiceOptions& service, const SubmitOptions& options, std::stop_token stop);

struct WaitOptions {
    std::string id;
    std::optional<double> timeout_s; // nothing: for ever
};
ExitCode wait_command(const ServiceOptions& service, const WaitOptions& options, std::stop_token stop);

struct FetchOptions {
    std::string id;
    std::string output;                // its extension tells the format; "-": PNG; empty: layers alone
    std::optional<std::uint32_t> bits; // a channel, of a PNG
    std::vector<std::string> layers;   // NAME=FILE, see layer_files.h
};
ExitCode fetch_command(const ServiceOptions& service, const FetchOptions& options, std::stop_token stop);

// submit, wait and fetch; an interrupt cancels the job.
struct RunOptions {
    SubmitOptions submit;
    std::string output;
    std::optional<std::uint32_t> bits;
    std::vector<std::string> layers; // as of fetch; the job is asked for them
    std::optional<double> timeout_s;
};
ExitCode run_command(const ServiceOptions& service, const RunOptions& options, const std::stop_token& stop);

struct StatusOptions {
    std::string id;
    bool json = false;
};
ExitCode status_command(const ServiceOptions& service, const StatusOptions& options, std::stop_token stop);

struct ListOptions {
    std::string state, label;
    std::uint32_t limit = 0; // 0: every page
    bool json = false;       // the pages as the service sends them
};
ExitCode list_command(const ServiceOptions& service, const ListOptions& options, std::stop_token stop);

ExitCode cancel_command(const ServiceOptions& service, const std::string& id, std::stop_token stop);
ExitCode rm_command(const ServiceOptions& service, const std::string& id, std::stop_token stop);
ExitCode health_command(const ServiceOptions& service, std::stop_token stop);

} // namespace clients
