#include "api/job_request.h"
#include "tests/api/example_files.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>

namespace {

using api::JobRequest;

// A job with every choice made at random, as the reader could have made it.
class RandomJob {
public:
    explicit RandomJob(unsigned seed) : random_(seed) {}

    JobRequest make()
    {
        JobRequest job;
        settings(job.settings);
        scene(job);
        if (coin()) job.time_limit_s = positive();
        job.priority = whole(0, 100);
        job.labels = {{"a", text()}, {label_name(), ""}};
        if (coin()) job.fail_on = {"non_finite"};
        job.provenance = coin();
        return job;
    }

private:
    bool coin() { return random_() % 2 == 0; }
    int whole(int low, int high) { return std::uniform_int_distribution(low, high)(random_); }
    double unit() { return std::uniform_real_distribution(0.0, 1.0)(random_); }
    double positive() { return std::ldexp(unit() + 1e-9, whole(-20, 20)); }
    double signed_number() { return (coin() ? 1 : -1) * std::ldexp(unit(), whole(-60, 50)); }
    renderer::Vec3d point() { return {signed_number(), signed_number(), signed_number()}; }
    renderer::Vec3d direction() { return point() + renderer::Vec3d{0, 1e-3, 0}; }
    renderer::Rgb color(float most)
    {
        const auto one = [&] { return static_cast<float>(unit()) * most; };
        return {one(), one(), one()};
    }
    std::string text()
    {
        static const std::vector<std::string> words{
            "clay", "a/b~c", "grün", "\"quoted\"", "line\nbreak", "\x01", "日本", "x.obj"};
        return words[random_() % words.size()] + std::to_string(random_() % 1000);
    }

    // As the reader takes it: no control characters.
    std::string label_name()
    {
        std::string name = text();
        std::erase_if(name, [](char c) { return c >= 0 && c < ' '; });
        return name;
    }

    void settings(renderer::RenderSettings& s)
    {
        s.image.width_px = static_cast<std::uint32_t>(whole(1, 4000));
        s.image.height_px = static_cast<std::uint32_t>(whole(1, 4000));
        if (coin()) s.image.region = {0, s.image.height_px - 1, s.image.width_px, 1};
        s.image.exposure_ev = unit() * 10 - 5;
        s.image.tone = coin()   ? renderer::Tone::srgb
                       : coin() ? renderer::Tone::linear
                                : renderer::Tone::filmic;
        if (coin())
            s.quality.samples = static_cast<std::uint32_t>(whole(1, 65536));
        else
            s.quality.time_s = positive();
        s.quality.max_samples = static_cast<std::uint32_t>(whole(1, 65536));
        s.seed = random_() % (std::uint64_t(1) << 53);
        s.acceleration = {.split = coin() ? renderer::BvhSplit::sah : renderer::BvhSplit::midpoint,
                          .width = coin() ? renderer::BvhWidth::wide : renderer::BvhWidth::binary,
                          .levels = static_cast<renderer::BvhLevels>(whole(0, 2)),
                          .bounds = coin(),
                          .threads = static_cast<std::uint32_t>(whole(0, 64)),
                          .tile_px = static_cast<std::uint32_t>(whole(1, 64))};
    }

    renderer::Material material()
    {
        switch (random_() % 5) {
        case 0:
            return renderer::DiffuseMaterial{{color(1)}};
        case 1: {
            renderer::CookTorranceMaterial m;
            m.base_color.value = color(1);
            m.metallic.value = unit();
            m.roughness.value = unit();
            m.ior = 1e-3 + unit() * 900;
            m.multiscatter = static_cast<renderer::Multiscatter>(whole(0, 2));
            return m;
        }
        case 2: {
            renderer::ConductorMaterial m;
            m.ior = static_cast<renderer::Metal>(whole(0, 9));
            if (coin()) m.ior = renderer::ComplexIor{{1, 0.5f, 2}, color(1000)};
            m.roughness.value = unit();
            return m;
        }
        default:
            break;
        }
        return renderer::PhongMaterial{{color(1)},
                                       {color(1)},
                                       unit() * 1000,
                                       color(1e10f),
                                       coin() ? renderer::PhongForm::classic
                                              : renderer::PhongForm::normalized};
    }

    renderer::Shape shape(JobRequest& job, std::size_t i)
    {
        switch (random_() % 5) {
        case 0: {
            // Meshes are numbered in the order of their first use, each under a name of its own.
            const std::string digest = "sha256:" + std::string(64, static_cast<char>('a' + i % 6));
            const std::string name = text() + "_" + std::to_string(i);
            job.files[name] = digest;
            job.scene.meshes.push_back({name, digest});
            return renderer::MeshShape{static_cast<std::uint32_t>(job.scene.meshes.size() - 1),
                                       coin() ? text() : ""};
        }
        case 1:
            return renderer::RectangleShape{positive(), positive()};
        case 2:
            return renderer::DiskShape{positive()};
        case 3:
            return renderer::BoxShape{{positive(), positive(), positive()}};
        default:
            return renderer::SphereShape{positive()};
        }
    }

    // Such that the reader would take it: a very flat one is refused as singular.
    renderer::Affine3 placement()
    {
        for (;;) {
            const renderer::Affine3 map = renderer::Affine3::translate(point()) *
                                          renderer::Affine3::rotate_deg(unit() * 720 - 360, direction()) *
                                          renderer::Affine3::scale({positive(), -positive(), positive()});
            if (map.inverse()) return map;
        }
    }

    renderer::Light light()
    {
        switch (random_() % 7) {
        case 0:
            return renderer::PointLight{point(), color(1e20f)};
        case 1:
            return renderer::SpotLight{point(), direction(), color(1e-20f), unit() * 10, 10 + unit() * 10};
        case 2:
            return renderer::DirectionalLight{direction(), color(7)};
        case 3:
            return renderer::SunLight{direction(), color(3), 0.1 + unit()};
        case 4:
            return renderer::RectangleLight{area_light(true), positive(), positive()};
        case 5:
            return renderer::DiskLight{area_light(true), positive()};
        default:
            return renderer::SphereLight{area_light(false), positive()};
        }
    }

    renderer::AreaLight area_light(bool has_back)
    {
        renderer::AreaLight light;
        if (coin())
            light.power = color(5);
        else
            light.radiance = color(9);
        light.two_sided = has_back && coin();
        light.world_from_light = placement();
        light.visible_to_camera = coin();
        return light;
    }

    renderer::CameraDescription camera()
    {
        renderer::CameraDescription camera;
        camera.projection =
            static_cast<renderer::Projection>(whole(0, 2)); // a meter settles the picture's size
        camera.position = point();
        camera.aim_is_direction = coin();
        camera.aim = direction();
        camera.up = direction();
        if (camera.projection == renderer::Projection::perspective) {
            camera.fov_deg = 1 + unit() * 178;
            camera.lens_radius_m = coin() ? unit() : 0;
            if (coin()) camera.focus_distance_m = positive();
        }
        if (camera.projection == renderer::Projection::orthographic) camera.height_m = positive();
        return camera;
    }

    renderer::AtmosphereDescription atmosphere()
    {
        renderer::AtmosphereDescription a =
            renderer::atmosphere_preset(static_cast<renderer::AtmospherePreset>(whole(0, 4)));
        if (coin()) a.wavelengths_nm = {700.5, 610, 530, 450};
        if (coin()) a.planet.ground_albedo = {unit()};
        if (coin()) a.rayleigh.scattering = {unit(), unit(), unit(), unit()};
        if (a.rayleigh.scattering.size() == 4) a.wavelengths_nm = {700, 600, 500, 400};
        a.mie.g = unit() * 1.8 - 0.9;
        a.mie.phase = static_cast<renderer::MiePhase>(whole(0, 1));
        a.sun = {unit() * 180 - 90, unit() * 360, color(3), unit(), coin()};
        a.altitude_m = positive();
        a.scattering = static_cast<renderer::SkyScattering>(whole(0, 1));
        a.mode = static_cast<renderer::SkyMode>(whole(0, 2));
        a.aerial_perspective = coin();
        return a;
    }

    void scene(JobRequest& job)
    {
        renderer::SceneDescription& scene = job.scene;
        if (coin()) scene.camera = camera();
        if (coin()) scene.environment = renderer::NoEnvironment{};
        if (coin()) scene.environment = renderer::ColorEnvironment{color(3)};
        if (coin()) scene.environment = atmosphere();
        for (int i = 0; i < whole(0, 4); ++i)
            scene.materials.push_back({std::to_string(i) + text(), material()}); // sorted by name, as read
        const int objects = whole(1, 6);
        for (int i = 0; i < objects; ++i) {
            renderer::ObjectDescription object;
            object.shape = shape(job, static_cast<std::size_t>(i));
            if (!scene.materials.empty() && coin())
                object.material = static_cast<std::uint32_t>(random_() % scene.materials.size());
            object.world_from_object = placement();
            object.visible_to_camera = coin();
            object.shading = static_cast<renderer::Shading>(whole(0, 2));
            scene.objects.push_back(object);
        }
        for (int i = 0; i < whole(0, 3); ++i)
            scene.lights.push_back(light());
        scene.transport.type = static_cast<renderer::TransportType>(whole(0, 5));
        if (coin()) scene.transport.max_depth = static_cast<std::uint32_t>(whole(0, 1000));
        if (coin()) scene.transport.clamp = positive();
    }

    std::mt19937_64 random_;
};

TEST(WriteJob, ReadsBackToTheSameJob)
{
    for (unsigned seed = 0; seed < 2000; ++seed) {
        const JobRequest job = RandomJob(seed).make();
        for (const bool pretty : {false, true}) {
            const std::string text = api::write_job(job, pretty);
            const auto read = api::read_job(text, {});
            const auto* problem = std::get_if<api::ProblemDetails>(&read);
            ASSERT_EQ(problem, nullptr) << "seed " << seed << "\n"
                                        << test_api::faults_as_text(*problem) << text;
            ASSERT_TRUE(std::get<JobRequest>(read) == job) << "seed " << seed << "\n" << text;
        }
    }
}

TEST(WriteJob, WritesTheSameTextAgain)
{
    for (unsigned seed = 0; seed < 200; ++seed) {
        const std::string text = api::write_job(RandomJob(seed).make());
        EXPECT_EQ(api::write_job(std::get<JobRequest>(api::read_job(text, {}))), text);
    }
}

TEST(WriteJob, WritesEveryDefaultOut)
{
    const auto job =
        std::get<JobRequest>(api::read_job(R"({"scene": {"objects": [{"shape": "sphere"}]}})", {}));
    const auto json = nlohmann::json::parse(api::write_job(job));
    EXPECT_EQ(json["quality"]["samples"], 64);
    EXPECT_EQ(json["image"]["width"], 800);
    EXPECT_EQ(json["image"]["tone"], "srgb");
    EXPECT_EQ(json["seed"], 1);
    EXPECT_EQ(json["priority"], 50);
    EXPECT_EQ(json["provenance"], true);
    EXPECT_EQ(json["scene"]["objects"][0]["radius"], 0.5);
    EXPECT_EQ(json["scene"]["objects"][0]["shading"], "auto");
    EXPECT_EQ(json["scene"]["objects"][0]["matrix"].size(), 16u);
    EXPECT_EQ(json["scene"]["transport"]["type"], "auto");
    EXPECT_FALSE(json["scene"].contains("camera")) << "left to be framed";
    EXPECT_FALSE(json["scene"].contains("environment")) << "left to be assumed";
}

std::string key_of(const std::string& text, const api::ReadContext& context = {})
{
    const auto read = api::read_job(text, context);
    EXPECT_TRUE(std::holds_alternative<JobRequest>(read)) << text;
    return api::canonical_render_text(std::get<JobRequest>(read));
}

TEST(CanonicalRenderText, IsTheSameForTheSamePicture)
{
    const std::string plain = key_of(R"({"scene": {"objects": [{"shape": "sphere"}]}, "seed": 1})");
    EXPECT_EQ(key_of(R"({"seed": 1.0, "scene": {"objects": [{"radius": 0.5, "shape": "sphere"}]}})"), plain);
    EXPECT_EQ(key_of(R"({"scene": {"objects": [{"shape": "sphere"}]}, "labels": {"a": "b"}, "priority": 3,
        "limits": {"time_s": 9}, "acceleration": {"threads": 2, "tile": 4, "bvh": {"split": "midpoint"}}})"),
              plain);
    EXPECT_EQ(
        key_of(R"({"scene": {"objects": [{"shape": "sphere", "transform": [{"translate": [0, 0, 0]}]}]}})"),
        plain);
    EXPECT_EQ(key_of(R"({"scene": {"objects": [{"shape": "sphere"}]}, "files": {"unused.obj": "sha256:)" +
                     std::string(64, 'a') + "\"}}"),
              plain)
        << "without a mesh no file is opened";
}

TEST(CanonicalRenderText, DiffersWhereThePictureMay)
{
    const std::string a = "sha256:" + std::string(64, 'a'), b = "sha256:" + std::string(64, 'b');
    const auto mesh_job = [](const std::string& obj, const std::string& mtl) {
        return R"({"files": {"x.obj": ")" + obj + R"(", "x.mtl": ")" + mtl +
               R"("}, "scene": {"objects": [{"mesh": "x.obj"}]}})";
    };
    EXPECT_NE(key_of(mesh_job(a, a)), key_of(mesh_job(b, a))) << "the mesh";
    EXPECT_NE(key_of(mesh_job(a, a)), key_of(mesh_job(a, b))) << "a file that the mesh may open";
    const std::string scene = R"({"scene": {"objects": [{"shape": "sphere"}]})";
    const std::string plain = key_of(scene + "}");
    for (const char* more : {R"("seed": 2)",
                             R"("image": {"width": 801})",
                             R"("image": {"tone": "linear"})",
                             R"("quality": {"samples": 65})",
                             R"("quality": {"time_s": 1})",
                             R"("provenance": false)",
                             R"("fail_on": ["non_finite"])"})
        EXPECT_NE(key_of(scene + ", " + more + "}"), plain) << more;
}

TEST(CanonicalRenderText, NamesTheBuild)
{
    const auto json = nlohmann::json::parse(key_of(R"({"scene": {"objects": [{"shape": "sphere"}]}})"));
    EXPECT_FALSE(json["build"]["version"].get<std::string>().empty());
    EXPECT_FALSE(json["build"]["commit"].get<std::string>().empty());
}

} // namespace
