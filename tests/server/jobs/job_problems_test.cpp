#include "server/jobs/job_problems.h"

#include <gtest/gtest.h>

namespace {

using renderer::Fault;

renderer::SceneDescription scene_of(const std::vector<std::uint32_t>& meshes)
{
    renderer::SceneDescription scene;
    for (const std::uint32_t mesh : meshes) {
        renderer::MeshShape shape;
        shape.mesh = mesh;
        scene.objects.emplace_back().shape = shape;
    }
    return scene;
}

std::vector<Fault> faults_of(const server::FailedMeshes& failed, const std::vector<std::uint32_t>& meshes)
{
    renderer::FaultList faults;
    server::add_faults(failed, scene_of(meshes), faults);
    return faults.take();
}

TEST(Faults, AreToldAtEveryObjectThatUsesTheMesh)
{
    const server::FailedMeshes first{{0, {.code = "truncated", .detail = "the data ends"}}};
    const std::vector<Fault> faults = faults_of(first, {0, 1, 0});
    ASSERT_EQ(faults.size(), 2U);
    EXPECT_EQ(faults[0].pointer, "/scene/objects/0/mesh");
    EXPECT_EQ(faults[1].pointer, "/scene/objects/2/mesh");
    EXPECT_EQ(faults[1].code, "truncated");
    EXPECT_EQ(faults[1].detail, "the data ends");
    ASSERT_EQ(faults_of(first, {1}).size(), 1U) << "none uses it";
    EXPECT_EQ(faults_of(first, {1}).front().pointer, "/files");
    EXPECT_TRUE(faults_of({}, {0, 1}).empty());
}

TEST(Faults, OfSeveralMeshesComeInTheOrderOfTheObjects)
{
    const std::vector<Fault> faults =
        faults_of({{0, {"a", ""}}, {1, {"b", ""}}, {2, {"c", ""}}}, {1, 3, 0, 1});
    ASSERT_EQ(faults.size(), 4U);
    EXPECT_EQ(faults[0], (Fault{"/scene/objects/0/mesh", "b", ""}));
    EXPECT_EQ(faults[1], (Fault{"/scene/objects/2/mesh", "a", ""}));
    EXPECT_EQ(faults[2], (Fault{"/scene/objects/3/mesh", "b", ""}));
    EXPECT_EQ(faults[3], (Fault{"/files", "c", ""}));
}

TEST(Faults, AreOverALimitOnlyWhereAllAre)
{
    const Fault limit{"/image", "over_limit", "too wide"}, other{"/scene", "out_of_range", "no"};
    EXPECT_EQ(server::faults_problem({limit, limit}).code, "over_limit");
    const api::ProblemDetails mixed = server::faults_problem({limit, other});
    EXPECT_EQ(mixed.code, "invalid_scene");
    EXPECT_EQ(mixed.status, 422);
    ASSERT_EQ(mixed.errors.size(), 2U);
    EXPECT_EQ(mixed.errors[0].pointer, "/image");
}

TEST(JobProblems, SayWhyAPictureIsNotThere)
{
    EXPECT_NE(server::render_failed_problem("42", nullptr).detail.find("canceled"), std::string::npos);
    const api::ProblemDetails why = server::time_limit_problem(0.5);
    EXPECT_NE(server::render_failed_problem("42", &why).detail.find(why.detail), std::string::npos);
    EXPECT_EQ(server::render_failed_problem("42", &why).status, 409);
    EXPECT_FALSE(server::render_failed_problem("42", &why).retryable);
}

TEST(JobProblems, AreRetryableExactlyWhereTryingAgainMayHelp)
{
    for (const auto& problem : {server::draining_problem(),
                                server::storage_full_problem(),
                                server::queue_full_problem(2),
                                server::still_running_problem("42"),
                                server::renders_again_problem("42"),
                                server::still_ending_problem("42"),
                                server::out_of_memory_problem("42"),
                                server::internal_problem("42")})
        EXPECT_TRUE(problem.retryable) << problem.code;
    for (const auto& problem : {server::key_reused_problem(),
                                server::not_found_problem("42"),
                                server::expired_problem("42"),
                                server::time_limit_problem(1),
                                server::non_finite_problem(3),
                                server::too_many_attempts_problem("42", 6)})
        EXPECT_FALSE(problem.retryable) << problem.code;
    EXPECT_NE(server::queue_full_problem(2).detail.find("queue_jobs"), std::string::npos);
    EXPECT_NE(server::time_limit_problem(0.5).detail.find("0.5 s"), std::string::npos);
    EXPECT_NE(server::too_many_attempts_problem("42", 6).detail.find("5 times"), std::string::npos);
}

} // namespace
