#include "clients/cli/command_line.h"

#include "api/build_info.h"
#include "api/job_view.h"
#include "api/words/word_table.h"
#include "clients/cli/interrupt.h"
#include "clients/cli/local_commands.h"
#include "clients/cli/remote_commands.h"
#include "clients/cli/sky_options.h"
#include "clients/cli/user_error.h"
#include "renderer/description/layers.h"
#include "renderer/description/mesh_formats.h"
#include "renderer/description/picture_formats.h"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <functional>
#include <map>
#include <memory>

namespace clients {
namespace {

// What a sub-command does once everything is parsed.
using Action = std::function<ExitCode(const std::stop_token&)>;

// One page: the words of every command, and the action of the one that was named.
struct CommandLine {
    CLI::App app{"Heliograph renders scenes: here, or through a service.", "heliograph"};
    ServiceOptions service;
    RenderOptions render;
    CheckOptions check;
    PlanOptions plan;
    CompareOptions compare;
    SkyOptions sky;
    SubmitOptions submit;
    WaitOptions wait;
    FetchOptions fetch;
    RunOptions run;
    StatusOptions status;
    ListOptions list;
    std::string id; // of cancel and rm
    Action action;
};

std::string scene_help()
{
    return "scene (JSON), a mesh alone (" + renderer::mesh_extensions() + "), or - for standard input";
}

std::string version_text()
{
    const api::BuildInfo& build = api::build_info();
    return "heliograph " + build.version + "\ncommit   " + build.commit + "\ncompiler " + build.compiler +
           ", " + build.build_type;
}

std::string footer_text()
{
    std::string text = "Exit status:\n";
    for (const ExitCodeLine& line : kExitCodes) {
        const std::string number = std::to_string(static_cast<int>(line.code));
        text += "  " + number + std::string(5 - number.size(), ' ') + line.meaning + '\n';
    }
    return text;
}

CLI::App* add_command(CommandLine& words, const char* name, const char* help, Action action)
{
    CLI::App* command = words.app.add_subcommand(name, help);
    command->parse_complete_callback([&words, action = std::move(action)] { words.action = action; });
    return command;
}

void add_quiet(CLI::App& command, bool& quiet)
{
    command.add_flag("-q,--quiet", quiet, "no progress bar and no notes")->envname("HELIOGRAPH_QUIET");
}

std::string output_help()
{
    return "picture; its extension tells the format: " + renderer::picture_extensions() +
           " (.hdr, .exr and .pfm hold radiance); - writes a PNG to standard output";
}

void add_bits(CLI::App& command, std::optional<std::uint32_t>& bits)
{
    command.add_option("--bits", bits, "bits a channel of a PNG: 8 or 16 (default: 8)")
        ->check(CLI::IsMember({8u, 16u}));
}

void add_layers(CLI::App& command, std::vector<std::string>& layers)
{
    command
        .add_option("--layer",
                    layers,
                    "NAME=FILE, what is kept beside the picture: " + names_of(renderer::kEveryLayer) +
                        "; .exr, .pfm, and .png of normal and albedo; may be repeated")
        ->take_all()
        ->allow_extra_args(false);
}

void add_service_options(CLI::App& command, ServiceOptions& service)
{
    command.add_option("--url", service.url, "the service")->envname("HELIOGRAPH_URL")->capture_default_str();
    command
        .add_option(
            "--patience", service.patience_s, "seconds to go on asking a service that is busy or restarts")
        ->envname("HELIOGRAPH_PATIENCE")
        ->check(CLI::Range(0.0, 86400.0))
        ->capture_default_str();
    add_quiet(command, service.quiet);
}

void add_render(CommandLine& words)
{
    RenderOptions& options = words.render;
    CLI::App* command =
        add_command(words, "render", "render here, without a service", [&words](const auto& stop) {
            return render_command(words.render, stop);
        });
    command->add_option("scene", options.scene, scene_help())->required();
    command->add_option("-o,--output", options.output, output_help())->required();
    add_bits(*command, options.bits);
    add_layers(*command, options.layers);
    command->add_option("--report", options.report, "write the report (JSON) to this file");
    auto* samples =
        command->add_option("--samples", options.samples, "samples a pixel, instead of the scene's quality")
            ->envname("HELIOGRAPH_SAMPLES")
            ->check(CLI::Range(1u, 1u << 31));
    command
        ->add_option_function<double>(
            "--time",
            [&options, samples](double seconds) {
                options.time_s = seconds;
                samples->envname(""); // a flag wins over the environment, also over that of its rival
            },
            "the best picture in this many seconds, instead of the scene's quality")
        ->trigger_on_parse() // before the environment is read
        ->excludes(samples);
    command->add_option("--seed", options.seed, "seed of the random numbers, 0 to 2^53-1");
    command->add_option("--width", options.width_px, "pixels");
    command->add_option("--height", options.height_px, "pixels");
    command
        ->add_option(
            "--threads", options.threads, "0: one for every core (default: as the scene says, else 0)")
        ->envname("HELIOGRAPH_THREADS");
    command->add_option(
        "--tile",
        options.tile_px,
        "side of a tile in pixels (default: as the scene says, else 16); the picture does not depend on it");
    std::map<std::string, renderer::BvhSplit> splits;
    std::string split_names;
    for (const api::Word& word : api::words_for<renderer::BvhSplit>()) {
        splits.emplace(word.name, static_cast<renderer::BvhSplit>(word.value));
        split_names += (split_names.empty() ? "" : "|") + std::string(word.name);
    }
    command->add_option("--split", options.split, "how trees over triangles are split; for measuring")
        ->transform(CLI::CheckedTransformer(splits).description(split_names));
    add_quiet(*command, options.quiet);
}

void add_check(CommandLine& words)
{
    CLI::App* command =
        add_command(words, "check", "tell every fault of a scene and its meshes", [&words](const auto&) {
            return check_command(words.check);
        });
    command->add_option("scene", words.check.scene, scene_help())->required();
    command->add_flag(
        "--expand", words.check.expand, "print the job with every default and assumption written out");
}

void add_plan(CommandLine& words)
{
    CLI::App* command =
        add_command(words,
                    "plan",
                    "tell which models a scene needs and why, and what rendering it will take",
                    [&words](const auto&) { return plan_command(words.plan); });
    command->add_option("scene", words.plan.scene, scene_help())->required();
}

void add_compare(CommandLine& words)
{
    CLI::App* command = add_command(words,
                                    "compare",
                                    "how far a picture is from a reference, on linear values",
                                    [&words](const auto&) { return compare_command(words.compare); });
    command->add_option("picture", words.compare.picture, "PNG, JPEG, HDR, EXR or PFM")->required();
    command->add_option("reference", words.compare.reference, "PNG, JPEG, HDR, EXR or PFM")->required();
    command->add_flag("--json", words.compare.json, "one JSON object");
}

void add_scene_options(CLI::App& command, SubmitOptions& options)
{
    command.add_option("scene", options.scene, scene_help())->required();
    command.add_option(
        "--priority", options.priority, "0 to 100, larger first (default: as the scene says, else 50)");
    command.add_option("--label", options.labels, "NAME=VALUE, may be repeated")->take_all();
    command.add_option("--idempotency-key",
                       options.idempotency_key,
                       "the same key and scene give the same job (default: a fresh key)");
    command.add_flag("--force", options.force, "render anew even if the service has the result");
}

void add_making(CommandLine& words)
{
    CLI::App* submit =
        add_command(words,
                    "submit",
                    "upload what the service lacks, submit the job, print its id",
                    [&words](const auto& stop) { return submit_command(words.service, words.submit, stop); });
    add_scene_options(*submit, words.submit);
    add_service_options(*submit, words.service);

    CLI::App* wait = add_command(words, "wait", "wait until a job ends", [&words](const auto& stop) {
        return wait_command(words.service, words.wait, stop);
    });
    wait->add_option("id", words.wait.id, "job")->required();
    wait->add_option("--timeout", words.wait.timeout_s, "seconds (default: for ever)");
    add_service_options(*wait, words.service);

    CLI::App* fetch = add_command(words, "fetch", "get the picture of a job", [&words](const auto& stop) {
        return fetch_command(words.service, words.fetch, stop);
    });
    fetch->add_option("id", words.fetch.id, "job")->required();
    fetch->add_option("-o,--output", words.fetch.output, output_help());
    add_bits(*fetch, words.fetch.bits);
    add_layers(*fetch, words.fetch.layers);
    add_service_options(*fetch, words.service);

    CLI::App* run = add_command(
        words, "run", "submit, wait and fetch; an interrupt cancels the job", [&words](const auto& stop) {
            return run_command(words.service, words.run, stop);
        });
    add_scene_options(*run, words.run.submit);
    run->add_option("-o,--output", words.run.output, output_help())->required();
    add_bits(*run, words.run.bits);
    add_layers(*run, words.run.layers);
    run->add_option("--timeout", words.run.timeout_s, "seconds (default: for ever)");
    add_service_options(*run, words.service);
}

void add_looking(CommandLine& words)
{
    CLI::App* status = add_command(words, "status", "tell how a job stands", [&words](const auto& stop) {
        return status_command(words.service, words.status, stop);
    });
    status->add_option("id", words.status.id, "job")->required();
    status->add_flag("--json", words.status.json, "the job object as the service sends it");
    add_service_options(*status, words.service);

    CLI::App* list = add_command(words, "list", "list jobs, newest first", [&words](const auto& stop) {
        return list_command(words.service, words.list, stop);
    });
    list->add_option("--state", words.list.state, "only jobs in this state, as the service names it")
        ->check(CLI::IsMember(api::job_state_names()));
    list->add_option("--label", words.list.label, "only jobs with this NAME=VALUE");
    list->add_option("--limit", words.list.limit, "at most so many; 0: all")->capture_default_str();
    list->add_flag("--json", words.list.json, "the pages as the service sends them");
    add_service_options(*list, words.service);
}

void add_ending(CommandLine& words)
{
    CLI::App* cancel = add_command(words, "cancel", "cancel a job", [&words](const auto& stop) {
        return cancel_command(words.service, words.id, stop);
    });
    CLI::App* rm = add_command(
        words, "rm", "cancel a job if it runs, and forget its results", [&words](const auto& stop) {
            return rm_command(words.service, words.id, stop);
        });
    for (CLI::App* command : {cancel, rm}) {
        command->add_option("id", words.id, "job")->required();
        add_service_options(*command, words.service);
    }
    CLI::App* health =
        add_command(words, "health", "exit 0 if the service is ready, 1 if not", [&words](const auto& stop) {
            return health_command(words.service, stop);
        });
    add_service_options(*health, words.service);
}

ExitCode run_action(const Action& action)
{
    const Interrupt interrupt; // before any other thread
    try {
        return action(interrupt.token());
    } catch (const UserError& error) {
        std::fprintf(stderr, "heliograph: %s\n", error.what());
        return error.code();
    } catch (const std::bad_alloc&) {
        std::fprintf(stderr, "heliograph: out of memory\n");
        return ExitCode::failed;
    } catch (const std::exception& error) {
        std::fprintf(stderr, "heliograph: %s\n", error.what());
        return ExitCode::failed;
    }
}

} // namespace

int run_command_line(int argc, char** argv)
{
    const auto words = std::make_unique<CommandLine>(); // actions and options refer into it
    words->app.set_version_flag("--version", version_text());
    words->app.require_subcommand(1);
    words->app.footer(footer_text());
    add_render(*words);
    add_check(*words);
    add_plan(*words);
    add_compare(*words);
    add_sky_commands(words->app, words->sky, [&words](Action action) { words->action = std::move(action); });
    add_making(*words);
    add_looking(*words);
    add_ending(*words);
    try {
        words->app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        // --help and --version come here as well, with 0.
        return words->app.exit(error) == 0 ? 0 : static_cast<int>(ExitCode::usage);
    }
    return static_cast<int>(run_action(words->action));
}

} // namespace clients
