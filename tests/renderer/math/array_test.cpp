#include "renderer/math/array.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <memory>
#include <numeric>
#include <utility>
#include <vector>

namespace {

using Numbers = renderer::Array<std::uint32_t>;
using testing::ElementsAre;

TEST(Array, GrowsAsAVectorDoes)
{
    Numbers numbers;
    std::vector<std::uint32_t> same;
    for (std::uint32_t i = 0; i < 1000; ++i) {
        numbers.push_back(i);
        same.push_back(i);
    }
    numbers.append({7, 8});
    numbers.append(2, 9);
    same.insert(same.end(), {7, 8, 9, 9});
    EXPECT_EQ(numbers, Numbers(same));
    numbers.resize(3);
    numbers.resize(5, 6);
    EXPECT_THAT(numbers, ElementsAre(0, 1, 2, 6, 6));
    EXPECT_GE(numbers.capacity(), 5u);
    numbers.clear();
    EXPECT_TRUE(numbers.empty());
}

TEST(Array, TakesAValueOfItsOwn)
{
    Numbers numbers{5};
    for (int i = 0; i < 100; ++i)
        numbers.push_back(numbers.front());
    EXPECT_THAT(numbers, testing::Each(5));
}

TEST(Array, CopiesWhatItOwnsAndSharesWhatItWasLent)
{
    const Numbers own{1, 2, 3};
    const Numbers copy = own;
    EXPECT_NE(std::as_const(copy).data(), own.data());
    EXPECT_EQ(copy, own);

    auto memory = std::make_shared<std::vector<std::uint32_t>>(std::vector<std::uint32_t>{4, 5, 6});
    const std::uint32_t* const place = memory->data();
    const std::weak_ptr<void> watch = memory;
    Numbers kept;
    {
        const Numbers lent = Numbers::lent(*memory, memory);
        memory.reset();
        EXPECT_TRUE(lent.is_lent());
        EXPECT_EQ(lent.data(), place);
        kept = lent;
    }
    EXPECT_EQ(std::as_const(kept).data(), place);
    EXPECT_FALSE(watch.expired());
    kept = {};
    EXPECT_TRUE(watch.expired());
}

TEST(Array, NeverWritesToWhatItWasLent)
{
    const auto memory =
        std::make_shared<const std::vector<std::uint32_t>>(std::vector<std::uint32_t>{4, 5, 6});
    const auto lent = [&] { return Numbers::lent(*memory, memory); };
    Numbers a = lent(), b = lent(), c = lent(), d = lent(), e = lent();
    a[1] = 9;
    b.push_back(7);
    c.resize(1);
    for (std::uint32_t& number : d)
        number = 0;
    e.pop_back();
    EXPECT_THAT(a, ElementsAre(4, 9, 6));
    EXPECT_THAT(b, ElementsAre(4, 5, 6, 7));
    EXPECT_THAT(c, ElementsAre(4));
    EXPECT_THAT(d, ElementsAre(0, 0, 0));
    EXPECT_THAT(e, ElementsAre(4, 5));
    EXPECT_THAT(*memory, ElementsAre(4, 5, 6));
    for (const Numbers* array : {&a, &b, &c, &d, &e})
        EXPECT_FALSE(array->is_lent());
}

} // namespace
