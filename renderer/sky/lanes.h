// Lanes: four wavelengths at once.
#pragma once

#include <array>
#include <cstddef>

namespace renderer {

// Each operation rounds as the scalar one does, whatever the processor.
typedef float Lanes __attribute__((vector_size(16)));

inline Lanes splat(float x)
{
    return Lanes{x, x, x, x};
}

inline constexpr std::size_t kLanes = 4;

// Groups of four that n wavelengths need.
constexpr std::size_t lane_groups(std::size_t n)
{
    return (n + kLanes - 1) / kLanes;
}

} // namespace renderer
