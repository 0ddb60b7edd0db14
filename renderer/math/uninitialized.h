// Uninitialized: room for N values on the stack that nothing is written to before it is needed. Runs of rays fill a part
// of theirs: clearing the rest was a tenth of the time of a plain scene.
//
// Nothing may be read before it was assigned.
#pragma once

#include <cstddef>
#include <new>
#include <span>
#include <type_traits>

namespace renderer {

template <typename T, std::size_t N>
class Uninitialized {
    static_assert(std::is_trivially_copyable_v<T>, "its lifetime begins with its bytes");

public:
    T& operator[](std::size_t i) { return data()[i]; }
    T* data() { return std::launder(reinterpret_cast<T*>(bytes_)); }
    std::span<T> first(std::size_t count) { return {data(), count}; }

private:
    alignas(T) std::byte bytes_[N * sizeof(T)];
};

} // namespace renderer
