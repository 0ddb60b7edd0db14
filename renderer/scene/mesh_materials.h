// from_mesh: the material that a mesh's file carries, in the renderer's own terms.
#pragma once

#include "renderer/geometry/mesh.h"
#include "renderer/scene/surface_textures.h"

namespace renderer {

// Phong's where the file speaks of diffuse and specular, which are dimmed alike where they add up to more than 1, so
// that no surface gives more light than it gets. glTF's metallic and rough one as it is modelled.
TexturedMaterial from_mesh(const MeshMaterial& material);

} // namespace renderer
