// heliograph-bench: figures beside a peer or a baseline in the same run. Nothing here is a test.
#include "api/words/word_table.h"
#include "tests/bench/commands.h"

#include <CLI/CLI.hpp>
#include <exception>
#include <iostream>
#include <memory>

namespace {

// A sub-command whose options live as long as the command line does; `run` takes them once all are read.
template <typename Options>
struct Command {
    Command(CLI::App& program, const char* name, const char* does, void (*run)(const Options&))
        : app(*program.add_subcommand(name, does)), options(std::make_shared<Options>())
    {
        app.callback([run, given = options] { run(*given); });
    }

    CLI::App& app;
    std::shared_ptr<Options> options;
};

void add_evaluation(CLI::App& app)
{
    Command command(app,
                    "evaluation",
                    "one picture with boxes, trees of every kind, threads and tiles, and without",
                    bench::run_evaluation);
    auto& [to, options] = command;
    to.add_option("--mesh", options->meshes, "mesh files; without one, hills");
    to.add_option("--out", options->folder, "folder for evaluation.json and the charts (SVG)")->required();
    to.add_option("--repeats", options->repeats, "the medians are told")
        ->check(CLI::Range(1, 1000))
        ->capture_default_str();
    to.add_option("--width", options->width_px, "of the small pictures, in pixels; 4:3")
        ->check(CLI::Range(8, 4096))
        ->capture_default_str();
    to.add_option("--samples", options->samples, "a pixel, of the small pictures")
        ->check(CLI::Range(1, 4096))
        ->capture_default_str();
}

void add_frames(CLI::App& app)
{
    Command command(app,
                    "frames",
                    "the tree over the objects of an animation, refitted and built anew",
                    bench::run_frames);
    auto& [to, options] = command;
    to.add_option("--objects", options->objects, "numbers of objects")
        ->check(CLI::Range(2, 10'000'000))
        ->delimiter(',')
        ->capture_default_str();
    to.add_option("--frames", options->frames, "after the first")
        ->check(CLI::Range(1, 10'000))
        ->capture_default_str();
    to.add_option("--rays", options->rays, "that a frame traces, by which it is chosen")
        ->check(CLI::PositiveNumber)
        ->capture_default_str();
    to.add_option("--threads", options->threads, "that build")
        ->check(CLI::Range(1, 1024))
        ->capture_default_str();
}

void add_import(CLI::App& app)
{
    Command command(app, "import", "from a mesh file to a tree, stage by stage", bench::run_import);
    auto& [to, options] = command;
    to.add_option("file", options->file, "mesh file")->required()->check(CLI::ExistingFile);
    to.add_option("--peer", options->peer, "beside: assimp")->check(CLI::IsMember({"assimp"}));
    to.add_option("--repeats", options->repeats, "of every stage")
        ->check(CLI::PositiveNumber)
        ->capture_default_str();
    to.add_flag("--json", options->as_json, "figures as JSON");
}

void add_split(CLI::App& to, std::string& split)
{
    to.add_option("--split", split, "how our tree is built")
        ->check(CLI::IsMember(api::names_of(api::words_for<renderer::BvhSplit>())))
        ->capture_default_str();
}

void add_leaks(CLI::App& app)
{
    Command command(
        app, "leaks", "rays that slip through the edges and corners of closed meshes", bench::run_leaks);
    auto& [to, options] = command;
    to.add_option("--rays", options->rays, "in all, over meshes, places and kernels")
        ->check(CLI::Range(1.0, 1e15))
        ->capture_default_str();
    to.add_option("--mesh", options->meshes, "mesh files to aim at as well, where they are closed");
    to.add_option("--peer", options->peer, "engine to count beside ours")->check(CLI::IsMember({"embree"}));
    add_split(to, options->split);
    to.add_option("--threads", options->threads, "threads that trace")
        ->check(CLI::Range(1, 1024))
        ->capture_default_str();
}

void add_memory(CLI::App& app)
{
    Command command(app,
                    "memory",
                    "memory of trees and of building them, as predicted and as measured",
                    bench::run_memory);
    auto& [to, options] = command;
    to.add_option("--triangles", options->triangles, "of the mesh")->capture_default_str();
    to.add_option("--instances", options->instances, "of the mesh; 0: the mesh alone")->capture_default_str();
    to.add_option("--threads", options->threads, "that build")
        ->check(CLI::Range(1, 1024))
        ->capture_default_str();
}

void add_pictures(CLI::App& app)
{
    Command command(app, "pictures", "seconds and samples a second of whole pictures", bench::run_pictures);
    auto& [to, options] = command;
    to.add_option("scenes", options->scenes, "job files; none: a Cornell box")->check(CLI::ExistingFile);
    to.add_option("--samples", options->samples, "a pixel")
        ->capture_default_str()
        ->check(CLI::PositiveNumber);
    to.add_option("--width", options->side_px, "of the picture, pixels")
        ->capture_default_str()
        ->check(CLI::PositiveNumber);
    to.add_option("--repeats", options->repeats, "of each")
        ->capture_default_str()
        ->check(CLI::PositiveNumber);
    to.add_flag("--json", options->json, "figures as JSON");
}

void add_rays(CLI::App& app)
{
    Command command(app, "rays", "million rays a second on one mesh, build time and memory", bench::run_rays);
    auto& [to, options] = command;
    to.add_option("--mesh", options->mesh, "mesh file");
    to.add_option("--terrain", options->terrain, "instead of a file: a terrain of so many triangles")
        ->check(CLI::Range(std::uint64_t{1}, std::uint64_t{1'000'000'000}));
    to.add_option("--view", options->view, "object: from outside; nave: within Sponza or the museum")
        ->check(CLI::IsMember({"object", "nave"}))
        ->capture_default_str();
    to.add_option("--diagonal", options->diagonals, "sizes to scale the mesh to; 0: its own, as it came")
        ->check(CLI::Range(0.0, 1e6))
        ->delimiter(',')
        ->capture_default_str();
    to.add_option("--peer", options->peer, "engine to measure beside ours")->check(CLI::IsMember({"embree"}));
    add_split(to, options->split);
    to.add_option("--threads", options->threads, "numbers of threads that build and trace: 1,2")
        ->check(CLI::Range(1, 1024))
        ->delimiter(',')
        ->capture_default_str();
    to.add_option("--repeats", options->repeats, "the median is told")
        ->check(CLI::Range(1, 1000))
        ->capture_default_str();
    to.add_option("--only", options->only, "ray sets to trace: primary, shadow, diffuse, ...")
        ->delimiter(',');
    to.add_option("--every", options->every, "of so many runs of 4096 rays of a set trace one")
        ->check(CLI::Range(std::size_t{1}, std::size_t{1'000'000'000}))
        ->capture_default_str();
    to.add_option("--engines", options->engines, "only those whose name contains one of these texts");
    to.add_option("--builds", options->builds, "of each tree, timed; 0: none; not given: as --repeats")
        ->check(CLI::Range(0, 1000));
    to.add_flag("--kernels", options->every_kernel, "every kernel of ours, not only the best");
    to.add_option("--json", options->json, "JSON into this file, - for stdout, instead of the table");
    to.add_flag("--table", options->table, "the table as well as JSON");
}

void add_service(CLI::App& app)
{
    Command command(app, "service", "what the service costs beyond the render itself", bench::run_service);
    auto& [to, options] = command;
    to.add_flag("--json", options->as_json, "figures as JSON");
    to.add_option("--first-tile", options->first_tile, "only: time to the first tile of this mesh")
        ->check(CLI::ExistingFile);
}

void add_sky(CLI::App& app)
{
    Command command(app, "sky", "a panorama of the sky: look-ups beside the plain march", bench::run_sky);
    auto& [to, options] = command;
    to.add_option("--repeats", options->repeats, "of each figure; medians are told")
        ->check(CLI::Range(1, 1000));
    to.add_option("--directions", options->directions, "for the errors")->check(CLI::Range(1, 1'000'000));
}

void add_terrain(CLI::App& app)
{
    Command command(app, "terrain", "write a terrain as a mesh file", bench::run_terrain);
    auto& [to, options] = command;
    to.add_option("file", options->path, "FILE.ply, .obj, .stl or .glb")->required();
    to.add_option("--triangles", options->triangles, "exactly so many")->required();
}

void add_tiles(CLI::App& app)
{
    Command command(app, "tiles", "parallel efficiency of the tile loop", bench::run_tiles);
    auto& [to, options] = command;
    to.add_option("--repeats", options->repeats, "pairs of renders")->capture_default_str();
}

} // namespace

int main(int argc, char** argv)
{
    CLI::App app{"Measures Heliograph beside a peer or a baseline in the same run.", "heliograph-bench"};
    app.require_subcommand(1);
    for (const auto add : {add_evaluation,
                           add_frames,
                           add_import,
                           add_leaks,
                           add_memory,
                           add_rays,
                           add_service,
                           add_sky,
                           add_terrain,
                           add_pictures,
                           add_tiles})
        add(app);
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        return app.exit(error);
    } catch (const std::exception& error) {
        std::cerr << "heliograph-bench: " << error.what() << "\n";
        return 1;
    }
    return 0;
}
