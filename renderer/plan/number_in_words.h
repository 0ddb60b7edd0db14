// number_in_words: a figure as a sentence of the plan tells it: four digits.
#pragma once

#include <array>
#include <charconv>
#include <string>

namespace renderer {

inline std::string number_in_words(double x)
{
    std::array<char, 32> text{};
    const auto end = std::to_chars(text.data(), text.data() + text.size(), x, std::chars_format::general, 4);
    return {text.data(), end.ptr};
}

} // namespace renderer
