// BlobIndex: what a kind of blobs holds, in order of last use: the memory of a BlobStore.
//
// Threads  none of its own: the BlobStore's mutex guards it.
// Cost     every function is O(1) but for digests().
#pragma once

#include "server/store/blob_reader.h"

#include <cstdint>
#include <list>
#include <memory>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

namespace server {

class BlobIndex {
public:
    struct Blob {
        std::uint64_t bytes = 0;
        bool synced = false;                      // known to outlast a power cut
        bool damaged = false;                     // found not to be what its name says
        std::shared_ptr<const BlobProof> proof{}; // once it was opened to be read in pieces
    };

    // As the most recently used; replaces what was there.
    void add(std::string_view digest, const Blob& blob);
    void remove(std::string_view digest);
    void use(std::string_view digest); // makes it the most recently used
    Blob* find(std::string_view digest);
    const Blob* find(std::string_view digest) const;

    std::uint64_t total_bytes() const { return total_bytes_; }
    const std::list<std::string>& digests() const { return order_; } // least recently used first

private:
    struct Entry {
        Blob blob;
        std::list<std::string>::iterator place;
    };
    std::list<std::string> order_;
    std::unordered_map<std::string, Entry> entries_;
    std::uint64_t total_bytes_ = 0;
};

} // namespace server
