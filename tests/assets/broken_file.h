// One file of the broken ones: its name, its bytes, and what is wrong with it (see broken_files.h).
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace tests {

struct BrokenFile {
    std::string name;
    std::string codes;
    std::string what;
    std::string bytes;
};

inline std::string cut(const std::string& bytes, double fraction)
{
    return bytes.substr(0, static_cast<std::size_t>(static_cast<double>(bytes.size()) * fraction));
}

inline std::string replaced(std::string text, std::string_view from, std::string_view to)
{
    return text.replace(text.find(from), from.size(), to);
}

// COLLADA, FBX, 3DS, OFF.
void add_broken_scenes(std::vector<BrokenFile>& files);

} // namespace tests
