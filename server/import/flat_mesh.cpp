#include "server/import/flat_mesh.h"

#include "api/words/limit_words.h"
#include "renderer/geometry/validate_mesh.h"
#include "server/import/allowance.h"
#include "server/import/flat_texts.h"

#include <array>
#include <cstring>
#include <optional>
#include <type_traits>
#include <utility>

namespace server {

namespace {

constexpr std::array<char, 8> kMagic{'H', 'E', 'L', 'I', 'O', 'M', 'S', 'H'};
constexpr std::uint64_t kMostTextBytes = 32u << 20; // an entry of four bytes may take 32 in memory

enum class Kind : std::uint32_t { mesh, failure, picture };

struct Head {
    std::array<char, 8> magic = kMagic;
    std::uint32_t version = kImporterVersion;
    Kind kind = Kind::mesh;
    std::uint64_t positions = 0, normals = 0, uvs = 0, triangles = 0, triangle_materials = 0;
    std::uint64_t text_bytes = 0;
    std::uint64_t residuals = 0;
    renderer::Vec3d origin{};
    std::uint64_t image_bytes = 0; // of all pictures, each at a multiple of kImageStep
};
static_assert(std::is_trivially_copyable_v<Head> && sizeof(Head) == 104);

// So that their floats, and the arrays behind them, lie where such may lie.
constexpr std::size_t kImageStep = 8;

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

std::uint64_t padded(std::uint64_t bytes)
{
    return (bytes + kImageStep - 1) / kImageStep * kImageStep;
}

// The pictures in the order of the file.
template <typename Visit>
void for_each_image(auto& outcome, Visit visit)
{
    if (auto* const picture = std::get_if<ImportedPicture>(&outcome)) visit(picture->image);
    if (auto* const asset = std::get_if<ImportedAsset>(&outcome))
        for (auto& named : asset->mesh.images)
            visit(named.image);
}

std::uint64_t image_bytes_of(const ImportOutcome& outcome)
{
    std::uint64_t bytes = 0;
    for_each_image(outcome, [&](const renderer::Image& image) { bytes += padded(image.bytes.size()); });
    return bytes;
}

TextWriter texts_of(const ImportOutcome& outcome)
{
    TextWriter texts;
    if (const auto* failure = std::get_if<ImportFailure>(&outcome)) {
        texts.add(failure->code);
        texts.add(failure->detail);
        return texts;
    }
    if (const auto* picture = std::get_if<ImportedPicture>(&outcome)) {
        texts.add(picture->format);
        texts.add(picture->image);
        return texts;
    }
    const auto& asset = std::get<ImportedAsset>(outcome);
    texts.add(asset.format);
    texts.add(asset.notes);
    texts.add(asset.mesh.materials);
    texts.add(asset.mesh.parts);
    texts.add(asset.mesh.images);
    return texts;
}

Head head_of(const ImportOutcome& outcome, std::uint64_t text_bytes)
{
    Head head;
    head.text_bytes = text_bytes;
    head.image_bytes = image_bytes_of(outcome);
    const auto* asset = std::get_if<ImportedAsset>(&outcome);
    if (asset == nullptr) {
        head.kind = std::holds_alternative<ImportFailure>(outcome) ? Kind::failure : Kind::picture;
        return head;
    }
    head.origin = asset->mesh.origin;
    for_each_array(head, asset->mesh, [](std::uint64_t& count, const auto& array) { count = array.size(); });
    return head;
}

ImportFailure unsound(const std::string& what)
{
    return {"import_crashed", "the importer's answer is not sound (" + what + "); the file is likely broken"};
}

// What the head promises, if it fits 64 bits and these bytes.
bool is_exact(Head& head, std::uint64_t available)
{
    renderer::Mesh empty;
    std::uint64_t left = available - sizeof(Head);
    bool fits = head.text_bytes <= left && head.text_bytes <= kMostTextBytes;
    if (fits) left -= head.text_bytes;
    fits = fits && head.image_bytes <= left;
    if (fits) left -= head.image_bytes;
    for_each_array(head, empty, [&](std::uint64_t& count, const auto& array) {
        constexpr std::size_t kEach = sizeof(typename std::remove_reference_t<decltype(array)>::value_type);
        fits = fits && count <= left / kEach;
        if (fits) left -= count * kEach;
    });
    return fits && left == 0;
}

// Each picture's bytes, lent from where they stand; what is wrong with them, if anything is.
std::optional<std::string> lend_images(const Head& head, const MappedBytes& flat, ImportOutcome& outcome)
{
    std::optional<std::string> bad;
    std::uint64_t at = 0;
    for_each_image(outcome, [&](renderer::Image& image) {
        if (bad) return;
        // Sides are judged below: here their product has to fit 64 bits.
        const bool is_sized = image.width < (1u << 25) && image.height < (1u << 25) && image.channels <= 4;
        const std::uint64_t bytes = is_sized ? image.expected_bytes() : 0;
        if (!is_sized || padded(bytes) > head.image_bytes - at) {
            bad = "a picture passes the end of them all";
            return;
        }
        image.bytes =
            renderer::Array<std::byte>::lent(flat.bytes.subspan(sizeof(Head) + at, bytes), flat.keeper);
        at += padded(bytes);
        if (auto unfit = renderer::validate_image(image)) bad = "a picture: " + *unfit;
    });
    if (!bad && at != head.image_bytes) bad = "there are bytes of no picture";
    return bad;
}

ImportFailure over_pixels(const renderer::Image& image, const renderer::Limits& limits)
{
    return {"over_limit",
            std::to_string(image.pixels()) + " pixels, the limit is " +
                std::to_string(limits.texture_pixels) + " (" + api::flag_of("texture_pixels") + ")"};
}

ImportOutcome read_picture(const Head& head, const MappedBytes& flat, const renderer::Limits& limits)
{
    ImportOutcome outcome = ImportedPicture{};
    auto& picture = std::get<ImportedPicture>(outcome);
    TextReader texts(flat.bytes.last(head.text_bytes));
    const bool no_arrays = sizeof(Head) + head.image_bytes + head.text_bytes == flat.bytes.size();
    if (!no_arrays || !texts.take(picture.format) || !texts.take(picture.image) || !texts.at_end())
        return unsound("its texts cannot be read");
    if (const auto bad = lend_images(head, flat, outcome)) return unsound(*bad);
    if (picture.image.pixels() > limits.texture_pixels) return over_pixels(picture.image, limits);
    return outcome;
}

ImportOutcome read_mesh(Head head, const MappedBytes& flat, const renderer::Limits& limits)
{
    if (head.triangles > limits.triangles)
        return ImportFailure{"over_limit",
                             std::to_string(head.triangles) + " triangles, the limit is " +
                                 std::to_string(limits.triangles) + " (" + api::flag_of("triangles") + ")"};
    ImportOutcome outcome = ImportedAsset{};
    auto& asset = std::get<ImportedAsset>(outcome);
    asset.mesh.origin = head.origin;
    std::size_t at = sizeof(Head) + head.image_bytes;
    for_each_array(head, asset.mesh, [&](std::uint64_t count, auto& array) {
        using Value = typename std::remove_reference_t<decltype(array)>::value_type;
        // Every array begins at a multiple of its numbers' size: they are of 4 bytes, the last of 2.
        const auto* values = reinterpret_cast<const Value*>(flat.bytes.data() + at);
        if (count) array = renderer::Array<Value>::lent({values, count}, flat.keeper);
        at += count * sizeof(Value);
    });
    TextReader texts(flat.bytes.subspan(at));
    if (!texts.take(asset.format) || !texts.take(asset.notes) || !texts.take(asset.mesh.materials) ||
        !texts.take(asset.mesh.parts) || !texts.take(asset.mesh.images) || !texts.at_end())
        return unsound("its texts cannot be read");
    if (const auto bad = lend_images(head, flat, outcome)) return unsound(*bad);
    for (const renderer::MeshImage& named : asset.mesh.images)
        if (named.image.pixels() > limits.texture_pixels) return over_pixels(named.image, limits);
    if (const auto fault = renderer::validate_mesh(asset.mesh)) return unsound(fault->detail);
    return outcome;
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
    std::uint64_t bytes = sizeof(Head) + text_bytes + image_bytes_of(outcome);
    Head head;
    if (const auto* asset = std::get_if<ImportedAsset>(&outcome))
        for_each_array(head, asset->mesh, [&](std::uint64_t&, const auto& array) {
            bytes += array.size() * sizeof(*array.data());
        });
    if (bytes > limits.import_output_bytes)
        return ImportFailure{"over_limit",
                             "the file takes " + std::to_string(bytes) +
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
    for_each_image(outcome, [&](const renderer::Image& image) {
        constexpr std::array<std::byte, kImageStep> kZeros{};
        sink(std::span(std::as_const(image.bytes)));
        sink(std::span(kZeros).first(padded(image.bytes.size()) - image.bytes.size()));
    });
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
    if (head.kind == Kind::picture) return read_picture(head, flat, limits);
    return unsound("its kind is unknown");
}

} // namespace server
