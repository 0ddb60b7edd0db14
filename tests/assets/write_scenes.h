// Writers of formats with a scene in them (COLLADA, binary and text FBX, 3DS) and of OFF: an AssetMesh each, as
// the bytes of a file; and the same with whatever a test wants broken in it.
#pragma once

#include "tests/assets/shapes.h"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace tests {

std::string off_text(const AssetMesh& mesh);

struct ColladaWords {
    std::string asset = "<unit name=\"meter\" meter=\"1\"/><up_axis>Y_UP</up_axis>";
    std::string nodes =
        "<node id=\"ball\" name=\"ball\"><instance_geometry url=\"#mesh\"><bind_material><technique_common>"
        "<instance_material symbol=\"m\" target=\"#red\"/></technique_common></bind_material>"
        "</instance_geometry></node>";
    std::string libraries{}; // further ones
    std::string prolog{};    // before the root element
};
std::string collada_text(const AssetMesh& mesh, const ColladaWords& words = {});

struct FbxWords {
    std::int32_t up_axis = 1;
    double unit_cm = 100;
    // Child and parent of further connections; model 2 is the mesh's, 3 and 4 hold nothing, 0 is the root.
    std::vector<std::array<std::int64_t, 2>> connections{};
};
std::string fbx_bytes(const AssetMesh& mesh, const FbxWords& words = {});
std::string fbx_text(const AssetMesh& mesh, const FbxWords& words = {});

struct ThreeDsWords {
    // Number and parent's number of key-frame nodes, all of the one mesh; 0xffff: none.
    std::vector<std::array<std::uint16_t, 2>> nodes{};
};
std::string three_ds_bytes(const AssetMesh& mesh, const ThreeDsWords& words = {});

} // namespace tests
