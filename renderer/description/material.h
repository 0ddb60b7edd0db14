// Material: what a surface is made of, as a user wrote it.
#pragma once

#include "renderer/color/rgb.h"

#include <cstdint>
#include <string>
#include <variant>

namespace renderer {

struct DiffuseMaterial {
    Rgb color{0.5f, 0.5f, 0.5f};
    friend bool operator==(const DiffuseMaterial&, const DiffuseMaterial&) = default;
};

enum class PhongForm : std::uint8_t { classic, normalized };

struct PhongMaterial {
    Rgb diffuse{0.5f, 0.5f, 0.5f};
    Rgb specular{0.2f, 0.2f, 0.2f};
    double shininess = 32;
    Rgb ambient{0, 0, 0}; // radiance added whatever the light: the k_a i_a of the model, already multiplied
    PhongForm form = PhongForm::normalized;
    friend bool operator==(const PhongMaterial&, const PhongMaterial&) = default;
};

using Material = std::variant<DiffuseMaterial, PhongMaterial>;

struct NamedMaterial {
    std::string name;
    Material material;
    friend bool operator==(const NamedMaterial&, const NamedMaterial&) = default;
};

} // namespace renderer
