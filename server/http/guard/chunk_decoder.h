// ChunkDecoder: takes chunked transfer coding apart, strictly; httplib's own reader takes "-2" for a chunk
// size and lets a size line grow without end.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace server {

class ChunkDecoder {
public:
    // Takes bytes off the front of `raw` and appends the data among them to `out`. False: this is no chunked
    // body.
    bool decode(std::string_view& raw, std::string& out);
    bool finished() const { return state_ == State::finished; } // trailers included

private:
    enum class State : std::uint8_t { size, data, data_end, trailer, finished };
    bool take_line(std::string_view& raw, bool& complete);
    bool read_size();

    State state_ = State::size;
    std::string line_; // the size or trailer line under way
    std::uint64_t left_ = 0;
    std::size_t trailer_bytes_ = 0;
};

} // namespace server
