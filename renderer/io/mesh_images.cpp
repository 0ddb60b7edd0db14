#include "renderer/io/mesh_images.h"

#include "renderer/io/import_bounds.h"
#include "renderer/io/import_image.h"
#include "renderer/io/text.h"

#include <algorithm>

namespace renderer {

void MeshImages::note(const std::string& what)
{
    if (result_.notes.size() < kMostNotes) result_.notes.push_back(what);
}

std::optional<std::uint32_t> MeshImages::of_file(std::string_view name)
{
    if (const auto known = known_.find(name); known != known_.end()) return known->second;
    auto bytes = files_.open(name);
    if (!bytes) { // as another system writes its folders
        std::string path(name);
        std::replace(path.begin(), path.end(), '\\', '/');
        if (path != name) bytes = files_.open(path);
    }
    if (bytes) return of_bytes(std::string(name), *bytes);
    note("texture " + clean_utf8(name) + " did not come with the mesh: its material keeps its plain values");
    known_.emplace(name, std::nullopt);
    return std::nullopt;
}

std::optional<std::uint32_t> MeshImages::of_bytes(const std::string& name, std::span<const std::byte> bytes)
{
    if (const auto known = known_.find(name); known != known_.end()) return known->second;
    ImageResult read = import_image(name, bytes, limits_);
    if (const auto* fault = std::get_if<ImportFault>(&read)) {
        note("texture " + clean_utf8(name) + " is left out: " + fault->detail);
        known_.emplace(name, std::nullopt);
        return std::nullopt;
    }
    const auto number = static_cast<std::uint32_t>(result_.mesh.images.size());
    result_.mesh.images.push_back({clean_utf8(name), std::move(std::get<ImportedImage>(read).image)});
    known_.emplace(name, number);
    return number;
}

} // namespace renderer
