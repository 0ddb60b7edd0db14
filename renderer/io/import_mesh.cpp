#include "renderer/io/import_mesh.h"

#include "renderer/description/mesh_formats.h"
#include "renderer/geometry/validate_mesh.h"
#include "renderer/io/closed_glass.h"
#include "renderer/io/read_3ds.h"
#include "renderer/io/read_collada.h"
#include "renderer/io/read_fbx.h"
#include "renderer/io/read_gltf.h"
#include "renderer/io/read_obj.h"
#include "renderer/io/read_off.h"
#include "renderer/io/read_ply.h"
#include "renderer/io/read_stl.h"
#include "renderer/io/text.h"

#include <algorithm>
#include <array>
#include <utility>

namespace renderer {

namespace {

enum class Format : std::uint8_t {
    unknown,
    obj,
    ply,
    stl_binary,
    stl_ascii,
    gltf,
    glb,
    fbx,
    dae,
    three_ds,
    off
};

// Every one of the first statements must be one that OBJ knows.
bool looks_like_obj(std::string_view text)
{
    constexpr std::array<std::string_view, 14> kKnown{
        "v", "vt", "vn", "vp", "f", "l", "p", "o", "g", "s", "mg", "usemtl", "mtllib", "usemap"};
    constexpr int kEnough = 8;
    int statements = 0;
    Lines lines(text.substr(0, 1u << 16));
    while (const auto line = lines.next()) {
        std::string_view rest = *line;
        const std::string_view word = take_word(rest);
        if (word.empty() || word.front() == '#') continue;
        if (std::find(kKnown.begin(), kKnown.end(), word) == kKnown.end()) return false;
        if (++statements == kEnough) break;
    }
    return statements > 0;
}

Format format_of_content(std::string_view text)
{
    if (text.starts_with("glTF")) return Format::glb;
    if (text.starts_with("Kaydara FBX Binary")) return Format::fbx;
    if (is_3ds(text)) return Format::three_ds;
    if (text.starts_with("ply\n") || text.starts_with("ply\r")) return Format::ply;
    if (binary_stl_facets(text))
        return Format::stl_binary; // before "solid", with which binary ones may begin
    const std::size_t first = text.find_first_not_of(" \t\r\n");
    if (first == text.npos) return Format::unknown;
    if (text[first] == ';' && text.substr(first, 4096).find("FBX") != text.npos) return Format::fbx;
    if (text[first] == '<' && text.substr(first, 4096).find("<COLLADA") != text.npos) return Format::dae;
    if (is_off(text.substr(first))) return Format::off;
    if (text[first] == '{' && text.find("\"asset\"") != text.npos) return Format::gltf;
    std::string_view start = text.substr(first, 1024);
    const std::string_view word = take_word(start);
    if (lower_case(word.substr(0, 6)) == "solid" && lower_case(start).find("facet") != std::string::npos)
        return Format::stl_ascii;
    return looks_like_obj(text) ? Format::obj : Format::unknown;
}

Format format_of_name(std::string_view name, std::string_view text)
{
    const std::size_t dot = name.rfind('.');
    const std::string extension = dot == name.npos ? "" : lower_case(name.substr(dot));
    if (extension == ".obj") return Format::obj;
    if (extension == ".ply") return Format::ply;
    if (extension == ".stl")
        return lower_case(text.substr(0, 5)) == "solid" ? Format::stl_ascii : Format::stl_binary;
    if (extension == ".gltf") return Format::gltf;
    if (extension == ".glb") return Format::glb;
    if (extension == ".fbx") return Format::fbx;
    if (extension == ".dae") return Format::dae;
    if (extension == ".3ds") return Format::three_ds;
    if (extension == ".off") return Format::off;
    return Format::unknown;
}

ImportResult
read(Format format, std::span<const std::byte> bytes, CompanionFiles& files, const Limits& limits)
{
    switch (format) {
    case Format::obj:
        return read_obj(text_of(bytes), files, limits);
    case Format::ply:
        return read_ply(text_of(bytes), limits);
    case Format::stl_binary:
        return read_binary_stl(text_of(bytes), limits);
    case Format::stl_ascii:
        return read_ascii_stl(text_of(bytes), limits);
    case Format::gltf:
        return read_gltf(bytes, files, limits);
    case Format::glb:
        return read_glb(bytes, files, limits);
    case Format::fbx:
        return read_fbx(bytes, files, limits);
    case Format::dae:
        return read_collada(bytes, files, limits);
    case Format::three_ds:
        return read_3ds(bytes, files, limits);
    case Format::off:
        return read_off(text_of(bytes), limits);
    case Format::unknown:
        break;
    }
    return ImportFault{"unknown_format",
                       "the file begins with " + in_quotes(text_of(bytes).substr(0, 16)) +
                           ", which is none of what is read: " + mesh_format_titles()};
}

} // namespace

ImportResult import_mesh(std::string_view name,
                         std::span<const std::byte> bytes,
                         const OpenFile& open,
                         const Limits& limits)
{
    if (bytes.empty()) return ImportFault{"no_triangles", "the file is empty"};
    CompanionFiles files(open);
    Format format = format_of_content(text_of(bytes));
    if (format == Format::unknown) format = format_of_name(name, text_of(bytes));
    ImportResult result = read(format, bytes, files, limits);
    auto* imported = std::get_if<ImportedMesh>(&result);
    if (!imported) return result;
    if (imported->mesh.triangles.empty())
        return ImportFault{"no_triangles",
                           "the file was read as " + imported->format + " and has no triangles"};
    if (auto fault = validate_mesh(imported->mesh))
        return ImportFault{std::move(fault->code), std::move(fault->detail)};
    keep_closed_glass(imported->mesh, imported->notes);
    imported->opened_files = files.opened();
    return result;
}

} // namespace renderer
