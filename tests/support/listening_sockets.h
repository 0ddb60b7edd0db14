// The sockets on which this process listens, to break them as nothing from outside can.
#pragma once

#include <map>
#include <netinet/in.h>
#include <sys/socket.h>

namespace test_support {

inline std::map<int, int> listening_sockets() // port -> descriptor
{
    constexpr int kMostDescriptors = 1024;
    std::map<int, int> found;
    for (int fd = 0; fd < kMostDescriptors; ++fd) {
        int listens = 0;
        socklen_t size = sizeof listens;
        if (getsockopt(fd, SOL_SOCKET, SO_ACCEPTCONN, &listens, &size) != 0 || listens == 0) continue;
        sockaddr_in address{};
        size = sizeof address;
        if (getsockname(fd, reinterpret_cast<sockaddr*>(&address), &size) == 0)
            found[ntohs(address.sin_port)] = fd;
    }
    return found;
}

} // namespace test_support
