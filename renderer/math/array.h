// Array: plain values one after the other, as std::vector has them; its own, or lent: somebody else's memory,
// a mapped file say, which lives as long as its keeper.
//
// Lent    is read as it stands; the first write makes a copy of its own. Copies of a lent array share it.
// Cost    grows by doubling, through realloc: what is large moves without being copied.
// Errors  std::bad_alloc. Indices are not checked.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <initializer_list>
#include <limits>
#include <memory>
#include <new>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

namespace renderer {

template <typename T>
class Array {
    static_assert(std::is_trivially_copyable_v<T> && alignof(T) <= alignof(std::max_align_t));

public:
    using value_type = T;
    using size_type = std::size_t;
    using iterator = T*;
    using const_iterator = const T*;

    Array() = default;
    explicit Array(std::size_t size) { resize(size); }
    Array(std::initializer_list<T> values) { append(values); }
    explicit(false) Array(const std::vector<T>& values) { append(values); } // NOLINT: implicit
    static Array lent(std::span<const T> values, std::shared_ptr<const void> keeper)
    {
        Array array;
        array.data_ = const_cast<T*>(values.data()); // never written through: see own()
        array.size_ = values.size();
        array.keeper_ = std::move(keeper);
        return array;
    }
    Array(const Array& other)
    {
        if (other.keeper_)
            *this = lent(other, other.keeper_);
        else
            append(other);
    }
    Array(Array&& other) noexcept { swap(other); }
    Array& operator=(const Array& other)
    {
        Array(other).swap(*this);
        return *this;
    }
    Array& operator=(Array&& other) noexcept
    {
        Array(std::move(other)).swap(*this);
        return *this;
    }
    ~Array()
    {
        if (!keeper_) std::free(data_);
    }
    void swap(Array& other) noexcept
    {
        std::swap(data_, other.data_);
        std::swap(size_, other.size_);
        std::swap(capacity_, other.capacity_);
        std::swap(keeper_, other.keeper_);
    }

    bool is_lent() const { return keeper_ != nullptr; }
    bool empty() const { return size_ == 0; }
    std::size_t size() const { return size_; }
    std::size_t capacity() const { return keeper_ ? size_ : capacity_; } // what it holds, its own or lent
    const T* data() const { return data_; }
    const T* begin() const { return data_; }
    const T* end() const { return data_ + size_; }
    const T& operator[](std::size_t i) const { return data_[i]; }
    const T& front() const { return data_[0]; }
    const T& back() const { return data_[size_ - 1]; }
    T* data() { return own(), data_; }
    T* begin() { return data(); }
    T* end() { return data() + size_; }
    T& operator[](std::size_t i) { return data()[i]; }
    T& front() { return data()[0]; }
    T& back() { return data()[size_ - 1]; }

    void reserve(std::size_t capacity)
    {
        own();
        if (capacity > capacity_) reallocate(capacity);
    }
    // What is new holds nothing in particular.
    void resize_for_overwrite(std::size_t size)
    {
        reserve(size);
        size_ = size;
    }
    void resize(std::size_t size, const T& value = T())
    {
        const std::size_t before = size_;
        resize_for_overwrite(size);
        if (size > before) std::fill(data_ + before, data_ + size, value);
    }
    void push_back(const T& value)
    {
        const T copy = value; // which may lie in here
        if (size_ == capacity_ || keeper_) grow(size_ + 1);
        data_[size_++] = copy;
    }
    void append(std::span<const T> values) // which do not lie in here
    {
        if (values.empty()) return;
        grow(size_ + values.size());
        std::memcpy(static_cast<void*>(data_ + size_), values.data(), values.size_bytes());
        size_ += values.size();
    }
    void append(std::initializer_list<T> values)
    {
        append(std::span<const T>(values.begin(), values.size()));
    }
    void append(std::size_t count, const T& value) { resize(size_ + count, value); }
    void assign(std::size_t count, const T& value)
    {
        const T copy = value;
        clear();
        resize(count, copy);
    }
    void assign(const T* begin, const T* end) // which do not lie in here
    {
        clear();
        append(std::span<const T>(begin, end));
    }
    void pop_back()
    {
        own();
        --size_;
    }
    void clear() { Array().swap(*this); }

    friend bool operator==(const Array& a, const Array& b)
    {
        return std::equal(a.begin(), a.end(), b.begin(), b.end());
    }

private:
    void own()
    {
        if (!keeper_) return;
        Array copy;
        copy.append(std::span<const T>(data_, size_));
        swap(copy);
    }
    void grow(std::size_t least)
    {
        own();
        if (least > capacity_) reallocate(std::max({least, 2 * capacity_, std::size_t{16}}));
    }
    void reallocate(std::size_t capacity)
    {
        if (capacity > std::numeric_limits<std::size_t>::max() / sizeof(T)) throw std::bad_alloc();
        void* const data = std::realloc(static_cast<void*>(data_), capacity * sizeof(T));
        if (!data) throw std::bad_alloc();
        data_ = static_cast<T*>(data);
        capacity_ = capacity;
    }

    T* data_ = nullptr;
    std::size_t size_ = 0, capacity_ = 0; // of its own memory
    std::shared_ptr<const void> keeper_;  // of lent memory
};

} // namespace renderer
