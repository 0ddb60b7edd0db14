#include "renderer/math/vec3.h"

#include <gtest/gtest.h>

namespace {

using namespace renderer;

__attribute__((noinline)) Vec3d through_float(Vec3d v)
{
    return to_double(to_float(v));
}

// A compiler that drops the narrowing makes values depend on what was inlined. GCC 12 does, at -O2, where it
// vectorises straight-line code.
TEST(Vec3, IsRoundedByATripThroughFloat)
{
    const Vec3d v{1.0 / 3, 2.0 / 3, 0.1};
    const Vec3d rounded = through_float(v);
    EXPECT_EQ(rounded,
              (Vec3d{static_cast<double>(0x1.555556p-2f),
                     static_cast<double>(0x1.555556p-1f),
                     static_cast<double>(0x1.99999ap-4f)}));
    EXPECT_NE(rounded.x, v.x);
}

TEST(Vec3, LengthNeitherOverflowsNorUnderflows)
{
    EXPECT_DOUBLE_EQ(length(Vec3d{3e300, 4e300, 0}), 5e300);
    EXPECT_DOUBLE_EQ(length(Vec3d{3e-300, 0, -4e-300}), 5e-300);
    EXPECT_EQ(length(Vec3d{}), 0);
    EXPECT_EQ(normalize(Vec3d{0, -1e300, 0}), (Vec3d{0, -1, 0}));
}

} // namespace
