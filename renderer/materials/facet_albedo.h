// FacetAlbedo: the share of light from everywhere that facets send to one direction with one reflection
// each.
//
// What is missing to 1 has met further facets (E. Heitz, JCGT 3(2), 2014). Read from a table of upper
// bounds, too high by at most 0.013, so that what is built on it (layers.h) never adds up to more than the
// light there is.
//
// Units   roughness in [0, 1], its square is the facets' alpha; below kSmoothBelow one smooth mirror.
// Cost    some 40 operations, two square roots.
// Source  the table is computed by tests/renderer/materials/facet_albedo_test.cpp, which also holds it.
#pragma once

#include <array>
#include <cstddef>

namespace renderer {

struct FacetAlbedo {
    double white = 1;   // where each facet reflects all
    double slanted = 0; // where each facet reflects (1 - cos)^5: Schlick's F is f0 + (1 - f0) of it
};
FacetAlbedo facet_albedo(double cosine, double roughness);
// 2 * integral of the above times cos: over all directions; a lower bound.
FacetAlbedo average_facet_albedo(double roughness);

// Rows by roughness, from kSmoothBelow to 1 in even steps; columns by sqrt(cos / sqrt(alpha^2 + (1 -
// alpha^2) cos^2)), in which even a smooth surface's narrow rise at grazing angles is wide. `slanted` is
// stored less white (1 - cos)^5.
struct FacetAlbedoTable {
    static constexpr std::size_t kRows = 32, kColumns = 48;
    std::array<std::array<float, kColumns>, kRows> white, slanted;
    std::array<float, kRows> white_missing, slanted_average; // the former: (1 - average) / alpha
};
extern const FacetAlbedoTable kFacetAlbedo;
// By another table than kFacetAlbedo; roughness at least kSmoothBelow.
FacetAlbedo facet_albedo(const FacetAlbedoTable& table, double cosine, double roughness);

} // namespace renderer
