// heliograph-bench evaluation: what each thing that makes pictures fast is worth: the same picture with bounding
// boxes, with trees of every kind, with threads, with tiles, and without.
#include "tests/bench/evaluation.h"

#include "renderer/parallel/thread_pool.h"
#include "tests/bench/bench_mesh.h"
#include "tests/bench/commands.h"
#include "tests/bench/terrain.h"

#include <nlohmann/json.hpp>

#include <cmath>
#include <fstream>
#include <memory>
#include <stdexcept>

namespace bench {

namespace {

using namespace renderer;

struct NamedMesh {
    std::string name;
    Mesh mesh;
};

// Into a box of one metre about the origin.
NamedMesh at_unit_size(NamedMesh named)
{
    scale_mesh(named.mesh, 1 / diagonal_of(named.mesh));
    Bounds3f bounds;
    for (const Vec3f& position : named.mesh.positions)
        bounds.extend(position);
    const Vec3f center = bounds.center();
    for (Vec3f& position : named.mesh.positions)
        position = position - center;
    return named;
}

std::vector<NamedMesh> meshes_of(const EvaluationOptions& options)
{
    std::vector<NamedMesh> meshes;
    for (const std::string& path : options.meshes)
        meshes.push_back(at_unit_size({std::filesystem::path(path).filename().string(), read_mesh(path)}));
    if (meshes.empty()) {
        meshes.push_back(at_unit_size({"hills", terrain_mesh(20'000)}));
        meshes.push_back(at_unit_size({"more hills", terrain_mesh(70'000)}));
    }
    return meshes;
}

Subject subject_of(std::string name, const EvaluationOptions& options)
{
    Subject subject{std::move(name), {}, {}, {}};
    subject.settings.image.width_px = options.width_px;
    subject.settings.image.height_px = options.width_px * 3 / 4;
    subject.settings.quality.samples = options.samples;
    return subject;
}

void add_mesh(Subject& subject, const NamedMesh& named)
{
    subject.scene.meshes.push_back({named.name, ""});
    subject.meshes.push_back(named.mesh);
}

// One mesh, from the renderer's own point of view and in its own light.
Subject alone(const NamedMesh& named, const EvaluationOptions& options)
{
    Subject subject = subject_of(named.name, options);
    add_mesh(subject, named);
    subject.scene.objects.emplace_back().shape = MeshShape{};
    return subject;
}

// Each mesh several times on a floor, a point light and a sky above.
Subject together(const std::vector<NamedMesh>& meshes, const EvaluationOptions& options)
{
    Subject subject = subject_of("a scene", options);
    for (const NamedMesh& named : meshes)
        add_mesh(subject, named);
    constexpr int kObjects = 6, kAcross = 3;
    for (int i = 0; i < kObjects; ++i) {
        ObjectDescription& object = subject.scene.objects.emplace_back();
        object.shape = MeshShape{static_cast<std::uint32_t>(static_cast<std::size_t>(i) % meshes.size()), ""};
        object.world_from_object = Affine3::translate({1.1 * (i % kAcross - 1), 0.5, -1.2 * (i / kAcross)}) *
                                   Affine3::rotate_deg(40 * i, {0, 1, 0});
    }
    ObjectDescription& floor = subject.scene.objects.emplace_back();
    floor.shape = RectangleShape{8, 8};
    floor.world_from_object = Affine3::rotate_deg(-90, {1, 0, 0});
    subject.scene.camera =
        CameraDescription{.position = {0.6, 1.6, 3.4}, .aim = {0, 0.35, -0.6}, .fov_deg = 45};
    subject.scene.lights.push_back(PointLight{.position = {2, 4, 3}, .intensity = {30, 30, 30}});
    subject.scene.environment = ColorEnvironment{{0.3f, 0.35f, 0.45f}};
    return subject;
}

AccelerationSettings acceleration(BvhLevels levels, bool bounds = false, unsigned threads = 1)
{
    return {.split = BvhSplit::sah, .levels = levels, .bounds = bounds, .threads = threads};
}

AccelerationSettings
tree(BvhSplit split, BvhWidth width, BvhLevels levels = BvhLevels::two, unsigned threads = 1)
{
    return {.split = split, .width = width, .levels = levels, .threads = threads};
}

Figure bounding_boxes(const std::vector<NamedMesh>& meshes, const EvaluationOptions& options)
{
    Figure figure{.name = "bounding_boxes",
                  .title = "A bounding box around each object",
                  .note = "One thread; every triangle is tested where the ray meets the box.",
                  .comparisons = {}};
    for (const NamedMesh& named : meshes)
        figure.comparisons.push_back(compare(alone(named, options),
                                             {{"nothing", acceleration(BvhLevels::none)},
                                              {"bounding box", acceleration(BvhLevels::none, true)}},
                                             options.repeats));
    return figure;
}

std::vector<Variant> trees()
{
    return {{"nothing", acceleration(BvhLevels::none)},
            {"bounding boxes", acceleration(BvhLevels::none, true)},
            {"midpoint, binary, on meshes", tree(BvhSplit::midpoint, BvhWidth::binary, BvhLevels::mesh)},
            {"midpoint, binary, on meshes and scene", tree(BvhSplit::midpoint, BvhWidth::binary)},
            {"SAH, binary, on meshes and scene", tree(BvhSplit::sah, BvhWidth::binary)},
            {"midpoint, wide, on meshes and scene", tree(BvhSplit::midpoint, BvhWidth::wide)},
            {"SAH, wide, on meshes", tree(BvhSplit::sah, BvhWidth::wide, BvhLevels::mesh)},
            {"SAH, wide, on meshes and scene", tree(BvhSplit::sah, BvhWidth::wide)}};
}

Figure hierarchies(const Subject& scene, const EvaluationOptions& options)
{
    return {.name = "hierarchies",
            .title = "Bounding volume hierarchies",
            .note = "One thread.",
            .comparisons = {compare(scene, trees(), options.repeats)}};
}

// The same hills, more finely cut.
Figure growth(const EvaluationOptions& options)
{
    Figure figure{.name = "growth",
                  .title = "With the number of triangles",
                  .note = "One thread; the same hills, more finely cut.",
                  .comparisons = {}};
    for (const std::uint64_t triangles : {1'000u, 10'000u, 100'000u})
        figure.comparisons.push_back(
            compare(alone(at_unit_size({"hills", terrain_mesh(triangles)}), options),
                    {{"nothing", acceleration(BvhLevels::none)},
                     {"midpoint, binary", tree(BvhSplit::midpoint, BvhWidth::binary)},
                     {"SAH, binary", tree(BvhSplit::sah, BvhWidth::binary)},
                     {"SAH, wide", tree(BvhSplit::sah, BvhWidth::wide)}},
                    options.repeats));
    return figure;
}

Subject larger(Subject subject)
{
    subject.settings.image.width_px *= 4;
    subject.settings.image.height_px *= 4;
    subject.settings.quality.samples = 4 * subject.settings.quality.samples.value();
    return subject;
}

Figure threads(const Subject& scene, const EvaluationOptions& options)
{
    const auto with = [](unsigned count, std::uint32_t tile_px) {
        return AccelerationSettings{.split = BvhSplit::sah, .threads = count, .tile_px = tile_px};
    };
    constexpr std::uint32_t kOneTile = 4096;
    return {.name = "threads",
            .title = "Threads, tiles, and how tiles reach threads",
            .note = "SAH, wide. " + std::to_string(usable_cores()) + " cores.",
            .wall = true,
            .comparisons = {compare(larger(scene),
                                    {{"one thread, no tiles", with(1, kOneTile)},
                                     {"one thread, tiles of 16", with(1, 16)},
                                     {"std::async a pixel", with(0, 16), Scheduler::async_a_pixel},
                                     {"std::async a tile of 16", with(0, 16), Scheduler::async_a_tile},
                                     {"pool, no tiles", with(0, kOneTile)},
                                     {"pool, tiles of 16", with(0, 16)},
                                     {"pool, tiles of 64", with(0, 64)}},
                                    options.repeats)}};
}

Figure overall(const Subject& scene, const EvaluationOptions& options)
{
    AccelerationSettings midpoint_threads = tree(BvhSplit::midpoint, BvhWidth::binary, BvhLevels::two, 0);
    return {.name = "overall",
            .title = "All of it together",
            .note = "From nothing on one thread to what the renderer does by itself.",
            .wall = true,
            .comparisons = {
                compare(scene,
                        {{"nothing", acceleration(BvhLevels::none)},
                         {"threads", acceleration(BvhLevels::none, false, 0)},
                         {"bounding boxes", acceleration(BvhLevels::none, true)},
                         {"midpoint, binary", tree(BvhSplit::midpoint, BvhWidth::binary)},
                         {"midpoint, binary, std::async a tile", midpoint_threads, Scheduler::async_a_tile},
                         {"midpoint, binary, threads and tiles", midpoint_threads},
                         {"SAH, wide", tree(BvhSplit::sah, BvhWidth::wide)},
                         {"SAH, wide, threads and tiles", AccelerationSettings{}}},
                        options.repeats)}};
}

} // namespace

void run_evaluation(const EvaluationOptions& options)
{
    std::filesystem::create_directories(options.folder);
    const std::vector<NamedMesh> meshes = meshes_of(options);
    const Subject scene = together(meshes, options);
    EvaluationReport report{.repeats = options.repeats, .figures = {}};
    report.figures.push_back(bounding_boxes(meshes, options));
    report.figures.push_back(hierarchies(scene, options));
    report.figures.push_back(growth(options));
    report.figures.push_back(threads(scene, options));
    report.figures.push_back(overall(scene, options));
    print_table(report);
    write_charts(report, options.folder);
    const std::filesystem::path path = std::filesystem::path(options.folder) / "evaluation.json";
    std::ofstream file(path);
    if (!(file << to_json(report).dump(2) << "\n") || !file.flush())
        throw std::runtime_error("cannot write " + path.string());
    for (const Figure& figure : report.figures)
        for (const Comparison& c : figure.comparisons)
            for (const Row& row : c.rows)
                if (!row.same_picture)
                    throw std::runtime_error("the picture differs: " + c.subject + ", " + row.variant);
}

} // namespace bench
