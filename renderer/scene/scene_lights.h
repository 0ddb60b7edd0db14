// SceneLights: everything that shines in a scene, sorted by how it is found: asked each, or picked by a tree.
#pragma once

#include "renderer/accel/instance.h"
#include "renderer/lights/emitter.h"
#include "renderer/lights/light_sample.h"
#include "renderer/lights/light_tree.h"
#include "renderer/lights/sun.h"

#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

namespace renderer {

struct SceneLights {
    std::vector<PreparedLight> listed; // without extent, to be asked each
    std::vector<Sun> suns;             // likewise
    bool first_sun_is_of_sky = false;  // of suns: a camera sees it through the air
    std::vector<Emitter> emitters;     // surfaces that shine: asked each, or picked from by the tree
    std::vector<PreparedLight> picked; // without extent, numbered in the tree after the emitters
    LightTree tree;                    // empty: nothing is picked
    std::unordered_map<std::uint64_t, std::uint32_t> emitter_of; // instance << 32 | primitive -> emitter

    // Moves what has a place under one tree; suns and directional lights stay listed.
    void pick_by_tree();
};

// The triangles first, first + 1, ... of a mesh, or the sphere or disk, as placed.
void add_emitters(SceneLights& lights,
                  const Instance& instance,
                  std::uint32_t number,
                  std::uint32_t first_triangle,
                  std::uint32_t triangle_count,
                  Rgb radiance,
                  bool two_sided);
// The unit rectangle, whose two triangles are one emitter.
void add_rectangle(
    SceneLights& lights, const Instance& instance, std::uint32_t number, Rgb radiance, bool two_sided);

} // namespace renderer
