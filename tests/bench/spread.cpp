#include "tests/bench/spread.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace bench {

Spread spread_of(std::vector<double> values)
{
    if (values.empty()) throw std::invalid_argument("the spread of nothing");
    std::sort(values.begin(), values.end());
    const auto at = [&](double share) {
        const double rank = share * static_cast<double>(values.size() - 1);
        const auto below = static_cast<std::size_t>(rank);
        const std::size_t above = std::min(below + 1, values.size() - 1);
        return std::lerp(values[below], values[above], rank - std::floor(rank));
    };
    return {at(0.5), values.front(), values.back(), at(0.25), at(0.75)};
}

} // namespace bench
