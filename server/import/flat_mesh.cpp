#include "server/import/flat_mesh.h"

#include "api/words/limit_words.h"
#include "renderer/geometry/validate_mesh.h"
#include "server/import/allowance.h"

#include <array>
#include <cstring>
#include <optional>
#include <type_traits>
#include <utility>

namespace server {

namespace {

constexpr std::array<char, 8> kMagic{'H', 'E', 'L', 'I', 'O', 'M', 'S', 'H'};
constexpr std::uint32_t kLongestText = 4096;
constexpr std::uint64_t kMostTextBytes = 32u << 20; // an entry of four bytes may take 32 in memory

enum class Kind : std::uint32_t { mesh, failure };

struct Head {
    std::array<char, 8> magic = kMagic;
    std::uint32_t version = kImporterVersion;
    Kind kind = Kind::mesh;
    std::uint64_t positions = 0, normals = 0, uvs = 0, triangles = 0, triangle_materials = 0;
    std::uint64_t text_bytes = 0;
    std::uint64_t residuals = 0;
    renderer::Vec3d origin{};
};
static_assert(std::is_trivially_copyable_v<Head> && sizeof(Head) == 96);

// The arrays, in the order of the file, each with the member of Head that counts it.
template <typename Visit>
void for_each_array(Head& head, auto& mesh, Visit visit)
{
    visit(head.positions, mesh.positions);
    visit(head.residuals, mesh.residuals);
    visit(head.normals, mesh.normals);
    visit(head.uvs, mesh.uvs);
    visit(head.triangles, mesh.triangles);
    visit(head.triangle_materials, mesh.triangle_materials);
}

class TextWriter {
public:
    template <typename T>
    requires std::is_arithmetic_v<T>
    void add(T value) { bytes_.append(reinterpret_cast<const char*>(&value), sizeof value); }
    void add(renderer::Rgb color)
    {
        add(color.r);
        add(color.g);
        add(color.b);
    }
    void add(const std::string& text)
    {
        const auto size = static_cast<std::uint32_t>(std::min<std::size_t>(text.size(), kLongestText));
        add(size);
        bytes_.append(text, 0, size);
    }
    template <typename T>
    void add(const std::vector<T>& list)
    {
        add(static_cast<std::uint32_t>(list.size()));
        for (const T& entry : list)
            add(entry);
    }
    void add(const renderer::MeshMaterial& m)
    {
        add(m.name);
        add(m.diffuse);
        add(m.specular);
        add(m.shininess);
        add(m.textures);
        for (const bool is : {m.emits, m.is_transparent, m.is_metal, m.has_roughness})
            add(static_cast<std::uint8_t>(is));
    }
    void add(const renderer::MeshPart& p)
    {
        add(p.name);
        add(p.first_triangle);
        add(p.triangle_count);
    }
    std::span<const std::byte> bytes() const { return std::as_bytes(std::span(bytes_)); }

private:
    std::string bytes_;
};

// Every take() returns false, and takes nothing more, once the bytes do not hold what is asked for.
class TextReader {
public:
    explicit TextReader(std::span<const std::byte> bytes) : rest_(bytes) {}

    template <typename T>
    requires std::is_arithmetic_v<T>
    bool take(T& value)
    {
        if (rest_.size() < sizeof value) return false;
        std::memcpy(&value, rest_.data(), sizeof value);
        rest_ = rest_.subspan(sizeof value);
        return true;
    }
    bool take_flag(bool& flag)
    {
        std::uint8_t byte = 0;
        if (!take(byte) || byte > 1) return false;
        flag = byte == 1;
        return true;
    }
    bool take(renderer::Rgb& color) { return take(color.r) && take(color.g) && take(color.b); }
    bool take(std::string& text)
    {
        std::uint32_t size = 0;
        if (!take(size) || size > kLongestText || size > rest_.size()) return false;
        text.assign(reinterpret_cast<const char*>(rest_.data()), size);
        rest_ = rest_.subspan(size);
        return is_utf8(text);
    }
    template <typename T>
    bool take(std::vector<T>& list)
    {
        std::uint32_t size = 0;
        if (!take(size) || size > rest_.size()) return false; // each entry takes a byte at least
        for (std::uint32_t i = 0; i < size; ++i)
            if (!take(list.emplace_back())) return false;
        return true;
    }
    bool take(renderer::MeshMaterial& m)
    {
        return take(m.name) && take(m.diffuse) && take(m.specular) && take(m.shininess) && take(m.textures) &&
               take_flag(m.emits) && take_flag(m.is_transparent) && take_flag(m.is_metal) &&
               take_flag(m.has_roughness);
    }
    bool take(renderer::MeshPart& p)
    {
        return take(p.name) && take(p.first_triangle) && take(p.triangle_count);
    }
    bool at_end() const { return rest_.empty(); }

private:
    std::span<const std::byte> rest_;
};

TextWriter texts_of(const ImportOutcome& outcome)
{
    TextWriter texts;
    if (const auto* failure = std::get_if<ImportFailure>(&outcome)) {
        texts.add(failure->code);
        texts.add(failure->detail);
        return texts;
    }
    const auto& asset = std::get<ImportedAsset>(outcome);
    texts.add(asset.format);
    texts.add(asset.notes);
    texts.add(asset.mesh.materials);
    texts.add(asset.mesh.parts);
    return texts;
}

Head head_of(const ImportOutcome& outcome, std::uint64_t text_bytes)
{
    Head head;
    head.text_bytes = text_bytes;
    const auto* asset = std::get_if<ImportedAsset>(&outcome);
    if (asset == nullptr) {
        head.kind = Kind::failure;
        return head;
    }
    head.origin = asset->mesh.origin;
    for_each_array(head, asset->mesh, [](std::uint64_t& count, const auto& array) { count = array.size(); });
    return head;
}

ImportFailure unsound(const std::string& what)
{
    return {"import_crashed", "the importer's answer is not sound (" + what + "); the mesh is likely broken"};
}

// What the head promises, if it fits 64 bits and these bytes.
bool is_exact(Head& head, std::uint64_t available)
{
    renderer::Mesh empty;
    std::uint64_t left = available - sizeof(Head);
    bool fits = head.text_bytes <= left && head.text_bytes <= kMostTextBytes;
    if (fits) left -= head.text_bytes;
    for_each_array(head, empty, [&](std::uint64_t& count, const auto& array) {
        constexpr std::size_t kEach = sizeof(typename std::remove_reference_t<decltype(array)>::value_type);
        fits = fits && count <= left / kEach;
        if (fits) left -= count * kEach;
    });
    return fits && left == 0;
}

ImportOutcome read_mesh(Head head, const MappedBytes& flat, const renderer::Limits& limits)
{
    if (head.triangles > limits.triangles)
        return ImportFailure{"over_limit",
                             std::to_string(head.triangles) + " triangles, the limit is " +
                                 std::to_string(limits.triangles) + " (" + api::flag_of("triangles") + ")"};
    ImportedAsset asset;
    asset.mesh.origin = head.origin;
    std::size_t at = sizeof(Head);
    for_each_array(head, asset.mesh, [&](std::uint64_t count, auto& array) {
        using Value = typename std::remove_reference_t<decltype(array)>::value_type;
        // Every array begins at a multiple of its numbers' size: they are of 4 bytes, the last of 2.
        const auto* values = reinterpret_cast<const Value*>(flat.bytes.data() + at);
        if (count) array = renderer::Array<Value>::lent({values, count}, flat.keeper);
        at += count * sizeof(Value);
    });
    TextReader texts(flat.bytes.subspan(at));
    if (!texts.take(asset.format) || !texts.take(asset.notes) || !texts.take(asset.mesh.materials) ||
        !texts.take(asset.mesh.parts) || !texts.at_end())
        return unsound("its texts cannot be read");
    if (const auto fault = renderer::validate_mesh(asset.mesh)) return unsound(fault->detail);
    return asset;
}

ImportOutcome read_failure(const Head& head, std::span<const std::byte> bytes)
{
    TextReader texts(bytes.subspan(sizeof(Head)));
    ImportFailure failure;
    if (head.text_bytes != bytes.size() - sizeof(Head) || !texts.take(failure.code) ||
        !texts.take(failure.detail) || !texts.at_end() || failure.code.empty())
        return unsound("its failure cannot be read");
    return failure;
}

} // namespace

ImportOutcome within_flat_bounds(ImportOutcome outcome, const renderer::Limits& limits)
{
    const std::uint64_t text_bytes = texts_of(outcome).bytes().size();
    std::uint64_t bytes = sizeof(Head) + text_bytes;
    Head head;
    if (const auto* asset = std::get_if<ImportedAsset>(&outcome))
        for_each_array(head, asset->mesh, [&](std::uint64_t&, const auto& array) {
            bytes += array.size() * sizeof(*array.data());
        });
    if (bytes > limits.import_output_bytes)
        return ImportFailure{"over_limit",
                             "the mesh takes " + std::to_string(bytes) +
                                 " bytes when imported, the limit is " +
                                 std::to_string(limits.import_output_bytes) + " (" +
                                 allowance_words("import_output_bytes") + ")"};
    if (text_bytes > kMostTextBytes)
        return ImportFailure{"over_limit",
                             "names of parts, materials and textures take " + std::to_string(text_bytes) +
                                 " bytes, at most " + std::to_string(kMostTextBytes) + " can be taken"};
    return outcome;
}

void write_flat(const ImportOutcome& outcome, const ByteSink& sink)
{
    const TextWriter texts = texts_of(outcome);
    Head head = head_of(outcome, texts.bytes().size());
    sink(std::as_bytes(std::span(&head, 1)));
    if (const auto* asset = std::get_if<ImportedAsset>(&outcome))
        for_each_array(head, asset->mesh, [&](std::uint64_t&, const auto& array) {
            sink(std::as_bytes(std::span(array)));
        });
    sink(texts.bytes());
}

ImportOutcome read_flat(const MappedBytes& flat, const renderer::Limits& limits)
{
    const std::span<const std::byte> bytes = flat.bytes;
    Head head;
    if (bytes.size() < sizeof head) return unsound("it is too short");
    std::memcpy(&head, bytes.data(), sizeof head);
    if (head.magic != kMagic || head.version != kImporterVersion) return unsound("it is of another version");
    if (!is_exact(head, bytes.size())) return unsound("its size is not what it promises");
    if (head.kind == Kind::failure) return read_failure(head, bytes);
    if (head.kind == Kind::mesh) return read_mesh(head, flat, limits);
    return unsound("its kind is unknown");
}

bool is_utf8(std::string_view text)
{
    const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
    for (std::size_t at = 0; at < text.size();) {
        const unsigned first = byte(at);
        const std::size_t length = first < 0x80   ? 1
                                   : first < 0xc2 ? 0
                                   : first < 0xe0 ? 2
                                   : first < 0xf0 ? 3
                                   : first < 0xf5 ? 4
                                                  : 0;
        if (length == 0 || text.size() - at < length) return false;
        for (std::size_t i = 1; i < length; ++i)
            if ((byte(at + i) & 0xc0u) != 0x80u) return false;
        const unsigned second = length > 1 ? byte(at + 1) : 0;
        if ((first == 0xe0 && second < 0xa0) || (first == 0xed && second > 0x9f))
            return false; // overlong, surrogate
        if ((first == 0xf0 && second < 0x90) || (first == 0xf4 && second > 0x8f))
            return false; // overlong, beyond
        at += length;
    }
    return true;
}

} // namespace server
