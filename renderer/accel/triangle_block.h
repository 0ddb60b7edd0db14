// TriangleBlock: four triangles side by side, as a leaf stores them for the kernels.
#pragma once

#include "renderer/math/vec3.h"

#include <cstddef>
#include <cstdint>
#include <limits>

namespace renderer {

struct alignas(16) TriangleBlock {
    static constexpr std::uint32_t kLanes = 4;
    static constexpr std::uint32_t kNone =
        std::numeric_limits<std::uint32_t>::max(); // primitive of an unused lane

    float corners[3][3][4]; // [corner][axis][lane], in scaled coordinates
    std::uint32_t primitive[4];

    void set(std::size_t lane, std::uint32_t number, const Vec3f (&triangle)[3])
    {
        primitive[lane] = number;
        for (std::size_t k = 0; k < 3; ++k)
            for (std::size_t axis = 0; axis < 3; ++axis)
                corners[k][axis][lane] = triangle[k][axis];
    }
    Vec3d corner(std::size_t k, std::size_t lane) const
    {
        return {corners[k][0][lane], corners[k][1][lane], corners[k][2][lane]};
    }
};

// What the corners of a block lack: one beside every block of a mesh that has residuals.
struct alignas(16) CornerResiduals {
    float corners[3][3][4]; // as TriangleBlock's

    void set(std::size_t lane, const Vec3f (&triangle)[3])
    {
        for (std::size_t k = 0; k < 3; ++k)
            for (std::size_t axis = 0; axis < 3; ++axis)
                corners[k][axis][lane] = triangle[k][axis];
    }
    Vec3d corner(std::size_t k, std::size_t lane) const
    {
        return {corners[k][0][lane], corners[k][1][lane], corners[k][2][lane]};
    }
};

} // namespace renderer
