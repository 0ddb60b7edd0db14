// Limits: every bound that protects the service from strangers. The one table of names, values and flags is
// limit_table(); capabilities, flags, environment variables, errors and docs are generated from it.
#pragma once

#include <cstdint>
#include <span>

namespace renderer {

struct Limits {
    std::uint64_t json_bytes = 1u << 20;
    std::uint64_t json_depth = 64;
    std::uint64_t json_values = 200'000;
    std::uint64_t asset_bytes = 256ull << 20;
    std::uint64_t total_asset_bytes = 20ull << 30;
    std::uint64_t total_result_bytes = 10ull << 30;
    std::uint64_t image_side_px = 8192;
    std::uint64_t image_pixels = 33'000'000;
    std::uint64_t samples = 65536;
    std::uint64_t triangles = 50'000'000;
    std::uint64_t listed_triangles = 16'000'000; // 16 rays against all of them take a second or so
    std::uint64_t objects = 100'000;
    std::uint64_t texture_pixels = 64'000'000;
    std::uint64_t render_memory_bytes = 8ull << 30;
    std::uint64_t queue_jobs = 1000;
    std::uint64_t wait_s = 60;
    std::uint64_t waiters = 64;
    std::uint64_t header_s = 5;
    std::uint64_t idle_body_s = 30;
    std::uint64_t retention_s = 86400; // a day
    std::uint64_t import_memory_bytes = 1ull << 30;
    std::uint64_t import_s = 30;
    std::uint64_t import_output_bytes = 512ull << 20;
    std::uint64_t mesh_cache_bytes = 2ull << 30;
    std::uint64_t stored_mesh_bytes = 8ull << 30;

    // For a local render: nothing is refused but what cannot be.
    static Limits none();
};

struct LimitEntry {
    const char* name; // as in /v1/capabilities; the flag is --limit-<name with dashes>
    std::uint64_t Limits::*value;
    const char* unit;   // "bytes", "s", "pixels", "" (a count)
    const char* what;   // one line for help and docs
    std::uint64_t most; // that may be set: sums of threads, times in clocks and sizes in memory stay in range
};

std::span<const LimitEntry> limit_table();

} // namespace renderer
