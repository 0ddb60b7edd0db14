#include "server/store/blob_reader.h"

#include <algorithm>
#include <cerrno>
#include <unistd.h>
#include <utility>

namespace server {

namespace {

// As many bytes from `offset` on as the buffer has room for, or the file has left.
std::size_t read_at(const FileDescriptor& file,
                    std::uint64_t offset,
                    std::span<std::byte> buffer,
                    const std::filesystem::path& path)
{
    std::size_t filled = 0;
    while (filled < buffer.size()) {
        const ssize_t count = ::pread(
            file.get(), buffer.data() + filled, buffer.size() - filled, static_cast<off_t>(offset + filled));
        if (count < 0 && errno == EINTR) continue;
        if (count < 0 && errno != EIO) throw_io_error("read", path, errno);
        if (count <= 0) break; // the end, or a bad sector: the digest will tell
        filled += static_cast<std::size_t>(count);
    }
    return filled;
}

Sha256::Raw raw_digest_of(std::span<const std::byte> bytes)
{
    Sha256 sha;
    sha.append(bytes);
    return sha.finish_raw();
}

} // namespace

std::shared_ptr<const BlobProof>
prove_blob(const FileDescriptor& file, const std::filesystem::path& path, std::string_view digest)
{
    auto proof = std::make_shared<BlobProof>();
    std::vector<std::byte> buffer(kBlobPiece);
    Sha256 whole;
    for (;;) {
        const std::span<const std::byte> piece(buffer.data(), read_at(file, proof->size, buffer, path));
        if (!piece.empty()) proof->pieces.push_back(raw_digest_of(piece));
        whole.append(piece);
        proof->size += piece.size();
        if (piece.size() < kBlobPiece) break;
    }
    if (whole.finish() != digest) return nullptr;
    return proof;
}

bool have_same_bytes(const FileDescriptor& a, const FileDescriptor& b, const std::filesystem::path& path)
{
    std::vector<std::byte> of_a(kBlobPiece), of_b(kBlobPiece);
    for (std::uint64_t offset = 0;; offset += kBlobPiece) {
        const std::size_t count = read_at(a, offset, of_a, path);
        if (read_at(b, offset, of_b, path) != count ||
            !std::equal(of_a.begin(), of_a.begin() + static_cast<std::ptrdiff_t>(count), of_b.begin()))
            return false;
        if (count < kBlobPiece) return true;
    }
}

BlobReader::BlobReader(FileDescriptor file,
                       std::filesystem::path path,
                       std::shared_ptr<const BlobProof> proof,
                       std::function<DamagedBlob()> damaged)
    : file_(std::move(file)), path_(std::move(path)), proof_(std::move(proof)), damaged_(std::move(damaged))
{
}

std::span<const std::byte> BlobReader::at(std::uint64_t offset)
{
    const std::uint64_t piece = offset / kBlobPiece, begin = piece * kBlobPiece;
    if (piece != held_) {
        held_ = kNone;
        buffer_.resize(static_cast<std::size_t>(std::min<std::uint64_t>(kBlobPiece, proof_->size - begin)));
        const std::size_t filled = read_at(file_, begin, buffer_, path_);
        const bool sound = filled == buffer_.size() && raw_digest_of(buffer_) == proof_->pieces[piece];
        if (!sound) throw damaged_();
        held_ = piece;
    }
    return std::span<const std::byte>(buffer_).subspan(static_cast<std::size_t>(offset - begin));
}

void BlobReader::let_go()
{
    held_ = kNone;
    std::vector<std::byte>().swap(buffer_); // an assignment would keep the memory
}

} // namespace server
