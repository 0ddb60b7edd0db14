#include "renderer/description/limits.h"

#include <array>
#include <limits>
#include <unistd.h>

namespace renderer {

namespace {

std::uint64_t physical_memory_bytes()
{
    const long pages = sysconf(_SC_PHYS_PAGES), page_bytes = sysconf(_SC_PAGESIZE);
    if (pages <= 0 || page_bytes <= 0) return std::numeric_limits<std::uint64_t>::max();
    return static_cast<std::uint64_t>(pages) * static_cast<std::uint64_t>(page_bytes);
}

} // namespace

std::span<const LimitEntry> limit_table()
{
    static constexpr std::array table{
        LimitEntry{"json_bytes", &Limits::json_bytes, "bytes", "largest JSON body"},
        LimitEntry{"json_depth", &Limits::json_depth, "", "deepest nesting of JSON"},
        LimitEntry{"json_values", &Limits::json_values, "", "values in a JSON body"},
        LimitEntry{"asset_bytes", &Limits::asset_bytes, "bytes", "largest asset"},
        LimitEntry{"total_asset_bytes", &Limits::total_asset_bytes, "bytes", "all assets together"},
        LimitEntry{"image_side_px", &Limits::image_side_px, "pixels", "longest side of a picture"},
        LimitEntry{"image_pixels", &Limits::image_pixels, "pixels", "largest picture"},
        LimitEntry{"samples", &Limits::samples, "", "samples a pixel"},
        LimitEntry{"triangles", &Limits::triangles, "", "triangles in a scene, each mesh counted once"},
        LimitEntry{"objects", &Limits::objects, "", "objects in a scene"},
        LimitEntry{"render_memory_bytes",
                   &Limits::render_memory_bytes,
                   "bytes",
                   "film, meshes and BVHs of one render"},
        LimitEntry{"queue_jobs", &Limits::queue_jobs, "", "jobs that wait"},
        LimitEntry{"wait_s", &Limits::wait_s, "s", "longest Prefer: wait"},
        LimitEntry{"waiters", &Limits::waiters, "", "requests that wait at the same time"},
        LimitEntry{"streams", &Limits::streams, "", "event streams at the same time"},
        LimitEntry{"header_s", &Limits::header_s, "s", "time to send a request's header"},
        LimitEntry{"idle_body_s", &Limits::idle_body_s, "s", "silence within a request's body"},
        LimitEntry{"retention_s", &Limits::retention_s, "s", "how long results are kept"},
        LimitEntry{
            "import_memory_bytes", &Limits::import_memory_bytes, "bytes", "address space of one import"},
        LimitEntry{"import_s", &Limits::import_s, "s", "time of one import"},
        LimitEntry{"import_output_bytes", &Limits::import_output_bytes, "bytes", "imported form of one mesh"},
        LimitEntry{"mesh_cache_bytes", &Limits::mesh_cache_bytes, "bytes", "prepared meshes kept in memory"},
    };
    return table;
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
    limits.render_memory_bytes = physical_memory_bytes();
    return limits;
}

} // namespace renderer
