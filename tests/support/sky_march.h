// March: single scattering by a plain walk in equal steps, as many programs do it: what the sky is measured against.
//
// Source  Nishita et al. 1993 as commonly programmed; steps along the view, and from each of them to the sun.
#pragma once

#include "renderer/sky/single_scattering.h"

namespace tests {

// whole: the optical depth at a step holds all of that step, which errs by the first order of its length; half: half of
// it, as the midpoint rule asks.
enum class MarchSteps { whole, half };

// L / E0, without the ground. The eye lies within the air.
renderer::Spectrum march(const renderer::Air& air,
                         const renderer::SkyGeometry& geometry,
                         MarchSteps kind,
                         int view_steps,
                         int sun_steps);

} // namespace tests
