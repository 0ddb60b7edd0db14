// EncodingTurns: few pictures are encoded at once, and none twice at once: who asks for one that somebody is
// encoding waits for that.
//
// Threads  every function may be called from any thread.
#pragma once

#include <algorithm>
#include <condition_variable>
#include <cstddef>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

namespace server {

class EncodingTurns {
public:
    explicit EncodingTurns(std::size_t most) : most_(most) {}

    // Waits for as long as `key` is somebody's, or every place is taken; lets go at its end.
    class Turn {
    public:
        Turn(EncodingTurns& turns, std::string key) : turns_(turns), key_(std::move(key))
        {
            turns_.enter(key_);
        }
        ~Turn() { turns_.leave(key_); }
        Turn(const Turn&) = delete;
        Turn& operator=(const Turn&) = delete;

    private:
        EncodingTurns& turns_;
        std::string key_;
    };

private:
    void enter(const std::string& key)
    {
        std::unique_lock lock(mutex_);
        left_.wait(lock, [&] {
            return under_way_.size() < most_ &&
                   std::find(under_way_.begin(), under_way_.end(), key) == under_way_.end();
        });
        under_way_.push_back(key);
    }

    void leave(const std::string& key)
    {
        {
            const std::lock_guard lock(mutex_);
            std::erase(under_way_, key);
        }
        left_.notify_all();
    }

    std::mutex mutex_;
    std::condition_variable left_;
    std::size_t most_;
    std::vector<std::string> under_way_;
};

} // namespace server
