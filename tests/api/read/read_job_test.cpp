#include "api/job_request.h"
#include "renderer/description/settings.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

namespace {

using api::JobRequest;
using api::Problem;
using api::ProblemDetails;
using api::ReadContext;

JobRequest accepted(const std::string& text, const ReadContext& context = {})
{
    auto read = api::read_job(text, context);
    if (auto* problem = std::get_if<ProblemDetails>(&read)) {
        ADD_FAILURE() << problem->detail << "\nin " << text;
        return {};
    }
    return std::get<JobRequest>(std::move(read));
}

std::vector<Problem> faults(const std::string& text, const ReadContext& context = {})
{
    const auto read = api::read_job(text, context);
    const auto* problem = std::get_if<ProblemDetails>(&read);
    if (!problem) {
        ADD_FAILURE() << "reads without fault: " << text;
        return {};
    }
    return problem->errors;
}

Problem fault(const std::string& text, const ReadContext& context = {})
{
    const std::vector<Problem> all = faults(text, context);
    EXPECT_EQ(all.size(), 1u) << text;
    return all.empty() ? Problem{} : all[0];
}

std::string with(const std::string& members)
{
    return R"({"scene": {"objects": [{"shape": "sphere"}]}, )" + members + "}";
}

std::string with_object(const std::string& members)
{
    return R"({"scene": {"objects": [{)" + members + "}]}}";
}

TEST(ReadJob, FillsWhatIsLeftOutFromTheStructs)
{
    const JobRequest job = accepted(R"({"scene": {"objects": [{"shape": "sphere"}]}})");
    JobRequest expected;
    expected.scene.objects.push_back(
        {.shape = renderer::SphereShape{}, .material = {}, .world_from_object = {}});
    expected.settings.quality.samples = renderer::kDefaultSamples;
    EXPECT_TRUE(job == expected);
}

TEST(ReadJob, ResolvesMeshesOnceEachInOrderOfUse)
{
    ReadContext context;
    context.files = {{"b.obj", "sha256:" + std::string(64, 'b')}};
    const std::string direct = "sha256:" + std::string(64, 'd');
    const JobRequest job =
        accepted(R"({"files": {"a.obj": "sha256:)" + std::string(64, 'a') +
                     R"("}, "scene": {"objects": [{"mesh": "b.obj"}, {"mesh": "a.obj"}, {"mesh": ")" +
                     direct + R"("}, {"mesh": "b.obj", "part": "lid"}]}})",
                 context);
    ASSERT_EQ(job.scene.meshes.size(), 3u);
    EXPECT_EQ(job.scene.meshes[0].name, "b.obj");
    EXPECT_EQ(job.scene.meshes[0].digest, "sha256:" + std::string(64, 'b'));
    EXPECT_EQ(job.scene.meshes[1].digest, "sha256:" + std::string(64, 'a'));
    EXPECT_EQ(job.scene.meshes[2].digest, direct);
    EXPECT_EQ(std::get<renderer::MeshShape>(job.scene.objects[3].shape), (renderer::MeshShape{0, "lid"}));
    EXPECT_EQ(job.files.size(), 2u) << "parts of the request are among the files";
}

TEST(ReadJob, TakesUnknownMeshNamesForPathsInALocalRender)
{
    const JobRequest job = accepted(with_object(R"("mesh": "../models/knot.obj")"), {.local = true});
    ASSERT_EQ(job.scene.meshes.size(), 1u);
    EXPECT_EQ(job.scene.meshes[0], (renderer::MeshReference{"../models/knot.obj", ""}));
}

TEST(ReadJob, AsksForEveryDigest)
{
    std::vector<std::string> asked;
    ReadContext context;
    context.has_asset = [&](std::string_view digest) {
        asked.emplace_back(digest);
        return false;
    };
    const std::string a = "sha256:" + std::string(64, 'a'), b = "sha256:" + std::string(64, 'b');
    const auto found = faults(
        R"({"files": {"a": ")" + a + R"("}, "scene": {"objects": [{"mesh": ")" + b + R"("}]}})", context);
    EXPECT_EQ(asked, (std::vector<std::string>{a, b}));
    ASSERT_EQ(found.size(), 2u);
    EXPECT_EQ(found[0].pointer, "/files/a");
    EXPECT_EQ(found[1].detail, b + " is not uploaded: PUT /v1/assets/" + b);
}

TEST(ReadJob, AppliesTransformStepsInTheirOrder)
{
    const JobRequest job = accepted(with_object(
        R"("shape": "box", "transform": [{"scale": 2}, {"rotate_deg": 90, "axis": [0, 0, 3]}, {"translate": [1, 0, 0]}])"));
    const renderer::Vec3d moved = job.scene.objects[0].world_from_object.point({1, 0, 0});
    EXPECT_EQ(moved, (renderer::Vec3d{1, 2, 0})) << "scaled to (2,0,0), turned to (0,2,0), moved to (1,2,0)";
}

TEST(ReadJob, ReadsMatricesRowByRow)
{
    const JobRequest job = accepted(
        with_object(R"("shape": "box", "matrix": [1, 2, 3, 4, 0, 6, 7, 8, 0, 0, 11, 12, 0, 0, 0, 1])"));
    EXPECT_EQ(job.scene.objects[0].world_from_object.point({1, 10, 100}), (renderer::Vec3d{325, 768, 1112}));
}

TEST(ReadJob, NamesMaterialsByIndexInOrderOfName)
{
    const JobRequest job = accepted(R"({"scene": {"materials": {"z": {"type": "phong", "form": "classic"},
        "a": {"type": "diffuse"}}, "objects": [{"shape": "box", "material": "z"}, {"shape": "box"}]}})");
    ASSERT_EQ(job.scene.materials.size(), 2u);
    EXPECT_EQ(job.scene.materials[0].name, "a");
    EXPECT_EQ(job.scene.objects[0].material, 1u);
    EXPECT_FALSE(job.scene.objects[1].material);
    EXPECT_EQ(std::get<renderer::PhongMaterial>(job.scene.materials[1].material).form,
              renderer::PhongForm::classic);
}

TEST(ReadJob, TellsDirectionFromPoint)
{
    const JobRequest job =
        accepted(R"({"scene": {"camera": {"direction": [0, -2, 0]}, "objects": [{"shape": "box"}]}})");
    EXPECT_TRUE(job.scene.camera->aim_is_direction);
    EXPECT_EQ(job.scene.camera->aim, (renderer::Vec3d{0, -2, 0}));
}

TEST(ReadJob, NamesTheLimitItsValueAndItsFlag)
{
    ReadContext context;
    context.limits.image_side_px = 512;
    const Problem wide = fault(with(R"("image": {"width": 513, "height": 1})"), context);
    EXPECT_EQ(wide.pointer, "/image/width");
    EXPECT_EQ(wide.detail,
              "513 pixels is over the limit image_side_px, 512 pixels; the service raises it with "
              "--limit-image-side-px");
    context.limits.objects = 1;
    context.limits.image_side_px = 8192;
    EXPECT_EQ(fault(R"({"scene": {"objects": [{"shape": "box"}, {"shape": "box"}]}})", context).pointer,
              "/scene/objects");
}

TEST(ReadJob, CountsThePixelsOfACropAlone)
{
    ReadContext context;
    context.limits.image_pixels = 100;
    accepted(with(R"("image": {"width": 1000, "height": 1000, "region": {"width": 10, "height": 10}})"),
             context);
    EXPECT_EQ(
        fault(with(R"("image": {"width": 1000, "height": 1000, "region": {"width": 10, "height": 11}})"),
              context)
            .code,
        "over_limit");
    EXPECT_EQ(fault(with(R"("image": {"width": 11, "height": 10})"), context).pointer, "/image");
}

TEST(ReadJob, KeepsDefaultsWithinASmallServicesLimits)
{
    ReadContext context;
    context.limits.samples = 10;
    const JobRequest job = accepted(R"({"scene": {"objects": [{"shape": "box"}]}})", context);
    EXPECT_EQ(job.settings.quality.samples, 10u);
    EXPECT_EQ(job.settings.quality.max_samples, 10u);
    EXPECT_TRUE(accepted(api::write_job(job), context) == job);
}

TEST(ReadJob, LeavesTheLocalRenderItsFreedom)
{
    const ReadContext local{.limits = renderer::Limits::none(), .local = true};
    accepted(with(R"("image": {"width": 100000, "height": 20000}, "quality": {"samples": 1000000})"), local);
    EXPECT_EQ(fault(with(R"("quality": {"samples": 4294967296})"), local).code, "over_limit");
}

TEST(ReadJob, SaysWhatWasMeant)
{
    EXPECT_NE(fault(with(R"("prioriti": 1)")).detail.find("did you mean \"priority\"?"), std::string::npos);
    EXPECT_NE(fault(with(R"("objects": [])")).detail.find("it stands in \"scene\""), std::string::npos);
    EXPECT_NE(
        fault(R"({"scene": {"objects": [{"shape": "box"}], "seed": 1}})").detail.find("beside \"scene\""),
        std::string::npos);
    EXPECT_NE(fault(with_object(R"("shape": "spher")")).detail.find("did you mean \"sphere\"?"),
              std::string::npos);
    const Problem material = fault(R"({"scene": {"materials": {"clay": {"type": "diffuse"}},
        "objects": [{"shape": "box", "material": "caly"}]}})");
    EXPECT_NE(material.detail.find("there are: clay; did you mean \"clay\"?"), std::string::npos)
        << material.detail;
    const Problem mesh = fault(R"({"files": {"bunny.obj": "sha256:)" + std::string(64, 'a') +
                               R"("}, "scene": {"objects": [{"mesh": "bunny.ojb"}]}})");
    EXPECT_NE(mesh.detail.find("did you mean \"bunny.obj\"?"), std::string::npos) << mesh.detail;
}

TEST(ReadJob, SaysWhatIsAvailableInsteadOfWhatIsNot)
{
    const auto read =
        api::read_job(R"({"scene": {"objects": [{"shape": "sphere"}]}, "fail_on": ["target_missed"]})", {});
    const auto* problem = std::get_if<ProblemDetails>(&read);
    ASSERT_TRUE(problem);
    EXPECT_EQ(problem->status, 422);
    EXPECT_EQ(problem->code, "unsupported");
    ASSERT_EQ(problem->errors.size(), 1u);
    EXPECT_EQ(problem->errors[0].detail,
              "\"target_missed\" is not available in this build; available: non_finite");
}

TEST(ReadJob, TellsRanges)
{
    EXPECT_EQ(fault(with(R"("image": {"exposure_ev": -100.5})")).detail, "-100.5 is not in [-100, 100]");
    EXPECT_EQ(fault(R"({"scene": {"camera": {"fov_deg": 180}, "objects": [{"shape": "box"}]}})").detail,
              "180 is not in (0, 180)");
    EXPECT_EQ(fault(with(R"("priority": -3)")).detail, "-3 is not in [0, 100]");
    EXPECT_EQ(fault(with(R"("seed": 1e300)")).detail, "1e+300 is not in [0, 9007199254740991]");
}

TEST(ReadJob, OrdersFaultsByWhereTheyAreNotByWhereTheyStand)
{
    const std::vector<Problem> forth = faults(
        R"({"seed": -1, "scene": {"objects": [{"shape": "box", "size": [0, 1, 1]}]}, "priority": -1})");
    const std::vector<Problem> back = faults(
        R"({"priority": -1, "scene": {"objects": [{"size": [0, 1, 1], "shape": "box"}]}, "seed": -1})");
    EXPECT_EQ(forth, back);
    ASSERT_EQ(forth.size(), 3u);
    EXPECT_EQ(forth[1].pointer, "/scene/objects/0/size/0");
}

TEST(ReadJob, BoundsTheListOfFaults)
{
    std::string objects;
    for (int i = 0; i < 5000; ++i)
        objects += R"({"shape": "sphere", "material": "nowhere"},)";
    objects.back() = ' ';
    const std::vector<Problem> all = faults(R"({"scene": {"objects": [)" + objects + "]}}");
    ASSERT_EQ(all.size(), 1001u);
    EXPECT_EQ(all.back().code, "more_faults");
    EXPECT_EQ(all.back().detail.substr(0, 4), "4000");
}

TEST(ReadJob, BoundsNamesThatPointersWouldRepeat)
{
    const std::string name(100'000, 'n');
    const Problem material =
        fault(R"({"scene": {"materials": {")" + name + R"(": {"type": "diffuse", "color": [2, 2, 2]}},
        "objects": [{"shape": "box"}]}})");
    EXPECT_EQ(material.code, "bad_name");
    const Problem unknown = fault(with('"' + name + R"(": 1)"));
    EXPECT_EQ(unknown.code, "unknown_member");
    EXPECT_LT(unknown.pointer.size() + unknown.detail.size(), 1000u);
    EXPECT_EQ(fault(with(R"("labels": {"a": ")" + name + R"("})")).code, "wrong_length");
    EXPECT_EQ(fault(with_object(R"("mesh": ")" + name + '"')).code, "wrong_length");
    std::string labels;
    for (int i = 0; i < 65; ++i)
        labels += '"' + std::to_string(i) + R"(": "x",)";
    labels.back() = ' ';
    EXPECT_EQ(fault(with(R"("labels": {)" + labels + "}")).code, "wrong_length");
}

TEST(ReadJob, RefusesLabelsThatCouldNotBeAskedFor)
{
    for (const char* name : {"a:b", ":", "a\\u0000", "a\\n", "\\u007f"}) {
        const Problem refused = fault(with(R"("labels": {")" + std::string(name) + R"(": "x"})"));
        EXPECT_EQ(refused.code, "bad_name") << name;
        EXPECT_NE(refused.detail.find("colon"), std::string::npos) << refused.detail;
    }
    EXPECT_EQ(accepted(with(R"("labels": {"gr\u00fcn a=b": "x:y\n"})")).labels.begin()->second, "x:y\n");
}

TEST(ReadJob, RefusesPartsWhoseNamesAreNotUtf8)
{
    ReadContext context;
    context.files = {{"caf\xe9.obj", "sha256:" + std::string(64, 'a')}};
    EXPECT_EQ(fault(with(R"("seed": 1)"), context).code, "not_utf8");
}

TEST(ReadJob, KeepsNumbersExactly)
{
    const JobRequest job = accepted(R"({"scene": {"camera": {"position": [0.1, 1e-300, -123456789.123456789]},
        "objects": [{"shape": "box"}], "environment": {"type": "color", "radiance": [0.1, 1e-40, 1e30]}}})");
    EXPECT_EQ(job.scene.camera->position, (renderer::Vec3d{0.1, 1e-300, -123456789.123456789}));
    EXPECT_EQ(std::get<renderer::ColorEnvironment>(*job.scene.environment).radiance,
              (renderer::Rgb{0.1f, 1e-40f, 1e30f}));
}

TEST(ReadJob, SurvivesEveryMemberOfEveryType)
{
    const std::string whole =
        R"({"scene": {"camera": {"position": [1, 2, 3], "look_at": [0, 0, 0], "up": [0, 1, 0],
        "fov_deg": 40, "type": "perspective"}, "environment": {"type": "color", "radiance": [1, 1, 1]}, "materials": {"m":
        {"type": "phong", "diffuse": [0, 0, 0], "form": "classic"}}, "objects": [{"shape": "box", "size": [1, 1, 1],
        "material": "m", "transform": [{"scale": 1}, {"rotate_deg": 4, "axis": [0, 1, 0]}]}], "lights": [{"type": "spot",
        "inner_deg": 3}], "transport": {"type": "auto"}}, "image": {"region": {"x": 0, "width": 2, "height": 2}}, "quality":
        {"time_s": 3}, "limits": {"time_s": 4}, "files": {"a": "sha256:x"}, "seed": 3, "labels": {"a": "b"}, "fail_on":
        ["non_finite"], "acceleration": {"bvh": {"split": "sah"}, "tile": 4}})";
    // Every value from each '{', '[', '"' or digit on is replaced by something else.
    for (std::size_t at = 1; at < whole.size(); ++at) {
        if (std::string("{[\"0123456789").find(whole[at]) == std::string::npos) continue;
        for (const char* other :
             {"null", "true", "-1", "1e308", "\"x\"", "[]", "{}", "[[[]]]", "{\"image\": 0}"}) {
            const std::string text = whole.substr(0, at) + other + whole.substr(at + 1);
            const auto read = api::read_job(text, {});
            if (const auto* problem = std::get_if<ProblemDetails>(&read)) {
                EXPECT_FALSE(problem->errors.empty());
            }
        }
    }
}

} // namespace
