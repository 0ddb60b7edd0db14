// PlainArray: a fixed number of plain values that nobody has set yet: for those that many threads are to fill,
// each its own. Or lent: somebody else's memory, a mapped file say, that is read as it stands; who writes to it
// is a fault of ours.
//
// Cost  memory is touched by whoever fills it, not here. Large arrays ask for huge pages: fewer faults while they
//       are filled, fewer misses of the TLB afterwards.
#pragma once

#include <algorithm>
#include <cstddef>
#include <memory>
#include <span>
#include <type_traits>
#include <utility>

namespace renderer {

// Aligned to 128 bytes at least; throws std::bad_alloc.
void* allocate_plain(std::size_t bytes);
void free_plain(void* memory, std::size_t bytes);

template <typename T>
class PlainArray {
    static_assert(std::is_trivially_copyable_v<T> && std::is_trivially_destructible_v<T> &&
                  alignof(T) <= 128);

public:
    PlainArray() = default;
    explicit PlainArray(std::size_t size)
        : values_(size == 0 ? nullptr : static_cast<T*>(allocate_plain(size * sizeof(T)))), size_(size),
          allocated_(size)
    {
    }
    static PlainArray lent(std::span<const T> values, std::shared_ptr<const void> keeper)
    {
        PlainArray array;
        array.values_ = const_cast<T*>(values.data());
        array.size_ = array.allocated_ = values.size();
        array.keeper_ = std::move(keeper);
        return array;
    }
    ~PlainArray()
    {
        if (!keeper_) free_plain(values_, size_bytes());
    }
    PlainArray(PlainArray&& other) noexcept
        : values_(std::exchange(other.values_, nullptr)), size_(std::exchange(other.size_, 0)),
          allocated_(std::exchange(other.allocated_, 0)), keeper_(std::move(other.keeper_))
    {
    }
    PlainArray& operator=(PlainArray&& other) noexcept
    {
        PlainArray taken(std::move(other));
        std::swap(values_, taken.values_);
        std::swap(size_, taken.size_);
        std::swap(allocated_, taken.allocated_);
        std::swap(keeper_, taken.keeper_);
        return *this;
    }
    PlainArray(const PlainArray& other) : PlainArray(other.size())
    {
        std::copy(other.begin(), other.end(), begin());
    }
    PlainArray& operator=(const PlainArray& other)
    {
        if (this != &other) *this = PlainArray(other);
        return *this;
    }

    // The memory stays as it is.
    void shorten(std::size_t size) { size_ = std::min(size, size_); }

    std::size_t size() const { return size_; }
    std::size_t size_bytes() const { return allocated_ * sizeof(T); } // of the memory
    bool empty() const { return size_ == 0; }
    T* data() { return values_; }
    const T* data() const { return values_; }
    T& operator[](std::size_t i) { return values_[i]; }
    const T& operator[](std::size_t i) const { return values_[i]; }
    T* begin() { return values_; }
    T* end() { return values_ + size_; }
    const T* begin() const { return values_; }
    const T* end() const { return values_ + size_; }

private:
    T* values_ = nullptr;
    std::size_t size_ = 0, allocated_ = 0;
    std::shared_ptr<const void> keeper_; // of lent memory
};

} // namespace renderer
