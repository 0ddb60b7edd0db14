// GaussLegendre: points and weights of n-point quadrature on [0, 1], exact for polynomials of degree 2n - 1.
//
// Errors  within a few ulp; the points ascend, the weights sum to 1.
#pragma once

#include <cstddef>
#include <vector>

namespace renderer {

struct GaussLegendre {
    explicit GaussLegendre(std::size_t n);
    std::vector<double> x, weight;
};

} // namespace renderer
