#include "server/store/sha256.h"

#include "server/store/blob_store.h"

#include <algorithm>
#include <array>
#include <openssl/evp.h>
#include <stdexcept>

namespace server {

namespace {

constexpr std::string_view kPrefix = "sha256:";
constexpr std::size_t kHexDigits = 64;

void require(int ok)
{
    if (ok != 1) throw std::runtime_error("the crypto library refuses to compute a SHA-256 digest");
}

} // namespace

struct Sha256::Context {
    EVP_MD_CTX* evp = EVP_MD_CTX_new();
    Context() = default;
    ~Context() { EVP_MD_CTX_free(evp); }
    Context(const Context&) = delete;
    Context& operator=(const Context&) = delete;
};

Sha256::Sha256() : context_(std::make_unique<Context>())
{
    require(context_->evp != nullptr ? EVP_DigestInit_ex(context_->evp, EVP_sha256(), nullptr) : 0);
}

Sha256::~Sha256() = default;

void Sha256::append(std::span<const std::byte> bytes)
{
    require(EVP_DigestUpdate(context_->evp, bytes.data(), bytes.size()));
}

Sha256::Raw Sha256::finish_raw()
{
    Raw digest{};
    unsigned size = 0;
    require(EVP_DigestFinal_ex(context_->evp, reinterpret_cast<unsigned char*>(digest.data()), &size));
    return digest;
}

std::string Sha256::finish()
{
    static constexpr char digits[] = "0123456789abcdef";
    std::string text(kPrefix);
    for (const std::byte byte : finish_raw()) {
        text += digits[std::to_integer<unsigned>(byte) >> 4];
        text += digits[std::to_integer<unsigned>(byte) & 15];
    }
    return text;
}

bool is_digest(std::string_view text)
{
    const auto is_hex = [](char c) { return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f'); };
    return text.size() == kPrefix.size() + kHexDigits && text.substr(0, kPrefix.size()) == kPrefix &&
           std::all_of(text.begin() + kPrefix.size(), text.end(), is_hex);
}

std::string digest_of(std::span<const std::byte> bytes)
{
    Sha256 sha;
    sha.append(bytes);
    return sha.finish();
}

std::string digest_of(std::string_view text)
{
    return digest_of(std::as_bytes(std::span(text.data(), text.size())));
}

} // namespace server
