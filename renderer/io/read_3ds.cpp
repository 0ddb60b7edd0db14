#include "renderer/io/read_3ds.h"

#include "renderer/io/assimp_scene.h"
#include "renderer/io/import_bounds.h"
#include "renderer/io/text.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace renderer {

namespace {

using Check = std::optional<ImportFault>;

constexpr std::size_t kChunkHead = 6; // identifier, size with the head

// Identifiers of chunks, as assimp and others list them.
constexpr std::uint16_t kMain = 0x4d4d, kEditor = 0x3d3d, kObject = 0x4000, kTriMesh = 0x4100,
                        kVertices = 0x4110, kFaces = 0x4120, kUvs = 0x4140, kKeyframer = 0xb000,
                        kTrackObject = 0xb002, kTrackHead = 0xb010, kTrackId = 0xb030;

class ThreeDsCheck {
public:
    ThreeDsCheck(std::string_view bytes, const Limits& limits) : bytes_(bytes), limits_(limits) {}

    Check run()
    {
        if (bytes_.size() < kChunkHead) return fault("truncated", 0, "a 3DS has at least six bytes");
        if (size_at(0) > bytes_.size())
            return fault("truncated",
                         0,
                         "the file promises " + std::to_string(size_at(0)) + " bytes and has " +
                             std::to_string(bytes_.size()) + ": send it whole");
        if (Check bad = chunks(0, bytes_.size(), 0)) return bad;
        return check_tracks();
    }

private:
    static ImportFault fault(std::string code, std::size_t at, const std::string& what)
    {
        return {std::move(code), "byte " + std::to_string(at) + " of the 3DS: " + what};
    }
    std::uint32_t number(std::size_t at, std::size_t size) const
    {
        std::uint32_t value = 0;
        for (std::size_t i = 0; i < size; ++i)
            value |= std::uint32_t(static_cast<unsigned char>(bytes_[at + i])) << (8 * i);
        return value;
    }
    std::uint16_t word(std::size_t at) const { return static_cast<std::uint16_t>(number(at, 2)); }
    std::uint32_t size_at(std::size_t chunk) const { return number(chunk + 2, 4); }
    // Behind the name, which ends with a zero; `end` if it does not.
    std::size_t past_name(std::size_t at, std::size_t end) const
    {
        const std::size_t zero = bytes_.find('\0', at);
        return zero < end ? zero + 1 : end;
    }

    Check chunks(std::size_t begin, std::size_t end, int level);
    Check inside(std::uint16_t chunk, std::size_t begin, std::size_t end, int level);
    Check counted(std::size_t begin, std::size_t end, std::size_t each, const char* what);
    Check floats(std::size_t begin, std::size_t end, std::size_t each, const char* what);
    Check faces(std::size_t begin, std::size_t end);
    Check end_mesh();
    Check check_tracks() const;

    struct Track {
        std::uint16_t id, parent;
    };
    static constexpr std::uint16_t kNoParent = 0xffff;

    std::string_view bytes_;
    const Limits& limits_;
    std::uint64_t vertices_ = 0, triangles_ = 0;
    std::uint16_t largest_ = 0; // index of the mesh at hand
    std::size_t largest_at_ = 0;
    std::vector<Track> tracks_;
};

Check ThreeDsCheck::counted(std::size_t begin, std::size_t end, std::size_t each, const char* what)
{
    if (end - begin < 2 || std::size_t{word(begin)} * each > end - begin - 2)
        return fault("truncated", begin, std::string(what) + " pass the end of their chunk");
    return std::nullopt;
}

Check ThreeDsCheck::floats(std::size_t begin, std::size_t end, std::size_t each, const char* what)
{
    if (Check bad = counted(begin, end, each * sizeof(float), what)) return bad;
    for (std::size_t i = 0; i < word(begin) * each; ++i)
        if (!std::isfinite(std::bit_cast<float>(number(begin + 2 + 4 * i, 4))))
            return fault(
                "non_finite", begin + 2 + 4 * i, std::string("a number of ") + what + " is not finite");
    return std::nullopt;
}

Check ThreeDsCheck::faces(std::size_t begin, std::size_t end)
{
    constexpr std::size_t kEach = 8; // three indices, flags
    if (Check bad = counted(begin, end, kEach, "faces")) return bad;
    const std::size_t count = word(begin);
    for (std::size_t i = 0; i < count; ++i)
        for (std::size_t k = 0; k < 3; ++k) {
            const std::size_t at = begin + 2 + i * kEach + 2 * k;
            if (word(at) < largest_) continue;
            largest_ = word(at);
            largest_at_ = at;
        }
    triangles_ += count;
    if (triangles_ > limits_.triangles) return over_triangle_limit(triangles_, limits_, true);
    return chunks(begin + 2 + count * kEach, end, 4); // materials, smoothing
}

Check ThreeDsCheck::end_mesh()
{
    if (largest_at_ != 0 && largest_ >= vertices_)
        return fault("index_out_of_range",
                     largest_at_,
                     "a face names vertex " + std::to_string(largest_) + "; its mesh has " +
                         std::to_string(vertices_));
    vertices_ = 0;
    largest_ = 0;
    largest_at_ = 0;
    return std::nullopt;
}

Check ThreeDsCheck::inside(std::uint16_t chunk, std::size_t begin, std::size_t end, int level)
{
    switch (chunk) {
    case kMain:
    case kEditor:
    case kKeyframer:
        return chunks(begin, end, level + 1);
    case kTrackObject:
        tracks_.push_back({kNoParent, kNoParent});
        return chunks(begin, end, level + 1);
    case kObject:
        return chunks(past_name(begin, end), end, level + 1);
    case kTriMesh:
        if (Check bad = chunks(begin, end, level + 1)) return bad;
        return end_mesh();
    case kVertices:
        if (Check bad = floats(begin, end, 3, "vertices")) return bad;
        vertices_ = word(begin);
        return std::nullopt;
    case kUvs:
        return floats(begin, end, 2, "texture coordinates");
    case kFaces:
        return faces(begin, end);
    case kTrackId:
        if (end - begin >= 2 && !tracks_.empty()) tracks_.back().id = word(begin);
        return std::nullopt;
    case kTrackHead: {
        const std::size_t flags = past_name(begin, end);
        if (end - flags >= 6 && !tracks_.empty()) tracks_.back().parent = word(flags + 4);
        return std::nullopt;
    }
    default:
        return std::nullopt; // materials and what else does no harm where its size is right
    }
}

Check ThreeDsCheck::chunks(std::size_t begin, std::size_t end, int level)
{
    constexpr int kDeepest = 16;
    if (level > kDeepest) return fault("malformed", begin, "chunks within chunks without end");
    for (std::size_t at = begin; at < end;) {
        if (end - at < kChunkHead) return std::nullopt; // padding
        const std::uint32_t size = size_at(at);
        if (size < kChunkHead) return fault("malformed", at, "a chunk that is shorter than its head");
        if (size > end - at)
            return fault("truncated",
                         at,
                         "a chunk of " + std::to_string(size) + " bytes passes the end of what holds it");
        if (Check bad = inside(word(at), at + kChunkHead, at + size, level)) return bad;
        at += size;
    }
    return std::nullopt;
}

// A node's parent is the number of another; who follows them must come to an end.
Check ThreeDsCheck::check_tracks() const
{
    std::vector<std::uint16_t> parents(std::size_t{kNoParent} + 1, kNoParent);
    for (const Track& track : tracks_)
        if (track.id != kNoParent) parents[track.id] = track.parent;
    for (const Track& track : tracks_) {
        std::size_t steps = 0;
        for (std::uint16_t node = track.parent; node != kNoParent; node = parents[node])
            if (node == track.id || ++steps > tracks_.size())
                return ImportFault{"malformed",
                                   "node " + std::to_string(track.id) +
                                       " of the 3DS is its own ancestor: nodes must form trees"};
    }
    return std::nullopt;
}

} // namespace

// "MM" is also how a TIFF begins; there a 0 and a 42 follow.
bool is_3ds(std::string_view bytes)
{
    if (bytes.size() < 2 * kChunkHead || !bytes.starts_with("MM")) return false;
    const auto next = static_cast<unsigned char>(bytes[kChunkHead + 1]); // of the first chunk inside
    return !(bytes[2] == '\0' && bytes[3] == '*') && (next == 0x00 || next == 0x3d || next == 0xb0);
}

ImportResult read_3ds(std::span<const std::byte> bytes, CompanionFiles& files, const Limits& limits)
{
    if (auto bad = ThreeDsCheck(text_of(bytes), limits).run()) return std::move(*bad);
    return read_with_assimp(
        {.format = "3ds", .importer = "Discreet 3DS", .title = "3DS"}, bytes, files, limits);
}

} // namespace renderer
