#include "renderer/materials/facet_albedo.h"

#include "renderer/description/material.h"
#include "renderer/materials/fresnel.h"

#include <algorithm>
#include <cmath>

namespace renderer {

namespace {

// A place between two neighbours of a table.
struct Place {
    std::size_t first;
    double second_share;
};

Place place(double x, std::size_t count) // x from 0 to 1
{
    const double at = std::clamp(x, 0.0, 1.0) * static_cast<double>(count - 1);
    const std::size_t first = std::min(static_cast<std::size_t>(at), count - 2);
    return {first, at - static_cast<double>(first)};
}

Place row_of(double roughness)
{
    return place((roughness - kSmoothBelow) / (1 - kSmoothBelow), FacetAlbedoTable::kRows);
}

template <typename Row>
double between(const Row& row, Place at)
{
    const auto a = static_cast<double>(row[at.first]), b = static_cast<double>(row[at.first + 1]);
    return a + at.second_share * (b - a);
}

} // namespace

FacetAlbedo facet_albedo(double cosine, double roughness)
{
    if (roughness < kSmoothBelow) return {1, schlick_weight(cosine)};
    return facet_albedo(kFacetAlbedo, cosine, roughness);
}

FacetAlbedo facet_albedo(const FacetAlbedoTable& table, double cosine, double roughness)
{
    const double c = std::clamp(cosine, 0.0, 1.0);
    const double alpha = roughness * roughness, alpha2 = alpha * alpha;
    const double across = c / std::sqrt(alpha2 + (1 - alpha2) * c * c);
    const Place row = row_of(roughness), column = place(std::sqrt(across), FacetAlbedoTable::kColumns);
    const auto look_up = [&](const auto& rows) {
        const double a = between(rows[row.first], column), b = between(rows[row.first + 1], column);
        return a + row.second_share * (b - a);
    };
    const double white = look_up(table.white);
    return {white, std::clamp(look_up(table.slanted) + white * schlick_weight(c), 0.0, white)};
}

FacetAlbedo average_facet_albedo(double roughness)
{
    if (roughness < kSmoothBelow) return {1, 1.0 / 21};
    const Place row = row_of(roughness);
    return {1 - between(kFacetAlbedo.white_missing, row) * roughness * roughness,
            between(kFacetAlbedo.slanted_average, row)};
}

} // namespace renderer
