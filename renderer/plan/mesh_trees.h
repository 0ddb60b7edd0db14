// mesh_trees: which tree each mesh of a scene gets.
//
// Spatial splits (accel/spatial_bvh.h) make a tree dearer to build, by up to 1.2 us a triangle, and rays that have
// nothing in common with their neighbours cheaper, by nothing to 15 ns, as the mesh is (accel/README.md): they pay where a
// triangle can expect many of those. From the scene's own words and the number of triangles alone, so that whoever gets meshes one by one
// can ask for each.
#pragma once

#include "renderer/description/scene_description.h"
#include "renderer/description/settings.h"
#include "renderer/plan/plan.h"

#include <cstdint>
#include <span>

namespace renderer {

class MeshTrees {
public:
    // As given, or as assume_defaults() has filled it in: the answers are the same.
    MeshTrees(const SceneDescription& scene, const RenderSettings& settings);

    // As `acceleration` asks; where it does not, what pays.
    MeshTree of(std::uint64_t triangles) const;
    // Why, for these meshes.
    void explain(std::span<const MeshFacts> meshes, ModelReport& report) const;

    static constexpr double kRaysATriangle = 128;

private:
    AccelerationSettings asked_;
    double scattered_rays_; // in the whole render, about
};

} // namespace renderer
