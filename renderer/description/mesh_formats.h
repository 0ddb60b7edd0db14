// The mesh formats that are read: the one table that the importer, the service's words, the CLI and the
// documents take them from. How units and axes of each become metres with y up stands beside it.
#pragma once

#include <array>
#include <string>
#include <string_view>

namespace renderer {

struct MeshFormat {
    std::string_view name;  // as in answers; the extension is "." and this
    std::string_view title; // for sentences
    std::string_view frame; // what becomes of its units and axes
};

inline constexpr std::array kMeshFormats{
    MeshFormat{"obj", "OBJ", "as written"},
    MeshFormat{"ply", "PLY", "as written"},
    MeshFormat{"stl", "STL", "as written"},
    MeshFormat{"gltf", "glTF 2.0", "metres, y up"},
    MeshFormat{"glb", "GLB", "metres, y up"},
    MeshFormat{"fbx", "FBX", "UnitScaleFactor (centimetres) to metres, UpAxis to y"},
    MeshFormat{"dae", "COLLADA", "unit to metres, up_axis to y"},
    MeshFormat{"3ds", "3DS", "as written, z up to y"},
    MeshFormat{"off", "OFF", "as written"},
};

// "OBJ, PLY, ..."
inline std::string mesh_format_titles()
{
    std::string titles;
    for (const MeshFormat& format : kMeshFormats)
        (titles += titles.empty() ? "" : ", ") += format.title;
    return titles;
}

// ".obj .ply ..."
inline std::string mesh_extensions()
{
    std::string extensions;
    for (const MeshFormat& format : kMeshFormats)
        (extensions += extensions.empty() ? "." : " .") += format.name;
    return extensions;
}

// Whether ".obj", say, in small letters.
constexpr bool is_mesh_extension(std::string_view extension)
{
    if (!extension.starts_with('.')) return false;
    for (const MeshFormat& format : kMeshFormats)
        if (extension.substr(1) == format.name) return true;
    return false;
}

} // namespace renderer
