// material_choices: what the materials of a scene's objects are, counted, and how they are modelled.
#pragma once

#include "renderer/description/material.h"
#include "renderer/description/report.h"

#include <cstddef>

namespace renderer {

// Objects by what they are made of.
struct MaterialCensus {
    std::size_t diffuse = 0, default_diffuse = 0, phong_classic = 0, phong_normalized = 0;
    std::size_t cook_torrance = 0;
    std::size_t several_facets = 0; // of these and rough conductors: with light that meets several facets
    std::size_t one_facet = 0;      // without
    double roughest_of_one = 0;     // roughness
    std::size_t mirrors = 0, glass = 0, rough_glass = 0, conductors = 0, rough_conductors = 0;
    std::size_t emitters = 0;
};

void count_material(MaterialCensus& census, const Material& material);

// Adds a line for each kind that is used.
void explain_materials(const MaterialCensus& census, ModelReport& models);

} // namespace renderer
