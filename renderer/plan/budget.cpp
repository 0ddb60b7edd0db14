#include "renderer/plan/budget.h"

#include <limits>
#include <variant>

namespace renderer {

namespace {

constexpr std::uint64_t kFilmBytesPerPixel =
    3 * 8 + 3 * 4 + 3 + 3 + 3; // sums, mean, 8 bit, and the encoder's two copies
constexpr std::uint64_t kBytesPerVertex = 12 + 12 + 8;
constexpr std::uint64_t kBytesPerTriangle = 12 + 2 + 128; // indices, material, and BVH nodes with leaves
constexpr std::uint64_t kBytesPerObject = 512;

std::uint64_t saturating_product(std::uint64_t a, std::uint64_t b)
{
    constexpr auto kMost = std::numeric_limits<std::uint64_t>::max();
    return b != 0 && a > kMost / b ? kMost : a * b;
}

std::string refused(std::uint64_t value, const std::string& what, const char* limit_name, std::uint64_t limit)
{
    return std::to_string(value) + " " + what + ", the limit `" + limit_name + "` is " +
           std::to_string(limit);
}

} // namespace

Budget
predict(const SceneDescription& scene, std::span<const MeshFacts> meshes, const RenderSettings& settings)
{
    Budget b;
    const ImageSettings& image = settings.image;
    b.pixels = image.region ? std::uint64_t{image.region->width} * image.region->height
                            : std::uint64_t{image.width_px} * image.height_px;
    b.film_bytes = b.pixels * kFilmBytesPerPixel;
    b.mesh_bytes = scene.objects.size() * kBytesPerObject;
    for (const MeshFacts& facts : meshes) {
        b.triangles += facts.triangles;
        b.mesh_bytes += facts.triangles * kBytesPerTriangle + facts.vertices * kBytesPerVertex;
    }
    const QualitySettings& quality = settings.quality;
    const std::uint64_t samples = quality.samples  ? *quality.samples
                                  : quality.time_s ? quality.max_samples
                                                   : kDefaultSamples;
    b.camera_rays = b.pixels * samples;
    const bool sky = scene.environment && !std::holds_alternative<NoEnvironment>(*scene.environment);
    b.shadow_rays = saturating_product(b.camera_rays, scene.lights.size() + (sky ? 1u : 0u));
    return b;
}

std::vector<Fault> check_budget(const Budget& budget, const Limits& limits)
{
    std::vector<Fault> faults;
    if (budget.pixels > limits.image_pixels)
        faults.push_back(
            {"/image", "over_limit", refused(budget.pixels, "pixels", "image_pixels", limits.image_pixels)});
    if (budget.triangles > limits.triangles)
        faults.push_back({"/scene/objects",
                          "over_limit",
                          refused(budget.triangles, "triangles", "triangles", limits.triangles)});
    const std::uint64_t memory = budget.film_bytes + budget.mesh_bytes;
    if (memory > limits.render_memory_bytes)
        faults.push_back(
            {budget.film_bytes > budget.mesh_bytes ? "/image" : "/scene/objects",
             "over_limit",
             refused(memory,
                     "bytes of memory (" + std::to_string(budget.film_bytes) + " for the picture, " +
                         std::to_string(budget.mesh_bytes) + " for meshes)",
                     "render_memory_bytes",
                     limits.render_memory_bytes)});
    return faults;
}

} // namespace renderer
