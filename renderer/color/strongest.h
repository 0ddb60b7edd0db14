// strongest: the largest channel of a colour: by what light, a path or a lobe is weighed.
#pragma once

#include "renderer/color/rgb.h"

#include <algorithm>

namespace renderer {

constexpr float strongest(Rgb c)
{
    return std::max({c.r, c.g, c.b});
}

} // namespace renderer
