#include "renderer/accel/ray_run.h"

namespace renderer {

float kernel_scale(const Bounds3f& box)
{
    const float size = std::max(max_abs(box.lower), max_abs(box.upper));
    if (!(size > 0) || (size > 0x1p-40f && size < 0x1p40f)) return 1;
    int exponent = 0;
    std::frexp(size, &exponent);
    return std::ldexp(1.0f, std::clamp(-exponent, -126, 126));
}

} // namespace renderer
