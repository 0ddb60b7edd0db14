// SHA-256 digests as the API writes them: "sha256:<64 small hex digits>".
#pragma once

#include <string>
#include <string_view>

namespace clients {

std::string digest_of(std::string_view bytes);

// As the header Repr-Digest has it (RFC 9530): "sha-256=:<base64>:".
std::string repr_digest_of(std::string_view bytes);

} // namespace clients
