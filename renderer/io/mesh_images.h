// MeshImages: the pictures that a mesh's materials name, decoded once each: files that came along, or bytes within
// the mesh's own.
//
// Errors  none: a picture that did not come, or cannot be read, is a note, and its material goes without.
#pragma once

#include "renderer/io/companion_files.h"
#include "renderer/io/import_mesh.h"

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace renderer {

class MeshImages {
public:
    MeshImages(CompanionFiles& files, const Limits& limits, ImportedMesh& result)
        : files_(files), limits_(limits), result_(result)
    {
    }

    // Its number among the mesh's images.
    std::optional<std::uint32_t> of_file(std::string_view name);
    std::optional<std::uint32_t> of_bytes(const std::string& name, std::span<const std::byte> bytes);

    bool has_alpha(std::uint32_t image) const { return result_.mesh.images[image].image.has_alpha(); }

private:
    void note(const std::string& what);

    CompanionFiles& files_;
    const Limits& limits_;
    ImportedMesh& result_;
    std::map<std::string, std::optional<std::uint32_t>, std::less<>> known_;
};

} // namespace renderer
