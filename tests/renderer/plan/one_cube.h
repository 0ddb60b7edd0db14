// A scene of one mesh, and what a plan says of it, for the tests of plans.
#pragma once

#include "renderer/plan/plan.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace tests {

inline renderer::MeshFacts cube_facts()
{
    renderer::MeshFacts facts;
    facts.bounds = {{-1, -2, -3}, {1, 2, 3}};
    facts.triangles = 12;
    facts.vertices = 24;
    return facts;
}

inline renderer::SceneDescription one_mesh()
{
    renderer::SceneDescription scene;
    scene.meshes.push_back({"cube.obj", ""});
    scene.objects.emplace_back().shape = renderer::MeshShape{};
    return scene;
}

// Of choices, each of which says why.
inline std::vector<std::string> names(const std::vector<renderer::ModelChoice>& choices)
{
    std::vector<std::string> out;
    for (const renderer::ModelChoice& choice : choices) {
        EXPECT_FALSE(choice.why.empty()) << choice.name;
        out.push_back(choice.name);
    }
    return out;
}

} // namespace tests
