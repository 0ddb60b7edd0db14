#include "renderer/io/read_gltf.h"

#include "renderer/io/flatten_scene.h"
#include "renderer/io/gltf_buffers.h"
#include "renderer/io/gltf_outline.h"
#include "renderer/io/gltf_tree.h"
#include "renderer/io/import_bounds.h"
#include "renderer/io/text.h"

#include <assimp/BaseImporter.h>
#include <assimp/IOSystem.hpp>
#include <assimp/Importer.hpp>
#include <assimp/MemoryIOWrapper.h>
#include <assimp/importerdesc.h>
#include <assimp/scene.h>

#include <bit>
#include <cstring>
#include <exception>
#include <memory>
#include <string>
#include <string_view>

namespace renderer {

namespace {

// What assimp takes for a file system: the file at hand and its companions, by name.
class GivenFiles : public Assimp::IOSystem {
public:
    GivenFiles(std::string name,
               std::span<const std::byte> bytes,
               CompanionFiles& files,
               std::string& missing)
        : name_(std::move(name)), bytes_(bytes), files_(files), missing_(missing)
    {
    }
    bool Exists(const char* file) const override
    {
        return file == name_ || open_uri(files_, file).has_value();
    }
    char getOsSeparator() const override { return '/'; }
    Assimp::IOStream* Open(const char* file, const char* mode) override
    {
        if (std::string_view(mode).find('w') != std::string_view::npos) return nullptr;
        if (file == name_) return stream(bytes_);
        if (const auto bytes = open_uri(files_, file)) return stream(*bytes);
        missing_ = file;
        return nullptr;
    }
    void Close(Assimp::IOStream* stream) override { delete stream; }

private:
    static Assimp::IOStream* stream(std::span<const std::byte> bytes)
    {
        return new Assimp::MemoryIOStream(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
    }
    std::string name_;
    std::span<const std::byte> bytes_;
    CompanionFiles& files_;
    std::string& missing_;
};

// An Importer comes with 48 readers, most of them with known holes: all but glTF 2 leave.
void keep_only_gltf(Assimp::Importer& importer)
{
    for (std::size_t i = importer.GetImporterCount(); i-- > 0;) {
        const aiImporterDesc* description = importer.GetImporterInfo(i);
        if (description && std::string_view(description->mName).starts_with("glTF2")) continue;
        Assimp::BaseImporter* reader = importer.GetImporter(i);
        importer.UnregisterLoader(reader);
        delete reader;
    }
}

std::optional<ImportFault> check(std::string_view json,
                                 std::optional<std::span<const std::byte>> binary,
                                 CompanionFiles& files,
                                 const Limits& limits)
{
    auto read = read_gltf_outline(json);
    if (auto* fault = std::get_if<ImportFault>(&read)) return std::move(*fault);
    const auto& outline = std::get<GltfOutline>(read);
    if (auto bad = check_gltf_tree(outline)) return bad;
    return check_gltf_buffers(outline, binary, files, limits);
}

ImportFault assimp_fault(const Assimp::Importer& importer, const std::string& missing)
{
    try {
        if (importer.GetException()) std::rethrow_exception(importer.GetException());
    } catch (const std::bad_alloc&) {
        throw;      // memory is not the file's fault; the caller tells it
    } catch (...) { // anything else is what GetErrorString says
    }
    if (!missing.empty())
        return {"missing_file",
                "the glTF names " + quoted(missing) +
                    ", which did not come with it: a job names it in its files"};
    return {"malformed", "the glTF cannot be read: " + clean_utf8(importer.GetErrorString())};
}

ImportResult
read(const std::string& format, std::span<const std::byte> bytes, CompanionFiles& files, const Limits& limits)
{
    std::string missing;
    Assimp::Importer importer;
    keep_only_gltf(importer);
    importer.SetIOHandler(new GivenFiles("mesh." + format, bytes, files, missing)); // the importer owns it
    const aiScene* scene = importer.ReadFile("mesh." + format, 0);
    if (!scene || !missing.empty()) return assimp_fault(importer, missing);
    if (!scene->mRootNode) return ImportFault{"no_triangles", "the glTF has no nodes"};
    ImportedMesh result;
    result.format = format;
    if (auto bad = flatten_scene(*scene, limits, result)) return std::move(*bad);
    return result;
}

std::uint32_t word_at(std::span<const std::byte> bytes, std::size_t offset)
{
    std::uint32_t word = 0;
    for (std::size_t i = 0; i < 4; ++i)
        word |= std::to_integer<std::uint32_t>(bytes[offset + i]) << (8 * i);
    return word;
}

} // namespace

ImportResult read_gltf(std::span<const std::byte> bytes, CompanionFiles& files, const Limits& limits)
{
    if (auto bad = check(text_of(bytes), std::nullopt, files, limits)) return std::move(*bad);
    return read("gltf", bytes, files, limits);
}

// 12 bytes of header, then chunks of (length, type, bytes): the first is the JSON.
ImportResult read_glb(std::span<const std::byte> bytes, CompanionFiles& files, const Limits& limits)
{
    constexpr std::uint32_t kJson = 0x4e4f534a, kBinary = 0x004e4942;
    if (bytes.size() < 20)
        return ImportFault{"truncated",
                           "a GLB has at least 20 bytes, this file has " + std::to_string(bytes.size())};
    const std::uint32_t version = word_at(bytes, 4);
    if (version != 2)
        return ImportFault{version == 1 ? "unsupported" : "malformed",
                           "byte 4: GLB version " + std::to_string(version) + "; 2 is read"};
    const std::uint64_t length = word_at(bytes, 8), json_length = word_at(bytes, 12);
    if (length != bytes.size())
        return ImportFault{bytes.size() < length ? "truncated" : "malformed",
                           "the GLB's header promises " + std::to_string(length) + " bytes, the file has " +
                               std::to_string(bytes.size())};
    if (word_at(bytes, 16) != kJson)
        return ImportFault{"malformed", "byte 16: the GLB's first chunk is not JSON"};
    if (json_length > bytes.size() - 20)
        return ImportFault{"malformed",
                           "byte 12: the GLB's JSON chunk of " + std::to_string(json_length) +
                               " bytes passes its end"};
    std::optional<std::span<const std::byte>> binary;
    for (std::size_t at = 20 + json_length; at < bytes.size();) {
        if (bytes.size() - at < 8 || word_at(bytes, at) > bytes.size() - at - 8)
            return ImportFault{"malformed",
                               "byte " + std::to_string(at) + ": a chunk of the GLB passes its end"};
        const std::size_t size = word_at(bytes, at);
        if (!binary && word_at(bytes, at + 4) == kBinary) binary = bytes.subspan(at + 8, size);
        at += 8 + size;
    }
    const auto json = bytes.subspan(20, json_length);
    if (auto bad = check(text_of(json), binary, files, limits)) return std::move(*bad);
    // Without a binary chunk assimp takes the first buffer for an empty one, whatever its URI holds.
    ImportResult result = binary ? read("glb", bytes, files, limits) : read("gltf", json, files, limits);
    if (auto* mesh = std::get_if<ImportedMesh>(&result)) mesh->format = "glb";
    return result;
}

} // namespace renderer
