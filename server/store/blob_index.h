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
        std::uint64_t file = 0;                   // its number, for who looks at it without the mutex
        bool synced = false;                      // known to outlast a power cut
        bool damaged = false;                     // found not to be what its name says
        std::shared_ptr<const BlobProof> proof{}; // once it was opened to be read in pieces
    };

    // As the most recently used, under a new number; replaces what was there.
    std::uint64_t add(std::string_view digest, Blob blob);
    void remove(std::string_view digest);
    void use(std::string_view digest); // makes it the most recently used
    Blob* find(std::string_view digest);
    const Blob* find(std::string_view digest) const;
    // Only if it is still that file.
    Blob* find(std::string_view digest, std::uint64_t file);

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
    std::uint64_t last_file_ = 0;
};

} // namespace server
