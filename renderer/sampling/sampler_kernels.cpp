#include "renderer/sampling/sampler_kernels.h"

#include "renderer/math/kernel_targets.h"

#include <algorithm>
#include <vector>

// This file is compiled once for every target of Highway; what is above, for the baseline alone.
// clang-format off
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "renderer/sampling/sampler_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace renderer::HWY_NAMESPACE {
namespace {

#if HWY_TARGET == HWY_SCALAR

void draw_all(const PairRun& run, std::span<Sample2> out)
{
    for (std::size_t i = 0; i < out.size(); ++i)
        out[i] = sample_pair(run.pixel_key[i], run.sample[i], run.dimension[i]);
}

#else

namespace hn = hwy::HWY_NAMESPACE;
using D = hn::CappedTag<std::uint32_t, 16>;
using V = hn::Vec<D>;
using D64 = hn::Repartition<std::uint64_t, D>;
using V64 = hn::Vec<D64>;
constexpr std::size_t kLanes = hn::MaxLanes(D());
static_assert(PairRun::kPairs % kLanes == 0);

// The functions of sampler.cpp, which says why, lane by lane.
HWY_INLINE V64 mix(V64 x)
{
    const D64 d;
    x = hn::Add(x, hn::Set(d, 0x9e3779b97f4a7c15u));
    x = hn::Mul(hn::Xor(x, hn::ShiftRight<30>(x)), hn::Set(d, 0xbf58476d1ce4e5b9u));
    x = hn::Mul(hn::Xor(x, hn::ShiftRight<27>(x)), hn::Set(d, 0x94d049bb133111ebu));
    return hn::Xor(x, hn::ShiftRight<31>(x));
}

template <int kBits>
HWY_INLINE V swap_bits(V x, std::uint32_t mask)
{
    const V m = hn::Set(D(), mask);
    return hn::Or(hn::And(hn::ShiftRight<kBits>(x), m), hn::ShiftLeft<kBits>(hn::And(x, m)));
}
HWY_INLINE V reverse_bits(V x)
{
    x = hn::RotateRight<16>(x);
    x = swap_bits<8>(x, 0x00ff00ffu);
    x = swap_bits<4>(x, 0x0f0f0f0fu);
    x = swap_bits<2>(x, 0x33333333u);
    return swap_bits<1>(x, 0x55555555u);
}

HWY_INLINE V scramble_reversed(V x, V seed)
{
    const D d;
    x = hn::Xor(x, hn::Mul(x, hn::Set(d, 0x3d20adeau)));
    x = hn::Add(x, seed);
    x = hn::Mul(x, hn::Or(hn::ShiftRight<16>(seed), hn::Set(d, 1u)));
    x = hn::Xor(x, hn::Mul(x, hn::Set(d, 0x05526c56u)));
    return hn::Xor(x, hn::Mul(x, hn::Set(d, 0x53a22864u)));
}

HWY_INLINE V second_from_first(V x)
{
    const D d;
    x = hn::Xor(x, hn::ShiftLeft<16>(x));
    x = hn::Xor(x, hn::ShiftLeft<8>(hn::And(x, hn::Set(d, 0x00ff00ffu))));
    x = hn::Xor(x, hn::ShiftLeft<4>(hn::And(x, hn::Set(d, 0x0f0f0f0fu))));
    x = hn::Xor(x, hn::ShiftLeft<2>(hn::And(x, hn::Set(d, 0x33333333u))));
    return hn::Xor(x, hn::ShiftLeft<1>(hn::And(x, hn::Set(d, 0x55555555u))));
}

HWY_INLINE hn::Vec<hn::Rebind<float, D>> to_unit(V fraction)
{
    const hn::RebindToSigned<D> i;
    const hn::Rebind<float, D> f;
    return hn::Mul(hn::ConvertTo(f, hn::BitCast(i, hn::ShiftRight<8>(fraction))), hn::Set(f, 0x1p-24f));
}

struct Seeds {
    V shuffle, x, y;
};
HWY_INLINE V low_words(V64 first, V64 second)
{
    const D d;
    return hn::ConcatEven(d, hn::BitCast(d, second), hn::BitCast(d, first));
}
HWY_INLINE V high_words(V64 first, V64 second)
{
    const D d;
    return hn::ConcatOdd(d, hn::BitCast(d, second), hn::BitCast(d, first));
}
HWY_INLINE Seeds seeds_of(const PairRun& run, std::size_t first)
{
    const D64 d;
    constexpr std::size_t kHalf = kLanes / 2;
    const auto one_half = [&](std::size_t from) HWY_ATTR {
        const hn::Rebind<std::uint32_t, D64> narrow;
        const V64 dimension = hn::PromoteTo(d, hn::Load(narrow, run.dimension + from));
        return mix(
            hn::Xor(hn::Load(d, run.pixel_key + from), hn::Mul(dimension, hn::Set(d, 0xd6e8feb86659fd93u))));
    };
    const V64 a0 = one_half(first), a1 = one_half(first + kHalf);
    return {low_words(a0, a1), high_words(a0, a1), low_words(mix(a0), mix(a1))};
}

void draw_all(const PairRun& run, std::span<Sample2> out)
{
    const D d;
    const hn::Rebind<float, D> f;
    alignas(64) float u0[kLanes], u1[kLanes];
    for (std::size_t first = 0; first < out.size(); first += kLanes) {
        const Seeds seeds = seeds_of(run, first);
        const V x = scramble_reversed(reverse_bits(hn::Load(d, run.sample + first)), seeds.shuffle);
        const V y = second_from_first(x);
        hn::Store(to_unit(reverse_bits(scramble_reversed(reverse_bits(x), seeds.x))), f, u0);
        hn::Store(to_unit(reverse_bits(scramble_reversed(reverse_bits(y), seeds.y))), f, u1);
        const std::size_t count = std::min(kLanes, out.size() - first);
        for (std::size_t i = 0; i < count; ++i)
            out[first + i] = {u0[i], u1[i]};
    }
}

#endif

} // namespace

DrawPairs pair_drawing()
{
    return draw_all;
}

} // namespace renderer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace renderer {

std::span<const DrawPairs> all_draw_pairs()
{
    static const std::vector<DrawPairs> usable = HELIOGRAPH_USABLE_KERNELS(DrawPairs, pair_drawing);
    return usable;
}

DrawPairs draw_pairs()
{
    static const DrawPairs best = all_draw_pairs().front();
    return best;
}

} // namespace renderer
#endif // HWY_ONCE
