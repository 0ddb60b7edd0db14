// The sub-commands of heliograph-bench: what each may be told, with its defaults, and the function that runs it.
// They print to stdout, and throw std::runtime_error or std::invalid_argument when they cannot measure.
// main.cpp alone knows the command line.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace bench {

struct EvaluationOptions {
    std::vector<std::string> meshes; // files; none: hills
    std::string folder;
    int repeats = 5;
    std::uint32_t width_px = 64, samples = 1;
};
void run_evaluation(const EvaluationOptions& options);

struct ImportOptions {
    std::string file, peer; // peer: "assimp" or none
    int repeats = 5;
    bool as_json = false;
};
void run_import(const ImportOptions& options);

struct FramesOptions {
    std::vector<std::uint32_t> objects{1000, 10'000, 100'000};
    int frames = 24;
    double rays = 1e6; // of a frame
    unsigned threads = 1;
};
void run_frames(const FramesOptions& options);

struct LeaksOptions {
    double rays = 1e8;
    std::vector<std::string> meshes;
    std::string peer; // "embree" or none
    std::string split = "sah";
    unsigned threads = 1;
};
void run_leaks(const LeaksOptions& options);

struct MemoryOptions {
    std::uint64_t triangles = 1'000'000;
    std::uint32_t instances = 0; // 0: the mesh alone
    unsigned threads = 1;
};
void run_memory(const MemoryOptions& options);

struct PicturesOptions {
    std::vector<std::string> scenes; // job files; none: a Cornell box
    std::uint32_t samples = 16;
    std::uint32_t side_px = 256;
    int repeats = 5;
    bool json = false;
};
void run_pictures(const PicturesOptions& options);

struct RaysOptions {
    std::string mesh, view = "object", peer, split = "sah", json;
    std::vector<std::string> only;    // ray sets; none: all
    std::vector<std::string> engines; // texts of which a name contains one; none: all
    std::size_t every = 1;            // of so many runs of 4096 rays one is traced
    std::uint64_t terrain = 0;        // triangles; 0: the mesh file
    std::vector<double> diagonals{0};
    std::vector<unsigned> threads{1};
    bool table = false, every_kernel = false;
    int repeats = 5;
    std::optional<int> builds; // how often they are timed; none: as often as rays
};
void run_rays(const RaysOptions& options);

struct ServiceOptions {
    std::string first_tile; // a mesh file: only its first tile; none: everything else
    bool as_json = false;
};
void run_service(const ServiceOptions& options);

struct SkyOptions {
    int repeats = 5;
    int directions = 500;
};
void run_sky(const SkyOptions& options);

struct TerrainOptions {
    std::string path;
    std::uint64_t triangles = 0;
};
void run_terrain(const TerrainOptions& options);

struct TilesOptions {
    int repeats = 7;
};
void run_tiles(const TilesOptions& options);

} // namespace bench
