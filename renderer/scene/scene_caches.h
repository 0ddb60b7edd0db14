// SceneCaches: what one scene leaves behind for the next that resembles it, as the frames of an animation do.
//
// Threads  any number at once.
// Memory   what each of them is made for: 80 MiB together.
#pragma once

#include "renderer/accel/bvh_topology_cache.h"
#include "renderer/sky/sky_cache.h"

namespace renderer {

struct SceneCaches {
    SkyCache skies;
    BvhTopologyCache upper_levels;
};

} // namespace renderer
