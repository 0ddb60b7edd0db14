// Sha256: a digest in the making, over bytes as they come.
//
// Errors  std::runtime_error if the crypto library refuses (out of memory).
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <span>
#include <string>

namespace server {

class Sha256 {
public:
    Sha256();
    ~Sha256();
    Sha256(const Sha256&) = delete;
    Sha256& operator=(const Sha256&) = delete;

    void append(std::span<const std::byte> bytes);
    // Call one of them, once.
    using Raw = std::array<std::byte, 32>;
    Raw finish_raw();
    std::string finish(); // "sha256:" and 64 lower-case hex digits

private:
    struct Context;
    std::unique_ptr<Context> context_;
};

} // namespace server
