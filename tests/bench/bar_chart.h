// BarChart: horizontal bars with their spread, as SVG: one row a bar, in groups, on a linear or logarithmic axis.
#pragma once

#include "tests/bench/spread.h"

#include <string>
#include <vector>

namespace bench {

struct Bar {
    std::string label;
    Spread value;     // > 0 on a logarithmic axis
    std::string note; // written behind the value: "-98.9 %"
};

struct BarGroup {
    std::string name; // none: no heading
    std::vector<Bar> bars;
};

struct BarChart {
    std::string title, subtitle, axis; // axis: what is measured, with its unit
    std::vector<BarGroup> groups;
    bool logarithmic = false;
};

std::string to_svg(const BarChart& chart);

} // namespace bench
