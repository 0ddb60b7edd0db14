#include "server/import/flat_texts.h"

namespace server {

bool is_utf8(std::string_view text)
{
    const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
    for (std::size_t at = 0; at < text.size();) {
        const unsigned first = byte(at);
        const std::size_t length = first < 0x80   ? 1
                                   : first < 0xc2 ? 0
                                   : first < 0xe0 ? 2
                                   : first < 0xf0 ? 3
                                   : first < 0xf5 ? 4
                                                  : 0;
        if (length == 0 || text.size() - at < length) return false;
        for (std::size_t i = 1; i < length; ++i)
            if ((byte(at + i) & 0xc0u) != 0x80u) return false;
        const unsigned second = length > 1 ? byte(at + 1) : 0;
        if ((first == 0xe0 && second < 0xa0) || (first == 0xed && second > 0x9f))
            return false; // overlong, surrogate
        if ((first == 0xf0 && second < 0x90) || (first == 0xf4 && second > 0x8f))
            return false; // overlong, beyond
        at += length;
    }
    return true;
}

} // namespace server
