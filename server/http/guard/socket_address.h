// Who is at the ends of a connection, and whom it counts for.
#pragma once

#include <string>

namespace server {

struct SocketAddress {
    std::string ip; // empty: the connection has gone
    int port = 0;
};
SocketAddress peer_of(int fd);
SocketAddress own_of(int fd);

// An IPv4 address, or the /64 of an IPv6 one, since whoever has one address there has all of them.
std::string client_of(const std::string& ip);

} // namespace server
