// First hits: what camera rays meet first, for the layers beside a picture (description/layers.h).
//
// An integrator that is given room for them notes them of the hits it has found anyway: no ray is traced for them, and
// without room nothing is done.
#pragma once

#include "renderer/integrators/radiance.h"

#include <cstdint>
#include <span>

namespace renderer {

struct FirstHit {
    bool is_there = false; // else the ray met nothing
    double distance_m = 0; // along the ray
    Vec3f normal{};        // the shading one, in the world, on the viewer's side
    Rgb albedo{};          // as albedo() of materials/bsdf.h says
};

// Where each integrator notes them: one a sample, or empty.
using FirstHits = std::span<FirstHit>;

// `met` and `hits` as closest_hits gave them of the samples' own rays. Nothing if `first` is empty.
void note_first_hits(const Scene& scene,
                     std::span<const CameraSample> samples,
                     std::span<const SceneHit> hits,
                     std::uint64_t met,
                     FirstHits first);

} // namespace renderer
