// The flat form in which heliograph-import hands a mesh, a picture, or a failure, to the service: a head
// with counts, pictures and arrays as they stand in memory, then the texts. It never leaves the machine, so it has this machine's
// byte order.
//
// Shared  the arrays of what read_flat() gives are lent: they stand where the bytes stand, and keep those.
// Errors  read_flat() takes nothing on trust: sizes, counts, ranges, finiteness and UTF-8 are checked; bytes
//         that are not just what write_flat() makes give a failure "import_crashed". They must not change
//         meanwhile or afterwards.
// Cost    a pass over the arrays, no copy.
#pragma once

#include "renderer/description/limits.h"
#include "renderer/geometry/mesh.h"
#include "renderer/textures/image.h"
#include "server/import/import_failure.h"
#include "server/import/mapped_bytes.h"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace server {

// Changes whenever the flat form or what the importer makes of a file does: the head of the form has it, so that
// a service never takes the output of another build's importer.
constexpr std::uint32_t kImporterVersion = 5;

// How the name that the importer is given begins where a picture is wanted.
inline constexpr std::string_view kPictureWord = "picture";

struct ImportedAsset {
    renderer::Mesh mesh;
    std::string format; // its name in mesh_formats.h
    std::vector<std::string> notes;
};

struct ImportedPicture {
    renderer::Image image;
    std::string format; // its name in image_formats.h
};

using ImportOutcome = std::variant<ImportedAsset, ImportedPicture, ImportFailure>;
using ByteSink = std::function<void(std::span<const std::byte>)>;

// The outcome itself, or "over_limit" where its flat form would be refused for its size.
ImportOutcome within_flat_bounds(ImportOutcome outcome, const renderer::Limits& limits);
void write_flat(const ImportOutcome& outcome, const ByteSink& sink);
ImportOutcome read_flat(const MappedBytes& flat, const renderer::Limits& limits);

} // namespace server
