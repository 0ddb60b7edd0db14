// Every kernel that this processor can run: the same directions as drawn one by one.
#include "renderer/sampling/hemisphere_kernels.h"
#include "renderer/sampling/warp.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace {

using namespace renderer;

std::vector<Sample2> numbers()
{
    constexpr float kEdges[] = {
        0, 0x1p-24f, 0.25f, 0.5f - 0x1p-25f, 0.5f, 0.5f + 0x1p-24f, 0.75f, 1 - 0x1p-24f};
    std::vector<Sample2> numbers;
    for (const float u0 : kEdges)
        for (const float u1 : kEdges)
            numbers.push_back({u0, u1});
    const PixelSampler sampler(5, 3, 4);
    for (std::uint32_t i = 0; i < 5000; ++i)
        numbers.push_back(sampler.sample_2d(i, 0));
    return numbers;
}

} // namespace

TEST(HemisphereKernels, DrawAsOneByOneToTheBit)
{
    const std::vector<Sample2> u = numbers();
    for (const DrawInHemisphere kernel : all_draw_in_hemisphere()) {
        std::vector<Vec3f> drawn(u.size());
        kernel(u, drawn);
        for (std::size_t i = 0; i < u.size(); ++i)
            ASSERT_EQ(drawn[i], sample_cosine_hemisphere(u[i])) << u[i].u0 << ' ' << u[i].u1;
    }
}

TEST(HemisphereKernels, WriteAsManyAsThereAre)
{
    const std::vector<Sample2> u = numbers();
    for (const DrawInHemisphere kernel : all_draw_in_hemisphere())
        for (std::size_t count = 0; count < 20; ++count) {
            const Vec3f untouched{7, 8, 9};
            std::vector<Vec3f> drawn(20, untouched);
            kernel(std::span(u).first(count), drawn);
            EXPECT_EQ(std::ranges::count(drawn, untouched), static_cast<std::ptrdiff_t>(20 - count));
        }
}
