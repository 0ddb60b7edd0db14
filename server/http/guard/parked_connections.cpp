#include "server/http/guard/parked_connections.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <new>
#include <sys/epoll.h>
#include <sys/eventfd.h>
#include <system_error>
#include <unistd.h>
#include <utility>

namespace server {

namespace {

using Phase = ConnectionStream::Phase;

std::uint32_t events_of(const ConnectionStream& connection)
{
    return connection.phase() == Phase::answer ? EPOLLOUT : EPOLLIN;
}

bool has_come(const ConnectionStream& connection)
{
    switch (connection.intake().stage()) {
    case RequestIntake::Stage::nothing:
    case RequestIntake::Stage::head:
    case RequestIntake::Stage::body:
        return false;
    case RequestIntake::Stage::ready:
    case RequestIntake::Stage::large:
    case RequestIntake::Stage::faulty:
        return true;
    }
    return true;
}

} // namespace

ParkedConnections::ParkedConnections(const OpenConnections& open,
                                     const ParkingLimits& limits,
                                     Callbacks callbacks)
    : open_(open), limits_(limits), callbacks_(std::move(callbacks)), epoll_(epoll_create1(EPOLL_CLOEXEC)),
      bell_(eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK))
{
    epoll_event rung{EPOLLIN, {.fd = bell_}};
    if (epoll_ < 0 || bell_ < 0 || epoll_ctl(epoll_, EPOLL_CTL_ADD, bell_, &rung) != 0) {
        const int error = errno;
        ::close(epoll_);
        ::close(bell_);
        throw std::system_error(error, std::generic_category(), "cannot watch connections");
    }
    thread_ = std::thread([this] { run(); });
}

ParkedConnections::~ParkedConnections()
{
    stop();
    ::close(epoll_);
    ::close(bell_);
}

void ParkedConnections::wake() const
{
    const std::uint64_t one = 1;
    while (write(bell_, &one, sizeof one) < 0 && errno == EINTR) {
    }
}

void ParkedConnections::park(Connection connection)
{
    {
        const std::lock_guard lock(mutex_);
        if (stopping_) return;
        arrivals_.push_back(std::move(connection));
        if (arrivals_.size() > 1) return; // rung for already
    }
    wake();
}

void ParkedConnections::drain()
{
    draining_ = true;
    wake();
}

void ParkedConnections::stop()
{
    {
        const std::lock_guard lock(mutex_);
        stopping_ = true;
    }
    wake();
    if (thread_.joinable()) thread_.join();
    const std::lock_guard lock(mutex_);
    arrivals_.clear();
}

void ParkedConnections::run()
{
    std::array<epoll_event, 256> events{};
    while (!stopping_) {
        const int count = epoll_wait(epoll_, events.data(), static_cast<int>(events.size()), wait_ms());
        std::uint64_t rung = 0;
        while (read(bell_, &rung, sizeof rung) < 0 && errno == EINTR) {
        }
        for (int i = 0; i < count; ++i)
            if (events[static_cast<std::size_t>(i)].data.fd != bell_)
                step(events[static_cast<std::size_t>(i)].data.fd);
        std::vector<Connection> arrived;
        {
            const std::lock_guard lock(mutex_);
            arrived.swap(arrivals_);
        }
        for (Connection& connection : arrived) {
            try {
                admit(std::move(connection));
            } catch (const std::bad_alloc&) { // this one closes; the next may find some
            }
        }
        expire();
        bound_bytes();
        if (draining_ && !std::exchange(drained_, true)) {
            std::vector<int> all;
            for (const auto& [fd, place] : parked_)
                all.push_back(fd);
            for (const int fd : all)
                step(fd);
        }
    }
    while (!parked_.empty())
        take_out(parked_.begin()->first);
}

int ParkedConnections::wait_ms() const
{
    if (due_.empty()) return -1;
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(due_.begin()->first - Clock::now());
    return static_cast<int>(std::clamp<std::int64_t>(left.count(), 0, 60000));
}

// Takes what is there. Where that decides what becomes of the connection, false.
bool ParkedConnections::keeps_waiting(ConnectionStream& connection)
{
    switch (connection.phase()) {
    case Phase::answer:
        return false;
    case Phase::farewell:
        return connection.receive() != ConnectionStream::Come::end;
    case Phase::request:
        break;
    }
    if (has_come(connection)) return false;
    const ConnectionStream::Come come = connection.receive();
    if (come == ConnectionStream::Come::end || has_come(connection)) return false;
    return !draining_ || connection.intake().stage() != RequestIntake::Stage::nothing;
}

// One that was here before keeps its place among the open ones; a new one may have to be made room for.
void ParkedConnections::admit(Connection connection)
{
    const bool fresh =
        connection->requests() == 1 && connection->intake().stage() == RequestIntake::Stage::nothing;
    if (fresh && !make_room_for(connection)) return callbacks_.give_up(std::move(connection), Why::displaced);
    if (connection->phase() == Phase::request && !keeps_waiting(*connection)) {
        if (has_come(*connection)) callbacks_.go_on(std::move(connection));
        return;
    }
    const int fd = connection->descriptor();
    epoll_event event{events_of(*connection), {.fd = fd}};
    if (epoll_ctl(epoll_, EPOLL_CTL_ADD, fd, &event) != 0)
        return callbacks_.give_up(std::move(connection), Why::displaced); // no memory for it
    // What can fail for want of memory comes first; then all of it is entered.
    std::multimap<Clock::time_point, int> due{{connection->deadline(), fd}};
    std::list<int> age{fd};
    Place& place = parked_[fd];
    place.due = due_.insert(due.extract(due.begin()));
    place.age = age.begin();
    by_age_.splice(by_age_.end(), age);
    place.connection = std::move(connection);
    ++count_;
    settle(place);
}

// Its deadline and its bytes, as they are now.
void ParkedConnections::settle(Place& place)
{
    auto due = due_.extract(place.due);
    due.key() = place.connection->deadline();
    place.due = due_.insert(std::move(due));
    held_bytes_ -= place.bytes;
    place.bytes = place.connection->held_bytes();
    held_bytes_ += place.bytes;
}

void ParkedConnections::step(int fd)
{
    const auto found = parked_.find(fd);
    if (found == parked_.end()) return;
    ConnectionStream& stream = *found->second.connection;
    try {
        if (keeps_waiting(stream)) return settle(found->second);
    } catch (const std::bad_alloc&) {
        take_out(fd);
        return;
    }
    Connection connection = take_out(fd);
    if (stream.phase() == Phase::answer || (stream.phase() == Phase::request && has_come(stream)))
        callbacks_.go_on(std::move(connection));
}

Connection ParkedConnections::take_out(int fd)
{
    const auto found = parked_.find(fd);
    Place place = std::move(found->second);
    parked_.erase(found);
    --count_;
    due_.erase(place.due);
    by_age_.erase(place.age);
    held_bytes_ -= place.bytes;
    epoll_ctl(epoll_, EPOLL_CTL_DEL, fd, nullptr);
    return std::move(place.connection);
}

void ParkedConnections::expire()
{
    const auto now = Clock::now();
    while (!due_.empty() && due_.begin()->first <= now) {
        Connection connection = take_out(due_.begin()->second);
        if (connection->phase() != Phase::farewell) callbacks_.give_up(std::move(connection), Why::late);
    }
}

int ParkedConnections::oldest_of(const std::string& client) const
{
    const auto found = std::find_if(by_age_.begin(), by_age_.end(), [&](int fd) {
        return parked_.at(fd).connection->client() == client;
    });
    return found == by_age_.end() ? -1 : *found;
}

// The client whose parked connections hold most bytes.
std::string ParkedConnections::greediest() const
{
    std::map<std::string, std::size_t> sums;
    for (const auto& [fd, place] : parked_)
        sums[place.connection->client()] += place.bytes;
    const auto most = std::max_element(
        sums.begin(), sums.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
    return most == sums.end() ? std::string() : most->first;
}

bool ParkedConnections::make_room_for(const Connection& connection)
{
    std::string client = connection->client();
    if (open_.count_of(client) <= limits_.per_client) {
        if (open_.count() <= limits_.connections) return true;
        client = open_.most_numerous();
    }
    const int oldest = oldest_of(client);
    if (oldest < 0) return false;
    callbacks_.give_up(take_out(oldest), Why::displaced);
    return true;
}

void ParkedConnections::bound_bytes()
{
    while (held_bytes_ > limits_.held_bytes) {
        const int oldest = oldest_of(greediest());
        callbacks_.give_up(take_out(oldest), Why::displaced);
    }
}

} // namespace server
