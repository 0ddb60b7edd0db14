// Chi-square test of directions drawn against the density that claims to describe them.
//
// Source  the protocol of pbrt and Mitsuba: bins of equal angles, neighbours merged until at least 5 are
//         expected, densities integrated over each bin, Sidak's correction for the number of tests.
#pragma once

#include "renderer/math/vec3.h"

#include <cstddef>
#include <functional>
#include <string>

namespace tests {

struct ChiSquareResult {
    double statistic = 0;
    double degrees = 0;
    double p_value = 0;        // how likely a right pair is to look at least this wrong
    double expected_share = 0; // integral of the density
    double drawn_share = 0;    // share of draws that gave a direction
};

// draw(i) gives direction i of n, or a zero vector where there is none; density is per steradian over the
// sphere around +z, which is binned in rings of cos(theta) and sectors of phi.
ChiSquareResult chi_square(std::size_t n,
                           const std::function<renderer::Vec3f(std::size_t)>& draw,
                           const std::function<double(renderer::Vec3f)>& density,
                           std::size_t rings = 20,
                           std::size_t sectors = 24);

// Upper tail of the chi-square distribution.
double chi_square_p_value(double statistic, double degrees);

} // namespace tests
