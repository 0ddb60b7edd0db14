// read_mtl: the materials of a Wavefront MTL file, as far as they are modelled (Kd, Ks, Ns, Ke, illum and Ni of glass,
// map_Kd, map_Ks, map_d, norm), and whether they have what is not (other textures, d, Tr, Pm, Pr).
//
// Errors  none but too many materials: a line that cannot be read is told in `notes`, of which there are
//         kMostNotes at most, and leaves the default. A material without a readable Kd is grey, with a note,
//         and white behind a picture; bump maps are left out, with one. Colours are brought into [0, 1]. Where map_d
//         is below 1/2 there is a hole.
#pragma once

#include "renderer/geometry/mesh.h"
#include "renderer/io/mesh_images.h"

#include <string>
#include <string_view>
#include <vector>

namespace renderer {

// Appends to `materials`; false at the one that is over kMostMaterials. `file` is for the notes.
bool read_mtl(std::string_view text,
              std::string_view file,
              MeshImages& images,
              std::vector<MeshMaterial>& materials,
              std::vector<std::string>& notes);

} // namespace renderer
