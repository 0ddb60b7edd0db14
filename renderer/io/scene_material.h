// read_scene_material: a material of assimp's scene as a MeshMaterial, with its pictures.
#pragma once

#include "renderer/geometry/mesh.h"
#include "renderer/io/mesh_images.h"

struct aiMaterial;
struct aiScene;

namespace renderer {

// `is_assimps_own`: made up by assimp, so that only its colour counts. The name is left to the caller.
void read_scene_material(
    const aiMaterial& from, const aiScene& scene, bool is_assimps_own, MeshImages& images, MeshMaterial& to);

} // namespace renderer
