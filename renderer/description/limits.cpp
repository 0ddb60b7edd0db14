#include "renderer/description/limits.h"

#include <array>
#include <limits>
#include <unistd.h>

namespace renderer {

namespace {

constexpr std::uint64_t kMostBytes = 1ull << 50;
constexpr std::uint64_t kDay_s = 86'400;
constexpr std::uint64_t kMostThreads = 4096; // each waiter holds one
constexpr std::uint64_t kDeepestJson = 512;  // what walks a tree of JSON calls itself for every floor

std::uint64_t physical_memory_bytes()
{
    const long pages = sysconf(_SC_PHYS_PAGES), page_bytes = sysconf(_SC_PAGESIZE);
    if (pages <= 0 || page_bytes <= 0) return std::numeric_limits<std::uint64_t>::max();
    return static_cast<std::uint64_t>(pages) * static_cast<std::uint64_t>(page_bytes);
}

constexpr std::array kTable{
    LimitEntry{"json_bytes", &Limits::json_bytes, "bytes", "largest JSON body", 1ull << 30},
    LimitEntry{"json_depth", &Limits::json_depth, "", "deepest nesting of JSON", kDeepestJson},
    LimitEntry{"json_values", &Limits::json_values, "", "values in a JSON body", 1ull << 28},
    LimitEntry{"asset_bytes", &Limits::asset_bytes, "bytes", "largest asset", kMostBytes},
    LimitEntry{"total_asset_bytes", &Limits::total_asset_bytes, "bytes", "all assets together", kMostBytes},
    LimitEntry{"total_result_bytes",
               &Limits::total_result_bytes,
               "bytes",
               "all jobs together, their pictures, scenes and reports",
               kMostBytes},
    LimitEntry{"image_side_px", &Limits::image_side_px, "pixels", "longest side of a picture", 1ull << 20},
    LimitEntry{"image_pixels", &Limits::image_pixels, "pixels", "largest picture", 1ull << 32},
    LimitEntry{"samples", &Limits::samples, "", "samples a pixel", 1ull << 31},
    LimitEntry{"triangles",
               &Limits::triangles,
               "",
               "triangles in a scene, each mesh counted once",
               (1ull << 32) - 2},
    LimitEntry{"listed_triangles",
               &Limits::listed_triangles,
               "",
               "triangles of all objects where `acceleration` asks for no trees",
               1ull << 40},
    LimitEntry{"objects", &Limits::objects, "", "objects in a scene", 1ull << 31},
    LimitEntry{"texture_pixels",
               &Limits::texture_pixels,
               "pixels",
               "largest picture that is read, as a texture or an environment",
               1ull << 32},
    LimitEntry{"render_memory_bytes",
               &Limits::render_memory_bytes,
               "bytes",
               "film, meshes and BVHs of one render",
               kMostBytes},
    LimitEntry{"queue_jobs", &Limits::queue_jobs, "", "jobs that wait", 1ull << 31},
    LimitEntry{"wait_s", &Limits::wait_s, "s", "longest Prefer: wait", kDay_s},
    LimitEntry{"waiters", &Limits::waiters, "", "requests that wait at the same time", kMostThreads},
    LimitEntry{"header_s", &Limits::header_s, "s", "time to send a request's header", kDay_s},
    LimitEntry{"idle_body_s", &Limits::idle_body_s, "s", "silence within a request's body", kDay_s},
    LimitEntry{"retention_s", &Limits::retention_s, "s", "how long results are kept", 36500 * kDay_s},
    LimitEntry{"import_memory_bytes",
               &Limits::import_memory_bytes,
               "bytes",
               "address space of one import",
               kMostBytes},
    LimitEntry{"import_s", &Limits::import_s, "s", "time of one import", 365 * kDay_s},
    LimitEntry{"import_output_bytes",
               &Limits::import_output_bytes,
               "bytes",
               "imported form of one mesh",
               kMostBytes},
    LimitEntry{
        "mesh_cache_bytes", &Limits::mesh_cache_bytes, "bytes", "prepared meshes kept in memory", kMostBytes},
    LimitEntry{"stored_mesh_bytes",
               &Limits::stored_mesh_bytes,
               "bytes",
               "prepared meshes kept on disk; 0: none",
               kMostBytes},
};

} // namespace

std::span<const LimitEntry> limit_table()
{
    return kTable;
}

Limits Limits::none()
{
    Limits limits;
    for (const LimitEntry& entry : limit_table())
        limits.*entry.value = std::numeric_limits<std::uint64_t>::max();
    limits.json_depth = 64;
    limits.image_side_px = 1u << 20;
    limits.image_pixels = 1ull << 32;
    limits.samples = 1ull << 31;
    limits.triangles = (1ull << 32) - 2; // indices are 32-bit
    limits.texture_pixels = 1ull << 32;
    limits.listed_triangles = 1ull << 40;
    limits.render_memory_bytes = physical_memory_bytes();
    return limits;
}

} // namespace renderer
