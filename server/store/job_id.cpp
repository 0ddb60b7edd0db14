#include "server/store/store.h"

#include <array>
#include <cerrno>
#include <sys/random.h>
#include <system_error>

namespace server {

JobId make_job_id()
{
    std::array<unsigned char, 16> bits{};
    if (getrandom(bits.data(), bits.size(), 0) != static_cast<ssize_t>(bits.size()))
        throw std::system_error(errno, std::generic_category(), "getrandom");
    static constexpr char digits[] = "0123456789abcdef";
    JobId id;
    for (const unsigned char b : bits) {
        id += digits[b >> 4];
        id += digits[b & 15];
    }
    return id;
}

} // namespace server
