// TileGrid: a region cut into tiles of scheduling, left to right and top to bottom; the last ones may be
// narrower.
//
// No pixel depends on the tiles: they only say what one thread takes at a time.
#pragma once

#include "renderer/description/settings.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace renderer {

// A tile larger than 256 pixels a side would only hold memory and let threads idle at the end.
inline constexpr std::uint32_t kLargestTile = 256;

// The side asked for, or the largest one within kLargestTile and `most_pixels`; at least 1.
inline std::uint32_t tile_side(std::uint32_t asked, std::size_t most_pixels)
{
    std::uint32_t side = std::clamp(asked, 1u, kLargestTile);
    while (side > 1 && std::size_t{side} * side > most_pixels)
        --side;
    return side;
}

class TileGrid {
public:
    TileGrid(PixelRect region, std::uint32_t side)
        : region_(region), side_(side), columns_((region.width + side_ - 1) / side_),
          rows_((region.height + side_ - 1) / side_)
    {
    }

    std::size_t size() const { return std::size_t{columns_} * rows_; }
    std::size_t largest_tile_pixels() const { return std::size_t{side_} * side_; }

    PixelRect tile(std::size_t number) const
    {
        const auto column = static_cast<std::uint32_t>(number % columns_) * side_;
        const auto row = static_cast<std::uint32_t>(number / columns_) * side_;
        return {region_.x + column,
                region_.y + row,
                std::min(side_, region_.width - column),
                std::min(side_, region_.height - row)};
    }

private:
    PixelRect region_;
    std::uint32_t side_;
    std::uint32_t columns_, rows_;
};

} // namespace renderer
