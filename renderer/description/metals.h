// Metals by name: their complex indices of refraction.
//
// Source  measured n and k, read between the nearest measured wavelengths at those of Rec. 709's primaries:
//         611, 549, 464 nm.
#pragma once

#include "renderer/color/rgb.h"

#include <cstdint>

namespace renderer {

enum class Metal : std::uint8_t {
    aluminium,
    chromium,
    copper,
    gold,
    iron,
    nickel,
    platinum,
    silver,
    titanium,
    tungsten
};

// eta + i k, against vacuum.
struct ComplexIor {
    Rgb eta{}, k{};
    friend bool operator==(const ComplexIor&, const ComplexIor&) = default;
};

ComplexIor complex_ior(Metal metal);

} // namespace renderer
