// Instances of one mesh in the cells of a cube, and what rays among them cost: for measuring the upper level.
#pragma once

#include "renderer/accel/instance_tree.h"
#include "renderer/accel/prepared_mesh.h"

#include <cstdint>
#include <vector>

namespace bench {

inline constexpr double kCellSize = 3;

// One in a cell, each turned its own way.
std::vector<renderer::Instance> instances_of(const renderer::PreparedMesh& mesh, std::uint32_t count);

// Processor time of rays from within the bounds in all directions, the same ones at every call.
double million_rays_a_second(const renderer::InstanceTree& tree);

} // namespace bench
