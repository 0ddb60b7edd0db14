// Waiters: how many requests may wait at the same time, since each holds a thread.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <optional>
#include <utility>

namespace server {

// How often a waiting request looks whether its client is still there.
inline constexpr std::chrono::milliseconds kGlance{250};

class Waiters {
public:
    explicit Waiters(std::uint64_t limit) : limit_(limit) {}

    // A place among the waiting, given back by its destructor.
    class Place {
    public:
        explicit Place(std::atomic<std::uint64_t>& count) : count_(&count) {}
        Place(Place&& other) noexcept : count_(std::exchange(other.count_, nullptr)) {}
        Place& operator=(Place&& other) noexcept
        {
            std::swap(count_, other.count_);
            return *this;
        }
        Place(const Place&) = delete;
        Place& operator=(const Place&) = delete;
        ~Place()
        {
            if (count_) --*count_;
        }

    private:
        std::atomic<std::uint64_t>* count_;
    };
    std::optional<Place> enter()
    {
        if (++count_ <= limit_) return Place(count_);
        --count_;
        return std::nullopt;
    }

private:
    const std::uint64_t limit_;
    std::atomic<std::uint64_t> count_ = 0;
};

} // namespace server
