#include "clients/cli/digest.h"

#include <array>
#include <openssl/evp.h>
#include <stdexcept>

namespace clients {
namespace {

using Sha256 = std::array<unsigned char, 32>;

Sha256 sha256_of(std::string_view bytes)
{
    Sha256 hash{};
    unsigned int length = 0;
    if (EVP_Digest(bytes.data(), bytes.size(), hash.data(), &length, EVP_sha256(), nullptr) != 1 ||
        length != hash.size())
        throw std::runtime_error("SHA-256 is not available in this OpenSSL");
    return hash;
}

} // namespace

std::string digest_of(std::string_view bytes)
{
    static constexpr std::string_view kHex = "0123456789abcdef";
    std::string out = "sha256:";
    for (const unsigned char byte : sha256_of(bytes)) {
        out += kHex[byte >> 4];
        out += kHex[byte & 15];
    }
    return out;
}

std::string repr_digest_of(std::string_view bytes)
{
    const Sha256 hash = sha256_of(bytes);
    std::array<unsigned char, 45> base64{}; // 32 bytes are 44 characters, and a terminating zero
    EVP_EncodeBlock(base64.data(), hash.data(), static_cast<int>(hash.size()));
    return "sha-256=:" + std::string(base64.begin(), base64.end() - 1) + ':';
}

} // namespace clients
