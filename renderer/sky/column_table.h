// ColumnTable: the columns of air from any point to the top, by look-up.
//
// Rows are altitudes, dense near the ground; along a row the distance to the top, as a share between that of the
// vertical and that of the horizon, stretched towards the horizon. Between entries it is a cubic. The ozone's, which has
// kinks, is in closed form (tent_column.h).
// Source  the mapping of Bruneton, Neyret 2008, section 4, on columns instead of transmittances: those are smooth.
// Errors  transmittance within 1e-3 relative at earth's coefficients.
// Threads const: any number at once.
#pragma once

#include "renderer/parallel/thread_pool.h"
#include "renderer/sky/air.h"

#include <cstddef>
#include <vector>

namespace renderer {

class ColumnTable {
public:
    ColumnTable(const Air& air, ThreadPool& pool);

    // Of a point that sees the sky at that angle: mu is cut to the horizon.
    [[nodiscard]] Columns at(double altitude, double mu) const;
    [[nodiscard]] std::size_t size_bytes() const { return columns_.capacity() * sizeof(Entry); }

private:
    struct Entry {
        double rayleigh = 0, mie = 0;
    };
    [[nodiscard]] double ozone_at(double altitude, double mu) const;

    static constexpr std::size_t kRows = 64, kPlaces = 128;

    double radius_, height_;
    double ozone_center_, ozone_half_width_;
    bool has_ozone_;
    std::vector<Entry> columns_; // [row][place]
};

} // namespace renderer
