#include "tests/support/render_scene.h"

#include "renderer/math/transcendental.h"

#include <bit>
#include <cmath>
#include <stdexcept>

namespace tests {

using namespace renderer;

namespace {

// Quads between neighbours on a grid that closes in both directions or in one.
void add_quad(Mesh& mesh, std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d)
{
    mesh.triangles.push_back({a, b, c});
    mesh.triangles.push_back({a, c, d});
}

Vec3d knot_point(double turn)
{
    const auto [s2, c2] = sin_cos_deg(720 * turn);
    const auto [s3, c3] = sin_cos_deg(1080 * turn);
    return {(2 + c3) * c2, (2 + c3) * s2, s3};
}

} // namespace

ReadyScene make_ready(const TestScene& test, ThreadPool& pool, SceneCaches* caches)
{
    SceneDescription description = test.description;
    std::vector<MeshFacts> facts;
    std::vector<std::shared_ptr<const PreparedMesh>> prepared;
    description.meshes.clear();
    for (const Mesh& mesh : test.meshes) {
        description.meshes.push_back({"mesh" + std::to_string(facts.size()), ""});
        facts.push_back(facts_of(mesh));
    }
    const double aspect = static_cast<double>(test.settings.image.width_px) / test.settings.image.height_px;
    const AssumedScene assumed = assume_defaults(std::move(description), facts, aspect);
    auto plan = make_plan(assumed, facts, test.settings, Limits{});
    if (const auto* const faults = std::get_if<std::vector<Fault>>(&plan))
        throw std::runtime_error(faults->front().pointer + ": " + faults->front().detail);
    for (std::size_t i = 0; i < test.meshes.size(); ++i)
        prepared.push_back(prepare_mesh(test.meshes[i], std::get<Plan>(plan).mesh_trees[i], pool));
    ReadyScene ready{std::move(std::get<Plan>(plan)), nullptr};
    ready.scene = prepare(assumed, ready.plan, prepared, test.settings, pool, {}, test.images, caches);
    return ready;
}

RenderResult render_description(const TestScene& test, unsigned threads, SceneCaches* caches)
{
    ThreadPool pool(threads);
    const ReadyScene ready = make_ready(test, pool, caches);
    return render(*ready.scene, ready.plan, test.settings, pool).value();
}

Mesh knot(std::uint32_t rings, std::uint32_t sides)
{
    Mesh mesh;
    for (std::uint32_t i = 0; i < rings; ++i) {
        const double turn = static_cast<double>(i) / rings;
        const Vec3d center = knot_point(turn);
        const Vec3d tangent = normalize(knot_point(turn + 1e-4) - knot_point(turn - 1e-4));
        const Vec3d side = normalize(cross(tangent, Vec3d{0, 0, 1}));
        const Vec3d up = cross(side, tangent);
        for (std::uint32_t j = 0; j < sides; ++j) {
            const auto [s, c] = sin_cos_deg(360.0 * j / sides);
            const Vec3d normal = side * c + up * s;
            mesh.positions.push_back(to_float(center + normal * 0.45));
            mesh.normals.push_back(to_float(normal));
        }
    }
    for (std::uint32_t i = 0; i < rings; ++i)
        for (std::uint32_t j = 0; j < sides; ++j) {
            const std::uint32_t i1 = (i + 1) % rings, j1 = (j + 1) % sides;
            add_quad(mesh, i * sides + j, i1 * sides + j, i1 * sides + j1, i * sides + j1);
        }
    return mesh;
}

Mesh faceted_sphere(std::uint32_t segments, std::uint32_t rings)
{
    Mesh mesh;
    for (std::uint32_t r = 0; r <= rings; ++r) {
        const auto [st, ct] = sin_cos_deg(180.0 * r / rings);
        for (std::uint32_t s = 0; s < segments; ++s) {
            const auto [sp, cp] = sin_cos_deg(360.0 * s / segments);
            mesh.positions.push_back(to_float({st * cp, ct, -st * sp}));
        }
    }
    mesh.normals = mesh.positions;
    for (std::uint32_t r = 0; r < rings; ++r)
        for (std::uint32_t s = 0; s < segments; ++s) {
            const std::uint32_t s1 = (s + 1) % segments;
            add_quad(
                mesh, r * segments + s, (r + 1) * segments + s, (r + 1) * segments + s1, r * segments + s1);
        }
    return mesh;
}

TestScene kitchen_sink()
{
    TestScene test;
    SceneDescription& d = test.description;
    test.meshes.push_back(knot());
    PhongMaterial shiny;
    shiny.shininess = 60;
    shiny.specular = {0.4f, 0.3f, 0.2f};
    PhongMaterial classic = shiny;
    classic.form = PhongForm::classic;
    classic.ambient = {0.02f, 0.03f, 0.04f};
    d.materials = {{"clay", DiffuseMaterial{{0.7f, 0.5f, 0.3f}}}, {"shiny", shiny}, {"classic", classic}};

    const auto add = [&](Shape shape, std::optional<std::uint32_t> material, const Affine3& place) {
        ObjectDescription& object = d.objects.emplace_back();
        object.shape = std::move(shape);
        object.material = material;
        object.world_from_object = place;
    };
    add(MeshShape{}, 0, Affine3::rotate_deg(25, {0, 1, 0}));
    add(MeshShape{}, 1, Affine3::translate({-1, 2.5, -4}) * Affine3::scale({-0.7, 0.5, 1.1}));
    add(SphereShape{0.8}, 2, Affine3::translate({3, -0.6, 0.5}));
    add(BoxShape{{1, 1.5, 0.6}}, {}, Affine3::translate({-3.4, -1, 1}) * Affine3::rotate_deg(40, {1, 3, 0}));
    add(DiskShape{1.1}, 1, Affine3::translate({1.5, 3, -2}) * Affine3::rotate_deg(-50, {1, 0.2, 0}));
    add(RectangleShape{30, 30}, 0, Affine3::translate({0, -2, 0}) * Affine3::rotate_deg(-90, {1, 0, 0}));

    CameraDescription camera;
    camera.position = {2, 3, 11};
    camera.aim = {0, 0.2, 0};
    camera.fov_deg = 40;
    d.camera = camera;
    d.environment = ColorEnvironment{{0.2f, 0.25f, 0.3f}};
    d.lights.emplace_back(PointLight{{4, 5, 4}, {30, 28, 25}});
    d.lights.emplace_back(SpotLight{{-5, 6, 3}, {5, -7, -4}, {60, 60, 70}, 12, 20});
    d.lights.emplace_back(DirectionalLight{{0.3, -1, -0.2}, {0.5f, 0.5f, 0.4f}});
    test.settings.image.width_px = 70;
    test.settings.image.height_px = 50;
    test.settings.quality.samples = 7;
    return test;
}

std::uint64_t digest(const Film& film)
{
    std::uint64_t hash = 0xcbf29ce484222325u;
    const auto mix = [&](double value) {
        const auto bits = std::bit_cast<std::uint64_t>(value);
        for (unsigned shift = 0; shift < 64; shift += 8) {
            hash ^= (bits >> shift) & 0xffu;
            hash *= 0x100000001b3u;
        }
    };
    for (const RgbSum& sum : film.sums) {
        mix(sum.r);
        mix(sum.g);
        mix(sum.b);
    }
    return hash;
}

std::string hex(std::uint64_t value)
{
    std::string text;
    for (int shift = 60; shift >= 0; shift -= 4)
        text += "0123456789abcdef"[(value >> shift) & 0xf];
    return text;
}

} // namespace tests
