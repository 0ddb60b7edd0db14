// What Highway's kernels are compiled for, and which of them this processor can run.
//
// A kernel's .cpp is compiled once a target; what it offers is made by a function in each target's namespace. It includes this
// before Highway's own headers.
#pragma once

#include <cstdint>

// Few processors stop at SSSE3: the portable kernel will do. Vectors of SVE have no size and cannot be members;
// where it is, NEON is too.
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128)
#include <hwy/targets.h>
#include <initializer_list>
#include <vector>

namespace renderer {

template <typename Kernels>
struct CompiledKernels {
    std::int64_t target;
    Kernels (*make)(); // none: not compiled for this architecture
};

// The best first, in the order given; `portable`, which runs everywhere, last, if it is none of them.
template <typename Kernels>
std::vector<Kernels> usable_kernels(std::initializer_list<CompiledKernels<Kernels>> compiled,
                                    Kernels (*portable)())
{
    std::vector<Kernels> usable;
    for (const CompiledKernels<Kernels>& one : compiled)
        if (one.make != nullptr && one.make != portable && (hwy::SupportedTargets() & one.target) != 0)
            usable.push_back(one.make());
    usable.push_back(portable());
    return usable;
}

} // namespace renderer

// Those that `make` makes, a function of each target's namespace. A macro, since so are Highway's names of functions.
#define HELIOGRAPH_USABLE_KERNELS(Kernels, make)                                                             \
    renderer::usable_kernels<Kernels>({{HWY_AVX3, HWY_CHOOSE_AVX3(make)},                                    \
                                       {HWY_AVX2, HWY_CHOOSE_AVX2(make)},                                    \
                                       {HWY_SSE4, HWY_CHOOSE_SSE4(make)},                                    \
                                       {HWY_NEON, HWY_CHOOSE_NEON(make)}},                                   \
                                      HWY_CHOOSE_FALLBACK(make))
