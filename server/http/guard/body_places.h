// BodyPlaces: how many connections of one client (client_of) may be in the midst of sending a large body, since
// each of them holds a thread for as long as it keeps up the lowest rate.
//
// Threads  any.
#pragma once

#include <cstddef>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <utility>

namespace server {

class BodyPlaces {
public:
    explicit BodyPlaces(std::size_t per_client) : per_client_(per_client) {}

    // A place among the client's, given back by its destructor.
    class Place {
    public:
        Place(BodyPlaces& places, std::string client) : places_(&places), client_(std::move(client)) {}
        Place(Place&& other) noexcept
            : places_(std::exchange(other.places_, nullptr)), client_(std::move(other.client_))
        {
        }
        Place& operator=(Place&& other) noexcept
        {
            std::swap(places_, other.places_);
            std::swap(client_, other.client_);
            return *this;
        }
        Place(const Place&) = delete;
        Place& operator=(const Place&) = delete;
        ~Place()
        {
            if (places_ != nullptr) places_->leave(client_);
        }

    private:
        BodyPlaces* places_;
        std::string client_;
    };
    std::optional<Place> enter(const std::string& client); // nothing: the client has all of its own

private:
    void leave(const std::string& client);

    const std::size_t per_client_;
    std::mutex mutex_;
    std::map<std::string, std::size_t> taken_; // only clients that have some
};

} // namespace server
