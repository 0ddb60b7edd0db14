// What every JSON of heliograph-bench has: the machine, and the spread of a figure.
#pragma once

#include "tests/bench/spread.h"

#include <nlohmann/json_fwd.hpp>

namespace bench {

nlohmann::json machine_json();
nlohmann::json to_json(const Spread& spread);

} // namespace bench
