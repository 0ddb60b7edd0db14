#include "server/http/guard/socket_address.h"

#include <arpa/inet.h>
#include <cstddef>
#include <cstring>
#include <netinet/in.h>
#include <sys/socket.h>

namespace server {

namespace {

SocketAddress in_words(const sockaddr_storage& address)
{
    char text[INET6_ADDRSTRLEN] = "";
    if (address.ss_family == AF_INET) {
        sockaddr_in v4{};
        std::memcpy(&v4, &address, sizeof v4);
        inet_ntop(AF_INET, &v4.sin_addr, text, sizeof text);
        return {text, ntohs(v4.sin_port)};
    }
    if (address.ss_family == AF_INET6) {
        sockaddr_in6 v6{};
        std::memcpy(&v6, &address, sizeof v6);
        inet_ntop(AF_INET6, &v6.sin6_addr, text, sizeof text);
        return {text, ntohs(v6.sin6_port)};
    }
    return {};
}

SocketAddress ask(int (*name)(int, sockaddr*, socklen_t*), int fd)
{
    sockaddr_storage address{};
    socklen_t size = sizeof address;
    return name(fd, reinterpret_cast<sockaddr*>(&address), &size) == 0 ? in_words(address) : SocketAddress{};
}

} // namespace

SocketAddress peer_of(int fd)
{
    return ask([](int s, sockaddr* a, socklen_t* n) { return getpeername(s, a, n); }, fd);
}

SocketAddress own_of(int fd)
{
    return ask([](int s, sockaddr* a, socklen_t* n) { return getsockname(s, a, n); }, fd);
}

std::string client_of(const std::string& ip)
{
    constexpr std::size_t kNetworkBytes = 8; // a /64
    in6_addr v6{};
    if (inet_pton(AF_INET6, ip.c_str(), &v6) != 1 || IN6_IS_ADDR_V4MAPPED(&v6)) return ip;
    return {reinterpret_cast<const char*>(v6.s6_addr), kNetworkBytes};
}

} // namespace server
