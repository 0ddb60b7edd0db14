// Terrain: hills over a square as a mesh or a mesh file of exactly as many triangles as asked for, to measure
// what large meshes cost.
//
// Frame    x and z in [-1, 1], y up, heights within about 0.3 of 0; counter-clockwise seen from above.
// Promise  the same bits on every machine. Positions and triangles only, nothing twice: a vertex is shared by
//          the six triangles around it.
// Cost     files are written a row at a time: memory does not grow with the triangles.
// Errors   std::runtime_error where a file cannot be written, std::invalid_argument for a size or a name that
//          cannot be had.
#pragma once

#include "renderer/geometry/mesh.h"

#include <cstdint>
#include <filesystem>

namespace bench {

// The grid that holds so many triangles; the last row may be cut short.
class Terrain {
public:
    explicit Terrain(std::uint64_t triangles);

    std::uint64_t triangles() const { return triangles_; }
    std::uint32_t vertices() const { return (columns_ + 1) * (rows_ + 1); }
    std::uint32_t columns() const { return columns_; } // of cells, two triangles each
    std::uint32_t rows() const { return rows_; }
    renderer::Vec3f vertex(std::uint32_t number) const;
    renderer::Triangle triangle(std::uint64_t number) const;

private:
    std::uint64_t triangles_;
    std::uint32_t columns_, rows_;
};

renderer::Mesh terrain_mesh(std::uint64_t triangles);

// As the extension says: .ply (binary), .obj, .glb or .stl (binary). Returns its bytes.
std::uint64_t write_terrain(const std::filesystem::path& path, std::uint64_t triangles);

} // namespace bench
