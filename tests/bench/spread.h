// Spread: what several measurements of one thing say together.
#pragma once

#include <vector>

namespace bench {

struct Spread {
    double median = 0, least = 0, greatest = 0;
    double lower_quartile = 0, upper_quartile = 0; // half of the values lie between them
};

// At least one value. Quartiles interpolate between neighbours in rank (R's type 7).
Spread spread_of(std::vector<double> values);

} // namespace bench
