// check_atmosphere: what is wrong with an atmosphere where members are held against one another.
//
// That each number is in its own range is the reader's to hold (api/fields/atmosphere_fields.h).
#pragma once

#include "renderer/description/atmosphere.h"
#include "renderer/description/fault.h"

#include <string>
#include <vector>

namespace renderer {

// `pointer`: of the atmosphere itself, "" or "/scene/environment".
std::vector<Fault> check_atmosphere(const AtmosphereDescription& atmosphere, const std::string& pointer);

} // namespace renderer
