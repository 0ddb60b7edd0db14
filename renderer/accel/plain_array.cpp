#include "renderer/accel/plain_array.h"

#include <cstdint>
#include <new>
#include <sys/mman.h>

namespace renderer {

namespace {

constexpr std::size_t kHugePage = std::size_t{2} << 20;

std::align_val_t alignment_of(std::size_t bytes)
{
    return std::align_val_t{bytes >= 2 * kHugePage ? kHugePage : 128};
}

} // namespace

void* allocate_plain(std::size_t bytes)
{
    void* const memory = ::operator new(bytes, alignment_of(bytes));
    // Whole pages alone, so that no more memory is held than was asked for. Advice: a refusal changes nothing.
    if (bytes >= 2 * kHugePage) madvise(memory, bytes / kHugePage * kHugePage, MADV_HUGEPAGE);
    return memory;
}

void free_plain(void* memory, std::size_t bytes)
{
    ::operator delete(memory, alignment_of(bytes));
}

} // namespace renderer
