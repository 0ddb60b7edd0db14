#include "renderer/plan/material_choices.h"

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

struct Counter {
    MaterialCensus& census;

    void operator()(const DiffuseMaterial&) const { ++census.diffuse; }
    void operator()(const PhongMaterial& m) const
    {
        ++(m.form == PhongForm::classic ? census.phong_classic : census.phong_normalized);
    }
    void operator()(const MirrorMaterial&) const { ++census.mirrors; }
    void operator()(const GlassMaterial& m) const
    {
        ++(is_rough(m.roughness) ? census.rough_glass : census.glass);
    }
    void operator()(const ConductorMaterial& m) const
    {
        ++(is_rough(m.roughness) ? census.rough_conductors : census.conductors);
    }
    void operator()(const EmitterMaterial&) const { ++census.emitters; }
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
    use_if(census.mirrors, "mirror", "that reflect light in one direction");
    use_if(
        census.glass, "dielectric_fresnel", "of clear glass: exact Fresnel terms, reflection and refraction");
    use_if(census.rough_glass,
           "rough_glass",
           "of rough glass: exact Fresnel terms on GGX facets; light that meets several facets is left out");
    use_if(census.conductors, "conductor_fresnel", "of smooth metal: exact Fresnel terms of eta and k");
    use_if(census.rough_conductors, "rough_conductor", "of rough metal: exact Fresnel terms on GGX facets");
    use_if(census.emitters, "emitter", "that shine and reflect nothing");
}

} // namespace renderer
