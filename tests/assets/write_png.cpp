#include "tests/assets/write_files.h"

#include <stdexcept>

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wmissing-field-initializers"
#define STB_IMAGE_WRITE_STATIC
#define STB_IMAGE_WRITE_IMPLEMENTATION
#include <stb_image_write.h>
#pragma GCC diagnostic pop

namespace tests {

void write_checker_png(const std::filesystem::path& path, int squares, int side)
{
    static constexpr std::array<std::array<unsigned char, 3>, 2> kColors{{{230, 225, 210}, {40, 90, 140}}};
    const int width = squares * side;
    std::vector<unsigned char> rgb;
    for (int y = 0; y < width; ++y)
        for (int x = 0; x < width; ++x)
            for (const unsigned char channel : kColors[static_cast<std::size_t>((x / side + y / side) % 2)])
                rgb.push_back(channel);
    if (stbi_write_png(path.c_str(), width, width, 3, rgb.data(), width * 3) == 0)
        throw std::runtime_error("cannot write " + path.string());
}

} // namespace tests
