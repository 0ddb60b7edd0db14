#include "server/store/blob_index.h"

#include <utility>

namespace server {

std::uint64_t BlobIndex::add(std::string_view digest, Blob blob)
{
    remove(digest);
    blob.file = ++last_file_;
    total_bytes_ += blob.bytes;
    const auto place = order_.insert(order_.end(), std::string(digest));
    entries_.emplace(std::string(digest), Entry{std::move(blob), place});
    return last_file_;
}

void BlobIndex::remove(std::string_view digest)
{
    const auto found = entries_.find(std::string(digest));
    if (found == entries_.end()) return;
    total_bytes_ -= found->second.blob.bytes;
    order_.erase(found->second.place);
    entries_.erase(found);
}

void BlobIndex::use(std::string_view digest)
{
    const auto found = entries_.find(std::string(digest));
    if (found != entries_.end()) order_.splice(order_.end(), order_, found->second.place);
}

BlobIndex::Blob* BlobIndex::find(std::string_view digest)
{
    const auto found = entries_.find(std::string(digest));
    return found == entries_.end() ? nullptr : &found->second.blob;
}

const BlobIndex::Blob* BlobIndex::find(std::string_view digest) const
{
    const auto found = entries_.find(std::string(digest));
    return found == entries_.end() ? nullptr : &found->second.blob;
}

BlobIndex::Blob* BlobIndex::find(std::string_view digest, std::uint64_t file)
{
    Blob* blob = find(digest);
    return blob != nullptr && blob->file == file ? blob : nullptr;
}

} // namespace server
