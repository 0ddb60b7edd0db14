// Every kernel that this processor can run: the same directions as drawn one by one.
#include "renderer/sampling/hemisphere_kernels.h"
#include "renderer/sampling/warp.h"
#include "tests/renderer/sampling/edge_numbers.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

using namespace renderer;

TEST(HemisphereKernels, DrawAsOneByOneToTheBit)
{
    const std::vector<Sample2> u = tests::edge_numbers();
    for (const DrawInHemisphere kernel : all_draw_in_hemisphere()) {
        std::vector<Vec3f> drawn(u.size());
        kernel(u, drawn);
        for (std::size_t i = 0; i < u.size(); ++i)
            ASSERT_EQ(drawn[i], sample_cosine_hemisphere(u[i])) << u[i].u0 << ' ' << u[i].u1;
    }
}

TEST(HemisphereKernels, WriteAsManyAsThereAre)
{
    const std::vector<Sample2> u = tests::edge_numbers();
    for (const DrawInHemisphere kernel : all_draw_in_hemisphere())
        for (std::size_t count = 0; count < 20; ++count) {
            const Vec3f untouched{7, 8, 9};
            std::vector<Vec3f> drawn(20, untouched);
            kernel(std::span(u).first(count), drawn);
            EXPECT_EQ(std::ranges::count(drawn, untouched), static_cast<std::ptrdiff_t>(20 - count));
        }
}
