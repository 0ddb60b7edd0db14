// Meshes that are measured: from a file, at any size.
#pragma once

#include "renderer/geometry/mesh.h"

#include <string>

namespace bench {

// Errors  std::runtime_error, with the file's name.
renderer::Mesh read_mesh(const std::string& path);

// Length of the diagonal of the vertices' bounds.
double diagonal_of(const renderer::Mesh& mesh);

void scale_mesh(renderer::Mesh& mesh, double factor);

} // namespace bench
