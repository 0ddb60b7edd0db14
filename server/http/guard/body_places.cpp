#include "server/http/guard/body_places.h"

#include <arpa/inet.h>

namespace server {

namespace {

std::string client_of(const std::string& address)
{
    constexpr std::size_t kNetworkBytes = 8; // a /64
    in6_addr v6{};
    if (inet_pton(AF_INET6, address.c_str(), &v6) != 1 || IN6_IS_ADDR_V4MAPPED(&v6)) return address;
    return {reinterpret_cast<const char*>(v6.s6_addr), kNetworkBytes};
}

} // namespace

std::optional<BodyPlaces::Place> BodyPlaces::enter(const std::string& address)
{
    std::string client = client_of(address);
    const std::lock_guard lock(mutex_);
    if (per_client_ == 0) return std::nullopt;
    std::size_t& taken = taken_[client];
    if (taken == per_client_) return std::nullopt;
    ++taken;
    return Place(*this, std::move(client));
}

void BodyPlaces::leave(const std::string& client)
{
    const std::lock_guard lock(mutex_);
    const auto found = taken_.find(client);
    if (--found->second == 0) taken_.erase(found);
}

} // namespace server
