// flatten_scene: assimp's scene graph as one Mesh.
//
// Cost    bounded before anything is placed: triangles are counted node by node against the limit first.
#pragma once

#include "renderer/io/companion_files.h"
#include "renderer/io/import_mesh.h"

struct aiScene;

namespace renderer {

// `result.mesh` and notes are filled, by result.format; nodes must form a tree.
std::optional<ImportFault>
flatten_scene(const aiScene& scene, CompanionFiles& files, const Limits& limits, ImportedMesh& result);

} // namespace renderer
