#include "server/store/blob_shelf.h"

#include "server/store/blob_store.h"

#include <unistd.h>
#include <unordered_set>
#include <utility>

namespace server {

namespace {

// Syncing files one by one takes a turn of the disk each; all at once takes a few, whatever else is written.
constexpr std::size_t kSyncedOneByOne = 4;

} // namespace

DamagedBlob BlobShelf::damage(std::string_view digest) const
{
    return {std::string(digest), of_assets_, folder_.path(digest)};
}

void BlobShelf::mark_damaged(std::string_view digest, std::uint64_t file)
{
    const std::lock_guard lock(mutex_);
    if (BlobIndex::Blob* blob = index_.find(digest, file)) blob->damaged = true; // else it was uploaded again
}

// Gone since it was looked up, or taken away behind our back.
void BlobShelf::forget_if_gone(std::string_view digest)
{
    const std::lock_guard lock(mutex_);
    if (::access(folder_.path(digest).c_str(), F_OK) != 0) index_.remove(digest);
}

std::optional<std::uint64_t> BlobShelf::file_of(std::string_view digest) const
{
    const std::lock_guard lock(mutex_);
    const BlobIndex::Blob* blob = index_.find(digest);
    if (blob == nullptr) return std::nullopt;
    return blob->file;
}

bool BlobShelf::keeps(const IncomingBlob& blob, bool durable)
{
    std::uint64_t number = 0;
    bool synced = false;
    {
        const std::lock_guard lock(mutex_);
        const BlobIndex::Blob* present = index_.find(blob.digest);
        if (present == nullptr || present->damaged || present->bytes != blob.bytes) return false;
        number = present->file;
        synced = present->synced;
    }
    const std::optional<FileDescriptor> file = folder_.open(blob.digest);
    if (!file) return false;
    if (!have_same_bytes(blob.file, *file, blob.path)) { // it was damaged, and nobody had noticed
        mark_damaged(blob.digest, number);
        return false;
    }
    if (durable && !synced) {
        sync_file(*file, folder_.path(blob.digest));
        folder_.sync_name(blob.digest);
    }
    {
        const std::lock_guard lock(mutex_);
        BlobIndex::Blob* present = index_.find(blob.digest, number);
        if (present == nullptr) return false;
        present->synced = present->synced || durable;
        index_.use(blob.digest);
    }
    folder_.mark_used(blob.digest);
    return true;
}

void BlobShelf::take(const IncomingBlob& blob, bool durable)
{
    if (durable) sync_file(blob.file, blob.path);
    std::uint64_t number = 0;
    {
        const std::lock_guard lock(mutex_);
        folder_.adopt(blob.path, blob.digest);
        number = index_.add(blob.digest, {.bytes = blob.bytes});
    }
    if (!durable) return;
    folder_.sync_name(blob.digest); // until it is done nobody may count on it
    const std::lock_guard lock(mutex_);
    if (BlobIndex::Blob* present = index_.find(blob.digest, number)) present->synced = true;
}

void BlobShelf::make_durable(const std::vector<std::string>& digests)
{
    std::vector<std::pair<std::string, std::uint64_t>> unsynced;
    {
        const std::lock_guard lock(mutex_);
        for (const std::string& digest : digests)
            if (const BlobIndex::Blob* blob = index_.find(digest); blob != nullptr && !blob->synced)
                unsynced.emplace_back(digest, blob->file);
    }
    if (unsynced.size() > kSyncedOneByOne) {
        folder_.sync_all();
    } else {
        for (const auto& [digest, number] : unsynced)
            if (const std::optional<FileDescriptor> file = folder_.open(digest)) {
                sync_file(*file, folder_.path(digest));
                folder_.sync_name(digest);
            }
    }
    const std::lock_guard lock(mutex_);
    for (const auto& [digest, number] : unsynced)
        if (BlobIndex::Blob* blob = index_.find(digest, number)) blob->synced = true;
}

std::optional<std::uint64_t> BlobShelf::size(std::string_view digest) const
{
    const std::lock_guard lock(mutex_);
    const BlobIndex::Blob* blob = index_.find(digest);
    if (blob == nullptr || blob->damaged) return std::nullopt;
    return blob->bytes;
}

std::optional<std::vector<std::byte>> BlobShelf::read(std::string_view digest)
{
    const std::optional<std::uint64_t> number = file_of(digest);
    if (!number) return std::nullopt;
    std::optional<std::vector<std::byte>> bytes = folder_.read(digest);
    if (!bytes) {
        forget_if_gone(digest);
        return std::nullopt;
    }
    if (digest_of(std::span<const std::byte>(*bytes)) != digest) {
        mark_damaged(digest, *number);
        throw damage(digest);
    }
    touch(digest);
    return bytes;
}

std::unique_ptr<BlobReader> BlobShelf::open(std::string_view digest)
{
    std::shared_ptr<const BlobProof> proof;
    std::uint64_t number = 0;
    {
        const std::lock_guard lock(mutex_);
        const BlobIndex::Blob* blob = index_.find(digest);
        if (blob == nullptr) return nullptr;
        if (!blob->damaged) proof = blob->proof;
        number = blob->file;
    }
    std::optional<FileDescriptor> file = folder_.open(digest);
    if (!file) {
        forget_if_gone(digest);
        return nullptr;
    }
    if (!proof) {
        proof = prove_blob(*file, folder_.path(digest), digest);
        if (!proof) {
            mark_damaged(digest, number);
            throw damage(digest);
        }
        const std::lock_guard lock(mutex_);
        if (BlobIndex::Blob* blob = index_.find(digest, number)) {
            blob->damaged = false;
            blob->proof = proof;
        }
    }
    auto damaged = [this, name = std::string(digest), number] {
        mark_damaged(name, number);
        return damage(name);
    };
    touch(digest);
    return std::make_unique<BlobReader>(
        *std::move(file), folder_.path(digest), std::move(proof), std::move(damaged));
}

bool BlobShelf::remove(std::string_view digest)
{
    std::optional<std::filesystem::path> aside;
    {
        const std::lock_guard lock(mutex_);
        if (index_.find(digest) == nullptr) return false;
        aside = folder_.set_aside(digest);
        index_.remove(digest);
    }
    if (aside && !aside->empty()) ::unlink(aside->c_str());
    return aside.has_value();
}

void BlobShelf::touch(std::string_view digest)
{
    {
        const std::lock_guard lock(mutex_);
        if (index_.find(digest) == nullptr) return;
        index_.use(digest);
    }
    folder_.mark_used(digest);
}

std::uint64_t BlobShelf::total_bytes() const
{
    const std::lock_guard lock(mutex_);
    return index_.total_bytes();
}

std::vector<std::string> BlobShelf::list() const
{
    const std::lock_guard lock(mutex_);
    return {index_.digests().begin(), index_.digests().end()};
}

bool BlobShelf::make_room(std::uint64_t bytes,
                          std::uint64_t limit,
                          const std::function<std::vector<std::string>()>& in_use)
{
    if (bytes > limit) return false;
    if (total_bytes() <= limit - bytes) return true;
    const std::vector<std::string> used = in_use();
    const std::unordered_set<std::string_view> kept(used.begin(), used.end());
    std::vector<std::filesystem::path> aside;
    {
        const std::lock_guard lock(mutex_);
        std::uint64_t total = index_.total_bytes();
        std::vector<std::string> victims;
        for (auto digest = index_.digests().begin();
             digest != index_.digests().end() && total > limit - bytes;
             ++digest) {
            if (kept.contains(*digest)) continue;
            total -= index_.find(*digest)->bytes;
            victims.push_back(*digest);
        }
        if (total > limit - bytes) return false;
        for (const std::string& victim : victims) {
            if (auto path = folder_.set_aside(victim); path && !path->empty())
                aside.push_back(*std::move(path));
            index_.remove(victim);
        }
    }
    for (const std::filesystem::path& path : aside)
        ::unlink(path.c_str());
    return true;
}

} // namespace server
