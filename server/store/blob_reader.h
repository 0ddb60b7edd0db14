// BlobReader: a blob's bytes a piece at a time, each proven before it is handed out.
//
// Proof    A blob's name is the digest of the whole, against which no part can be held. So the first open of a
//          blob in a process reads its file through, holds the whole against the name and notes a digest of
//          each piece; from then on each piece is held against its own whenever it is read. Two cheaper ways
//          are not enough: size and time of modification stay as they are when a disk loses a bit; and a
//          whole that is hashed on its way out is known to be wrong only after most of it has gone, a range
//          never.
// Memory   one piece a reader, none after let_go(); 32 bytes a piece of a blob that was opened.
// Cost     first open: the file is read and hashed twice over. Then only the pieces that are asked for are.
// Threads  one at a time. The file stays readable when the blob is removed.
// Errors   DamagedBlob: a piece that is not what it was, named by its blob, which counts as missing from then
//          on; StoreError: a file that cannot be read.
#pragma once

#include "server/store/damaged_blob.h"
#include "server/store/file_io.h"
#include "server/store/sha256.h"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

namespace server {

inline constexpr std::size_t kBlobPiece = 256 << 10;

// Of a file that was found to be what its name says.
struct BlobProof {
    std::uint64_t size = 0;
    std::vector<Sha256::Raw> pieces; // the last one of what is left
};

// Reads the whole file. Nothing: its bytes are not those of `digest`.
std::shared_ptr<const BlobProof>
prove_blob(const FileDescriptor& file, const std::filesystem::path& path, std::string_view digest);

// The same, a piece at a time: whether two files hold the same bytes.
bool have_same_bytes(const FileDescriptor& a, const FileDescriptor& b, const std::filesystem::path& path);

class BlobReader {
public:
    // `damaged` is called when a piece does not hold; at() throws what it returns.
    BlobReader(FileDescriptor file,
               std::filesystem::path path,
               std::shared_ptr<const BlobProof> proof,
               std::function<DamagedBlob()> damaged);

    std::uint64_t size() const { return proof_->size; }
    // From `offset`, which is less than size(), to the end of its piece; good until the next call.
    std::span<const std::byte> at(std::uint64_t offset);
    void let_go(); // of the piece in memory, which the next at() reads and proves anew

private:
    static constexpr std::uint64_t kNone = ~std::uint64_t{0};

    FileDescriptor file_;
    std::filesystem::path path_;
    std::shared_ptr<const BlobProof> proof_;
    std::function<DamagedBlob()> damaged_;
    std::vector<std::byte> buffer_;
    std::uint64_t held_ = kNone; // the piece that the buffer holds
};

} // namespace server
