// Where a line of sight enters and leaves the planet's shadow.
#pragma once

#include "renderer/sky/single_scattering.h"

#include <vector>

namespace renderer {

// Distances from the eye, ahead of it, none or two at most; the shadow is a cylinder behind the planet.
std::vector<double> shadow_edges(double planet_radius, const SkyGeometry& geometry);

} // namespace renderer
