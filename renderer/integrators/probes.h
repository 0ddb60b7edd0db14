// Pictures that show a scene rather than its light: how open surfaces are, and which way they face.
#pragma once

#include "renderer/integrators/first_hits.h"

#include <span>
#include <stop_token>

namespace renderer {

// Ambient occlusion: the share of the sky, weighted by the cosine, that a surface sees; 1 where nothing was hit. One ray
// a sample.
void occlusion_radiance(const Scene& scene,
                        std::span<const CameraSample> samples,
                        std::span<Rgb> radiance,
                        RayTally& tally,
                        const std::stop_token& stop,
                        FirstHits first = {});

// (n + 1) / 2 of the shading normal in the world, on the viewer's side; black where nothing was hit.
void normals_radiance(const Scene& scene,
                      std::span<const CameraSample> samples,
                      std::span<Rgb> radiance,
                      RayTally& tally,
                      const std::stop_token& stop,
                      FirstHits first = {});

} // namespace renderer
