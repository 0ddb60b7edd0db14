#include "renderer/plan/material_choices.h"

#include <algorithm>
#include <cstdio>
#include <string>
#include <utility>
#include <variant>

namespace renderer {

namespace {

// Whether facets scatter somewhere on it; a texture may say so anywhere.
bool is_rough(const TexturedNumber& roughness)
{
    return roughness.texture || roughness.value >= kSmoothBelow;
}

// Share of light from everywhere that facets send to one another: a bound on the averages of GGX, 0.6 % at
// roughness 0.2, 12 % at 0.5, 59 % at 1.
double most_that_meets_several(double roughness)
{
    return roughness * roughness * std::min(0.63, 0.96 * roughness);
}

class Counter {
public:
    explicit Counter(MaterialCensus& counts) : census_(counts) {}

    void operator()(const DiffuseMaterial&) const { ++census_.diffuse; }
    void operator()(const PhongMaterial& m) const
    {
        ++(m.form == PhongForm::classic ? census_.phong_classic : census_.phong_normalized);
    }
    void operator()(const CookTorranceMaterial& m) const
    {
        ++census_.cook_torrance;
        facets(m.multiscatter, m.roughness);
    }
    void operator()(const MirrorMaterial&) const { ++census_.mirrors; }
    void operator()(const GlassMaterial& m) const
    {
        ++(is_rough(m.roughness) ? census_.rough_glass : census_.glass);
    }
    void operator()(const ConductorMaterial& m) const
    {
        ++(is_rough(m.roughness) ? census_.rough_conductors : census_.conductors);
        facets(m.multiscatter, m.roughness);
    }
    void operator()(const EmitterMaterial&) const { ++census_.emitters; }

private:
    void facets(Multiscatter multiscatter, const TexturedNumber& roughness) const
    {
        if (!is_rough(roughness)) return;
        if (compensates(multiscatter, roughness)) {
            ++census_.several_facets;
            return;
        }
        ++census_.one_facet;
        census_.roughest_of_one = std::max(census_.roughest_of_one, roughness.texture ? 1 : roughness.value);
    }

    MaterialCensus& census_;
};

} // namespace

void count_material(MaterialCensus& census, const Material& material)
{
    std::visit(Counter{census}, material);
}

void explain_materials(const MaterialCensus& census, ModelReport& models)
{
    const auto use_if = [&](std::size_t count, const char* name, const char* what) {
        if (count != 0)
            models.used.push_back(
                {name, std::to_string(count) + (count == 1 ? " object " : " objects ") + what});
    };
    use_if(census.diffuse, "diffuse", "of diffuse materials");
    use_if(census.default_diffuse, "default_diffuse", "without a material: diffuse 0.5");
    use_if(census.phong_normalized, "phong_normalized", "of energy-conserving Phong");
    use_if(
        census.phong_classic, "phong_classic", "of classic Phong, which may reflect more light than it gets");
    use_if(census.cook_torrance,
           "cook_torrance",
           "of varnish or metal: GGX facets with Schlick's Fresnel term over a diffuse base");
    use_if(census.mirrors, "mirror", "that reflect light in one direction");
    use_if(
        census.glass, "dielectric_fresnel", "of clear glass: exact Fresnel terms, reflection and refraction");
    use_if(census.rough_glass,
           "rough_glass",
           "of rough glass: exact Fresnel terms on GGX facets; light that meets several facets is left out");
    use_if(census.conductors, "conductor_fresnel", "of smooth metal: exact Fresnel terms of eta and k");
    use_if(census.rough_conductors, "rough_conductor", "of rough metal: exact Fresnel terms on GGX facets");
    use_if(census.emitters, "emitter", "that shine and reflect nothing");
    use_if(census.several_facets,
           "multiscatter",
           "rough enough that light which meets several facets matters: it is given back");
    if (census.one_facet != 0) {
        char bound[120];
        std::snprintf(bound,
                      sizeof bound,
                      "light that meets several facets of %zu object%s is left out: at most %.1f %% of what "
                      "is reflected",
                      census.one_facet,
                      census.one_facet == 1 ? "" : "s",
                      100 * most_that_meets_several(census.roughest_of_one));
        models.skipped.push_back({"multiscatter", bound});
    }
}

} // namespace renderer
