// BlobStore: assets and pictures by content: a file a digest, verified when written and when read.
//
// On disk     <folder>/assets/ab/<64 hex digits>, <folder>/results/...; a file's time of modification is its
//             last use.
// Durability  put() and Writer::commit() are durable when they return: temporary file, fsync, rename, fsync of
//             the folder. Many blobs at once are cheaper written without and made durable together. Temporary
//             files that a crash left are removed at open.
// Threads     every function may be called from any thread; a Writer belongs to one thread at a time.
// Errors      StoreError for the world's failures (storage_full told apart); a damaged blob is never served but
//             thrown as DamagedBlob, and counts as missing from then on. Writing it again mends it, also where
//             nobody had noticed. What is not a digest names no blob.
// Cost        a few hundred bytes of memory a blob; has(), size() and total_bytes() do not touch the disk.
#pragma once

#include "server/store/blob_reader.h"
#include "server/store/store.h"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace server {

class BlobStore {
public:
    // Two name spaces: "assets" (uploads, least recently used and unreferenced go first) and "results".
    enum class Kind : std::uint8_t { asset, result };

    explicit BlobStore(const std::filesystem::path& folder);
    ~BlobStore();
    BlobStore(const BlobStore&) = delete;
    BlobStore& operator=(const BlobStore&) = delete;

    // A blob on its way in; forgotten unless committed.
    class Writer {
    public:
        virtual ~Writer() = default;
        virtual void append(std::span<const std::byte> bytes) = 0;
        virtual std::uint64_t bytes() const = 0;
        virtual std::string digest() = 0; // "sha256:<hex>" of what was appended; call once, at the end
        virtual bool commit() = 0;        // false if it was there already
    };
    std::unique_ptr<Writer> write(Kind kind, bool durable = true);
    // `durable` false: no fsync, for what can be made again or is made durable later.
    std::string put(Kind kind, std::span<const std::byte> bytes, bool durable = true);
    // Those of them that are there; one round of syncing for many.
    void make_durable(Kind kind, const std::vector<std::string>& digests);

    bool has(Kind kind, std::string_view digest) const;
    std::optional<std::uint64_t> size(Kind kind, std::string_view digest) const;
    // The bytes, verified against the digest; nothing if there is no such blob.
    std::optional<std::vector<std::byte>> read(Kind kind, std::string_view digest);
    // The same a piece at a time; null if there is no such blob. It must not outlive this store.
    std::unique_ptr<BlobReader> open(Kind kind, std::string_view digest);
    // Path for handing to the importer as an open file descriptor; verified by the caller who reads it. Empty
    // if the digest is none; the file need not exist.
    std::filesystem::path path(Kind kind, std::string_view digest) const;
    bool remove(Kind kind, std::string_view digest);
    void touch(Kind kind, std::string_view digest); // marks it as used now

    std::uint64_t total_bytes(Kind kind) const;
    std::vector<std::string> list(Kind kind) const; // least recently used first
    // Removes least recently used assets that are not in use until `bytes` more fit under `limit`; who is in use
    // is only asked for where something must go. False, and nothing is removed, if they cannot.
    bool make_room(std::uint64_t bytes,
                   std::uint64_t limit,
                   const std::function<std::vector<std::string>()>& in_use);

private:
    struct State;
    class FileWriter;
    std::unique_ptr<State> state_;
};

// "sha256:" and 64 lower-case hex digits.
bool is_digest(std::string_view text);
std::string digest_of(std::span<const std::byte> bytes);
std::string digest_of(std::string_view text);

} // namespace server
