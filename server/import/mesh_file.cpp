#include "server/import/mesh_file.h"

#include "server/import/flat_mesh.h"
#include "server/import/mesh_figures.h"
#include "server/store/sha256.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cstring>
#include <fcntl.h>
#include <unistd.h>
#include <utility>

namespace server {

namespace {

using Bytes = std::span<const std::byte>;

constexpr std::array<char, 8> kMagic{'H', 'E', 'L', 'I', 'O', 'P', 'R', 'P'};
constexpr std::size_t kPiece = 1u << 20, kPage = 4096, kMostArrays = 4;
constexpr std::size_t kMostHeadBytes = 64u << 20;

struct Head {
    std::array<char, 8> magic = kMagic;
    std::uint64_t answers_bytes = 0, tree_head_bytes = 0, flat_bytes = 0, body_bytes = 0;
    std::array<std::uint64_t, kMostArrays> array_bytes{};
    Sha256::Raw proof{}; // of all that stands before the body, with zeros here
};
static_assert(std::is_trivially_copyable_v<Head>);

constexpr std::uint64_t rounded_up(std::uint64_t value, std::uint64_t to)
{
    return (value + to - 1) / to * to;
}

std::uint64_t pieces_of(std::uint64_t body_bytes)
{
    return (body_bytes + kPiece - 1) / kPiece;
}

std::uint64_t head_bytes(const Head& head)
{
    return sizeof head + head.answers_bytes + head.tree_head_bytes +
           pieces_of(head.body_bytes) * sizeof(Sha256::Raw);
}

Sha256::Raw digest(Bytes bytes)
{
    Sha256 sha;
    sha.append(bytes);
    return sha.finish_raw();
}

std::string text_of(const NamedDigests& answers)
{
    std::string text;
    for (const auto& [name, answer] : answers)
        (((text += name) += '\0') += answer) += '\0';
    return text;
}

// False where the text is not of text_of().
bool read_answers(std::string_view text, NamedDigests& answers)
{
    while (!text.empty()) {
        std::array<std::string, 2> words;
        for (std::string& word : words) {
            const std::size_t end = text.find('\0');
            if (end == text.npos) return false;
            word = text.substr(0, end);
            text.remove_prefix(end + 1);
        }
        answers.emplace(std::move(words[0]), std::move(words[1]));
    }
    return true;
}

// The body on its way to the file: a digest of every piece, and the disk kept busy meanwhile rather than at
// the sync, which others wait for.
class BodyWriter {
public:
    BodyWriter(const FileDescriptor& file, const std::filesystem::path& path, std::stop_token stop)
        : file_(file), path_(path), stop_(std::move(stop))
    {
    }
    bool append(Bytes bytes)
    {
        while (!bytes.empty() && !stop_.stop_requested()) {
            const Bytes some = bytes.first(std::min(bytes.size(), kPiece - filled_));
            write_all(file_, some, path_);
            sha_->append(some);
            filled_ += some.size();
            bytes = bytes.subspan(some.size());
            if (filled_ == kPiece) end_piece();
        }
        return bytes.empty();
    }
    std::vector<Sha256::Raw> finish()
    {
        if (filled_ > 0) end_piece();
        return std::move(digests_);
    }

private:
    void end_piece()
    {
        digests_.push_back(sha_->finish_raw());
        sha_.emplace();
        filled_ = 0;
        ::sync_file_range(file_.get(), 0, 0, SYNC_FILE_RANGE_WRITE);
    }

    const FileDescriptor& file_;
    const std::filesystem::path& path_;
    std::stop_token stop_;
    std::optional<Sha256> sha_{std::in_place};
    std::size_t filled_ = 0;
    std::vector<Sha256::Raw> digests_;
};

// After so many bytes, up to where an array may lie.
bool pad(BodyWriter& body, std::uint64_t bytes)
{
    constexpr std::array<std::byte, renderer::TreeBytes::kAlignment> kZeros{};
    return body.append(Bytes(kZeros).first(rounded_up(bytes, kZeros.size()) - bytes));
}

// What write_flat() takes; the arrays are lent ones, of which this copies none.
ImportOutcome asset_of(const KnownImport& known, const renderer::PreparedMesh& prepared)
{
    return ImportedAsset{mesh_of(prepared), known.figures->format, known.figures->notes};
}

std::uint64_t flat_bytes(const ImportOutcome& asset)
{
    std::uint64_t bytes = 0;
    write_flat(asset, [&](Bytes some) { bytes += some.size(); });
    return bytes;
}

bool is_proven(Bytes body, const std::byte* proofs, renderer::ThreadPool& pool)
{
    std::atomic<bool> sound{true};
    pool.run(pieces_of(body.size()), [&](std::size_t piece, unsigned) {
        if (!sound.load(std::memory_order_relaxed)) return;
        const Bytes bytes = body.subspan(piece * kPiece, std::min(kPiece, body.size() - piece * kPiece));
        const Sha256::Raw found = digest(bytes);
        if (std::memcmp(found.data(), proofs + piece * sizeof found, sizeof found) != 0)
            sound.store(false, std::memory_order_relaxed);
    });
    return sound;
}

// A head that is sound and promises just what the file has.
std::optional<Head> read_head(Bytes file)
{
    Head head;
    if (file.size() < sizeof head) return std::nullopt;
    std::memcpy(&head, file.data(), sizeof head);
    if (head.magic != kMagic) return std::nullopt;
    for (const std::uint64_t size : {head.answers_bytes, head.tree_head_bytes})
        if (size > kMostHeadBytes) return std::nullopt;
    if (head.body_bytes > file.size() || head_bytes(head) > file.size()) return std::nullopt;
    if (rounded_up(head_bytes(head), kPage) + head.body_bytes != file.size()) return std::nullopt;
    Sha256 sha;
    Head without = head;
    without.proof = {};
    sha.append(std::as_bytes(std::span(&without, 1)));
    sha.append(file.subspan(sizeof head, head_bytes(head) - sizeof head));
    if (sha.finish_raw() != head.proof) return std::nullopt;
    return head;
}

bool answers_agree(const NamedDigests& answers, const NamedDigests& files)
{
    return std::all_of(answers.begin(), answers.end(), [&](const auto& answer) {
        const auto file = files.find(answer.first);
        return answer.second == (file == files.end() ? std::string() : file->second);
    });
}

} // namespace

bool write_mesh_file(const FileDescriptor& file,
                     const std::filesystem::path& path,
                     const KnownImport& known,
                     renderer::MeshTree tree,
                     const std::stop_token& stop)
{
    const renderer::PreparedMesh& prepared = *known.prepared[static_cast<std::size_t>(tree)];
    const ImportOutcome asset = asset_of(known, prepared);
    const renderer::TreeBytes kept = renderer::tree_bytes(prepared);
    const std::string answers = text_of(known.answers);
    Head head;
    head.answers_bytes = answers.size();
    head.tree_head_bytes = kept.head.size();
    head.flat_bytes = flat_bytes(asset);
    head.body_bytes = rounded_up(head.flat_bytes, renderer::TreeBytes::kAlignment);
    for (std::size_t i = 0; i < kept.arrays.size(); ++i) {
        head.array_bytes.at(i) = kept.arrays[i].size();
        head.body_bytes += rounded_up(kept.arrays[i].size(), renderer::TreeBytes::kAlignment);
    }
    const std::uint64_t body_at = rounded_up(head_bytes(head), kPage);
    if (::lseek(file.get(), static_cast<off_t>(body_at), SEEK_SET) < 0)
        throw_io_error("seek in", path, errno);
    BodyWriter body(file, path, stop);
    bool whole = true;
    write_flat(asset, [&](Bytes bytes) { whole = whole && body.append(bytes); });
    whole = whole && pad(body, head.flat_bytes);
    for (const Bytes array : kept.arrays)
        whole = whole && body.append(array) && pad(body, array.size());
    if (!whole) return false;
    const std::vector<Sha256::Raw> proofs = body.finish();
    Sha256 sha;
    for (const Bytes part : {std::as_bytes(std::span(&head, 1)),
                             std::as_bytes(std::span(answers)),
                             Bytes(kept.head),
                             std::as_bytes(std::span(proofs))})
        sha.append(part);
    head.proof = sha.finish_raw();
    if (::lseek(file.get(), 0, SEEK_SET) < 0) throw_io_error("seek in", path, errno);
    for (const Bytes part : {std::as_bytes(std::span(&head, 1)),
                             std::as_bytes(std::span(answers)),
                             Bytes(kept.head),
                             std::as_bytes(std::span(proofs))})
        write_all(file, part, path);
    sync_file(file, path);
    return true;
}

std::variant<std::monostate, KnownImport, MeshFileFault> read_mesh_file(const MappedBytes& file,
                                                                        const std::string& main,
                                                                        const NamedDigests& files,
                                                                        renderer::MeshTree tree,
                                                                        renderer::ThreadPool& pool)
{
    const std::optional<Head> head = read_head(file.bytes);
    if (!head) return MeshFileFault{"its head is not sound"};
    KnownImport known;
    known.main = main;
    Bytes rest = file.bytes.subspan(sizeof *head);
    const auto take = [&rest](std::uint64_t size) {
        const Bytes taken = rest.first(size);
        rest = rest.subspan(size);
        return taken;
    };
    const Bytes answers = take(head->answers_bytes), tree_head = take(head->tree_head_bytes);
    if (!read_answers({reinterpret_cast<const char*>(answers.data()), answers.size()}, known.answers))
        return MeshFileFault{"its answers are not sound"};
    if (!answers_agree(known.answers, files)) return std::monostate();
    const Bytes body = file.bytes.last(head->body_bytes);
    if (!is_proven(body, rest.data(), pool)) return MeshFileFault{"its bytes are not what they were"};

    rest = body;
    const auto take_padded = [&](std::uint64_t size) -> std::optional<Bytes> {
        if (rounded_up(size, renderer::TreeBytes::kAlignment) > rest.size()) return std::nullopt;
        return take(rounded_up(size, renderer::TreeBytes::kAlignment)).first(size);
    };
    const auto flat = take_padded(head->flat_bytes);
    renderer::TreeBytes kept{{tree_head.begin(), tree_head.end()}, {}};
    for (const std::uint64_t size : head->array_bytes) {
        const auto array = take_padded(size);
        if (!array) return MeshFileFault{"its parts do not fit"};
        kept.arrays.push_back(*array);
    }
    if (!flat) return MeshFileFault{"its parts do not fit"};
    ImportOutcome outcome = read_flat({*flat, file.keeper}, renderer::Limits::none());
    auto* asset = std::get_if<ImportedAsset>(&outcome);
    if (!asset) return MeshFileFault{"its mesh is not sound"};
    known.figures = mesh_figures(*asset);
    auto& prepared = known.prepared[static_cast<std::size_t>(tree)];
    prepared = renderer::prepared_from(std::move(asset->mesh), kept, file.keeper);
    if (!prepared) return MeshFileFault{"its tree is not sound"};
    return known;
}

} // namespace server
