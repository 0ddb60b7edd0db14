// heliograph-bench import FILE: where the time from a mesh file to a tree goes, stage by stage.
//
// read      the file's bytes, from the page cache, into memory: no import can be faster.
// parse     import_mesh in this process, validation of the mesh included.
// validate  validate_mesh alone, which the service runs once more on what the child sent.
// child     a whole import as the service runs it: starting heliograph-import, parsing, handing over, mapping,
//           validating. `hand_over` is what it takes beyond the parse.
// tree      the BVH, on every core. peer: assimp's reader of the same format, without post-processing.
// Times are medians of wall time in ms; `cpu` is of this thread, for a machine that is shared.
#include "renderer/accel/prepared_mesh.h"
#include "renderer/geometry/validate_mesh.h"
#include "renderer/io/import_mesh.h"
#include "server/import/run_import.h"
#include "tests/bench/commands.h"

#include <assimp/Importer.hpp>
#include <assimp/scene.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <chrono>
#include <ctime>
#include <fcntl.h>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iostream>
#include <stdexcept>

namespace bench {

namespace {

using nlohmann::json;

double cpu_ms()
{
    timespec now{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
}

struct Times {
    std::vector<double> wall, cpu;
    void measure(const std::function<void()>& body)
    {
        const auto start = std::chrono::steady_clock::now();
        const double start_cpu = cpu_ms();
        body();
        cpu.push_back(cpu_ms() - start_cpu);
        wall.push_back(
            std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count());
    }
    static double median(std::vector<double> values)
    {
        std::sort(values.begin(), values.end());
        return values.at(values.size() / 2);
    }
    json figures() const { return {{"ms", median(wall)}, {"cpu_ms", median(cpu)}}; }
};

std::vector<std::byte> read_whole(const std::string& path)
{
    std::ifstream file(path, std::ios::binary);
    std::vector<std::byte> bytes(std::filesystem::file_size(path));
    file.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    if (!file) throw std::runtime_error("cannot read " + path);
    return bytes;
}

renderer::Mesh parsed(const std::string& path, std::span<const std::byte> bytes)
{
    auto result = renderer::import_mesh(path, bytes, {}, renderer::Limits::none());
    if (const auto* fault = std::get_if<renderer::ImportFault>(&result))
        throw std::runtime_error(path + ": " + fault->code + ": " + fault->detail);
    return std::move(std::get<renderer::ImportedMesh>(result).mesh);
}

server::ImportRunEnd import_in_child(const std::string& path)
{
    const server::FileDescriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
    if (!file) throw std::runtime_error("cannot open " + path);
    renderer::Limits limits = renderer::Limits::none();
    limits.import_s = 600;
    const auto program = std::filesystem::read_symlink("/proc/self/exe").parent_path() / "heliograph-import";
    auto end = server::run_import({program,
                                   file.get(),
                                   std::filesystem::path(path).extension(),
                                   false,
                                   [](std::string_view) { return server::FileDescriptor(); },
                                   limits,
                                   std::filesystem::file_size(path)},
                                  {});
    if (const auto* failure = std::get_if<server::ImportFailure>(&end.outcome.value()))
        throw std::runtime_error(path + ": " + failure->code + ": " + failure->detail);
    return end;
}

void read_with_assimp(const std::string& path)
{
    Assimp::Importer importer;
    if (!importer.ReadFile(path, 0)) throw std::runtime_error(path + ": " + importer.GetErrorString());
}

json measure(const ImportOptions& options)
{
    Times read, parse, validate, child, tree, peer;
    std::uint64_t child_peak = 0, triangles = 0;
    std::vector<double> child_cpu;
    renderer::ThreadPool pool;
    for (int i = 0; i < options.repeats; ++i) {
        std::vector<std::byte> bytes;
        read.measure([&] { bytes = read_whole(options.file); });
        renderer::Mesh mesh;
        parse.measure([&] { mesh = parsed(options.file, bytes); });
        bytes = {};
        triangles = mesh.triangles.size();
        validate.measure([&] {
            if (renderer::validate_mesh(mesh)) throw std::runtime_error("the mesh is not valid");
        });
        tree.measure([&] { prepare_mesh(std::move(mesh), renderer::MeshTree::wide_sah, pool); });
        child.measure([&] {
            const server::ImportRunEnd end = import_in_child(options.file);
            child_peak = end.peak_bytes;
            child_cpu.push_back(1e3 * end.cpu_s);
        });
        if (options.peer == "assimp") peer.measure([&] { read_with_assimp(options.file); });
    }
    json figures{{"file", options.file},
                 {"bytes", std::filesystem::file_size(options.file)},
                 {"triangles", triangles},
                 {"read", read.figures()},
                 {"parse", parse.figures()},
                 {"validate", validate.figures()},
                 {"child", child.figures()},
                 {"tree", tree.figures()}};
    figures["child"]["child_cpu_ms"] = Times::median(child_cpu);
    figures["child"]["peak_mib"] = static_cast<double>(child_peak) / (1 << 20);
    figures["hand_over_ms"] = Times::median(child.wall) - Times::median(parse.wall);
    const double floor = Times::median(read.wall) + Times::median(tree.wall);
    figures["whole_over_read_and_tree"] = (Times::median(child.wall) + Times::median(tree.wall)) / floor;
    if (options.peer.empty()) return figures;
    figures["assimp"] = peer.figures();
    figures["parse_over_assimp"] = Times::median(parse.cpu) / Times::median(peer.cpu);
    return figures;
}

} // namespace

void run_import(const ImportOptions& options)
{
    const json figures = measure(options);
    if (options.as_json) {
        std::cout << figures.dump(2) << "\n";
        return;
    }
    std::printf("%s: %.1f MB, %.0f triangles\n",
                options.file.c_str(),
                figures["bytes"].get<double>() / 1e6,
                figures["triangles"].get<double>());
    for (const char* stage : {"read", "parse", "validate", "child", "tree", "assimp"})
        if (figures.contains(stage))
            std::printf("%-9s %8.1f ms   %8.1f ms of this thread\n",
                        stage,
                        figures[stage]["ms"].get<double>(),
                        figures[stage]["cpu_ms"].get<double>());
    std::printf("child: %.1f ms of its processor time, %.0f MiB at most\n",
                figures["child"]["child_cpu_ms"].get<double>(),
                figures["child"]["peak_mib"].get<double>());
    std::printf("import and tree over reading and tree: %.2f   goal: under 2\n",
                figures["whole_over_read_and_tree"].get<double>());
    if (figures.contains("assimp"))
        std::printf("parse over assimp: %.2f\n", figures["parse_over_assimp"].get<double>());
}

} // namespace bench
