#include "renderer/accel/split.h"
#include "tests/renderer/accel/random_scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace {

using namespace renderer;

template <typename T>
std::vector<BuildItem<T>> random_items(std::uint32_t count, double far)
{
    random_scenes::Random random(count);
    std::vector<BuildItem<T>> items(count);
    for (std::uint32_t i = 0; i < count; ++i) {
        const Vec3d low = random.in_box({far, -1, 0}, {far + 1, 1, 0}),
                    high = low + random.in_box({}, {.1, .1, 0});
        items[i] = {Vec3<T>{T(low.x), T(low.y), T(low.z)}, i, Vec3<T>{T(high.x), T(high.y), T(high.z)}};
    }
    return items;
}

template <typename T>
bool same(const RunBounds<T>& a, const RunBounds<T>& b)
{
    return a.box() == b.box() && a.centers() == b.centers();
}

template <typename T>
std::vector<std::uint32_t> numbers(const std::vector<BuildItem<T>>& items)
{
    std::vector<std::uint32_t> result;
    for (const BuildItem<T>& item : items)
        result.push_back(item.primitive);
    return result;
}

// Every kernel of this processor chooses and makes the same cut as the plainest one, also in two parts.
template <typename T>
void expect_one_answer(std::uint32_t count, double far)
{
    const auto items = random_items<T>(count, far);
    const std::span<const BuildItem<T>> run(items);
    RunBounds<T> bounds;
    for (const BuildItem<T>& item : items)
        bounds.extend(item);
    const SplitKernels<T>& plain = all_split_kernels<T>().back();
    Bins<T> plain_bins(bounds, count);
    plain.add(plain_bins, run);
    const auto plain_cut = plain.best_cut(plain_bins, bounds, 4, 1e30);
    ASSERT_TRUE(plain_cut);
    auto plain_order = items;
    const Sides<T> plain_sides = plain.partition(plain_order, *plain_cut);
    EXPECT_GT(plain_sides.left, 0u);
    EXPECT_LT(plain_sides.left, count);
    EXPECT_EQ(plain.count_left(run, *plain_cut), plain_sides.left);
    EXPECT_EQ(plain_bins.count_left(*plain_cut), plain_sides.left);
    for (const SplitKernels<T>& kernels : all_split_kernels<T>()) {
        Bins<T> bins(bounds, count), rest(bounds, count);
        kernels.add(bins, run.first(count / 3));
        kernels.add(rest, run.subspan(count / 3));
        bins.merge(rest);
        const auto cut = kernels.best_cut(bins, bounds, 4, 1e30);
        ASSERT_TRUE(cut);
        EXPECT_EQ(cut->axis, plain_cut->axis);
        EXPECT_EQ(cut->below, plain_cut->below);
        EXPECT_FALSE(kernels.best_cut(bins, bounds, 4, 1e-3)) << "nothing costs so little";
        auto order = items;
        const Sides<T> sides = kernels.partition(order, *cut);
        EXPECT_EQ(sides.left, plain_sides.left);
        EXPECT_EQ(numbers(order), numbers(plain_order));
        std::vector<BuildItem<T>> moved(count);
        const Sides<T> apart = kernels.scatter(run, *cut, moved.data(), moved.data() + sides.left);
        EXPECT_EQ(apart.left, sides.left);
        EXPECT_TRUE(std::is_sorted(moved.begin(),
                                   moved.begin() + static_cast<std::ptrdiff_t>(sides.left),
                                   [](const auto& a, const auto& b) { return a.primitive < b.primitive; }));
        for (const std::size_t side : {0u, 1u}) {
            EXPECT_TRUE(same(sides.bounds[side], plain_sides.bounds[side]));
            EXPECT_TRUE(same(apart.bounds[side], plain_sides.bounds[side]));
        }
    }
}

TEST(SplitKernels, GiveOneAnswer)
{
    for (const std::uint32_t count : {5u, 31u, 32u, 1000u})
        for (const double far : {0.0, 1000.0}) {
            expect_one_answer<float>(count, far);
            expect_one_answer<double>(count, far);
        }
}

TEST(SplitKernels, CutNothingThatNothingTellsApart)
{
    const std::vector<BuildItem<float>> items(100, BuildItem<float>{{1, 1, 1}, 0, {2, 2, 2}});
    RunBounds<float> bounds;
    for (const BuildItem<float>& item : items)
        bounds.extend(item);
    for (const SplitKernels<float>& kernels : all_split_kernels<float>()) {
        Bins<float> bins(bounds, items.size());
        kernels.add(bins, items);
        EXPECT_FALSE(kernels.best_cut(bins, bounds, 4, 1e30));
    }
    EXPECT_FALSE(cut_at_midpoint(bounds));
}

} // namespace
