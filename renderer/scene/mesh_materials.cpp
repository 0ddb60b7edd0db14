#include "renderer/scene/mesh_materials.h"

#include <algorithm>

namespace renderer {

namespace {

Material plain(const MeshMaterial& m)
{
    if (is_black(m.specular) || !(m.shininess > 0)) {
        DiffuseMaterial diffuse;
        diffuse.color = {m.diffuse, m.color_map};
        return diffuse;
    }
    const Rgb sum = m.diffuse + m.specular;
    const float scale = 1 / std::max({1.0f, sum.r, sum.g, sum.b});
    PhongMaterial phong;
    phong.diffuse = {m.diffuse * scale, m.color_map};
    phong.specular = {m.specular * scale, m.specular_map};
    phong.shininess = static_cast<double>(m.shininess);
    return phong;
}

} // namespace

TexturedMaterial from_mesh(const MeshMaterial& m)
{
    return {.material = plain(m),
            .values_are_factors = true,
            .normal_map = m.normal_map,
            .alpha_map = m.alpha_map,
            .opacity = m.opacity,
            .cutoff = m.cutoff};
}

} // namespace renderer
