#include "renderer/plan/material_choices.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

using renderer::CookTorranceMaterial;
using renderer::MaterialCensus;
using renderer::ModelReport;
using renderer::Multiscatter;

namespace {

CookTorranceMaterial varnish(double roughness, Multiscatter multiscatter)
{
    CookTorranceMaterial m;
    m.roughness.value = roughness;
    m.multiscatter = multiscatter;
    return m;
}

bool names(const std::vector<renderer::ModelChoice>& choices, const char* name)
{
    return std::any_of(
        choices.begin(), choices.end(), [&](const auto& choice) { return choice.name == name; });
}

ModelReport explained(const renderer::Material& material)
{
    MaterialCensus census;
    count_material(census, material);
    ModelReport models;
    explain_materials(census, models);
    return models;
}

} // namespace

TEST(MaterialChoices, GiveBackLightOfSeveralFacetsWhereItMatters)
{
    EXPECT_TRUE(names(explained(varnish(0.5, Multiscatter::automatic)).used, "multiscatter"));
    EXPECT_TRUE(names(explained(varnish(0.1, Multiscatter::on)).used, "multiscatter"));
    const ModelReport fine = explained(varnish(0.2, Multiscatter::automatic));
    EXPECT_FALSE(names(fine.used, "multiscatter"));
    ASSERT_TRUE(names(fine.skipped, "multiscatter"));
    EXPECT_NE(fine.skipped[0].why.find("at most 0.8 %"), std::string::npos) << fine.skipped[0].why;
    const ModelReport asked = explained(varnish(1, Multiscatter::off));
    EXPECT_NE(asked.skipped.at(0).why.find("at most 63.0 %"), std::string::npos) << asked.skipped[0].why;
    // A mirror has no facets that could send light to one another.
    EXPECT_TRUE(explained(varnish(0, Multiscatter::automatic)).skipped.empty());
}

TEST(MaterialChoices, NameEveryKindThatIsUsed)
{
    EXPECT_TRUE(names(explained(renderer::MirrorMaterial{}).used, "mirror"));
    EXPECT_TRUE(names(explained(renderer::GlassMaterial{}).used, "dielectric_fresnel"));
    EXPECT_TRUE(names(explained(renderer::GlassMaterial{.roughness = {0.3}}).used, "rough_glass"));
    EXPECT_TRUE(names(explained(renderer::ConductorMaterial{}).used, "conductor_fresnel"));
    EXPECT_TRUE(names(explained(renderer::EmitterMaterial{}).used, "emitter"));
    EXPECT_TRUE(names(explained(renderer::DiffuseMaterial{}).used, "diffuse"));
}
