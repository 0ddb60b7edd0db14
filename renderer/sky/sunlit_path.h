// sunlit_path: what a line of sight gathers of light that is scattered once, constituent by constituent.
#pragma once

#include "renderer/sky/column_table.h"
#include "renderer/sky/lanes.h"
#include "renderer/sky/light_path.h"

#include <cstddef>

namespace renderer {

// parts[group * stride] gets Rayleigh's, parts[group * stride + 1] Mie's, added to what is there; without their phase
// functions. mu_sun, nu at the path's start.
void add_sunlight(const Air& air,
                  const ColumnTable& columns,
                  const LightPath& path,
                  double mu_sun,
                  double nu,
                  Lanes* parts,
                  std::size_t stride);

} // namespace renderer
