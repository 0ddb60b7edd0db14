// Which of the kernels that Highway compiled this processor can run.
//
// A kernel's .cpp is compiled once a target; what it offers is made by a function in each target's namespace. It includes
// this behind all else, where it is compiled for the last time: what Highway leaves out has to be told before.
#pragma once

#include <cstdint>
#include <hwy/targets.h>
#include <initializer_list>
#include <vector>

namespace renderer {

template <typename Kernels>
struct CompiledKernels {
    std::int64_t target;
    Kernels (*make)(); // none: not compiled for this architecture
};

// The best first, in the order given; `portable` last, which runs everywhere.
template <typename Kernels>
std::vector<Kernels> usable_kernels(std::initializer_list<CompiledKernels<Kernels>> compiled,
                                    const Kernels& portable)
{
    std::vector<Kernels> usable;
    for (const CompiledKernels<Kernels>& one : compiled)
        if (one.make != nullptr && (hwy::SupportedTargets() & one.target) != 0) usable.push_back(one.make());
    usable.push_back(portable);
    return usable;
}

} // namespace renderer
