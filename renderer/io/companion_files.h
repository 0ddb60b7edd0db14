// CompanionFiles: the other files that a mesh file names (an MTL, a glTF buffer), served by name and nothing
// else.
//
// A name is asked for as the file wrote it, then without a leading "./". Absolute names, names with a "..", a
// backslash or a scheme are never asked for: whatever stands behind `open`, they cannot leave it.
#pragma once

#include "renderer/io/import_mesh.h"

#include <cstddef>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace renderer {

class CompanionFiles {
public:
    explicit CompanionFiles(const OpenFile& open) : open_(open) {}

    // The bytes, remembered as opened; nothing if there is no such file.
    std::optional<std::span<const std::byte>> open(std::string_view name);
    std::vector<std::string> opened() const { return {opened_.begin(), opened_.end()}; }

private:
    const OpenFile& open_;
    std::set<std::string> opened_;
};

// Relative, without "..", backslash, colon or control characters, and not overlong.
bool is_plain_file_name(std::string_view name);

} // namespace renderer
