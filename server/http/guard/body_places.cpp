#include "server/http/guard/body_places.h"

namespace server {

std::optional<BodyPlaces::Place> BodyPlaces::enter(const std::string& client)
{
    const std::lock_guard lock(mutex_);
    if (per_client_ == 0) return std::nullopt;
    std::size_t& taken = taken_[client];
    if (taken == per_client_) return std::nullopt;
    ++taken;
    return Place(*this, client);
}

void BodyPlaces::leave(const std::string& client)
{
    const std::lock_guard lock(mutex_);
    const auto found = taken_.find(client);
    if (--found->second == 0) taken_.erase(found);
}

} // namespace server
