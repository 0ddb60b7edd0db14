#include "server/http/guard/listener.h"

#include <cerrno>
#include <chrono>
#include <memory>
#include <netdb.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>
#include <system_error>
#include <thread>
#include <unistd.h>

namespace server {

namespace {

constexpr int kBacklog = 1024;
// What the kernel keeps for one that reads slowly, beyond what is on its way; it would keep megabytes.
constexpr int kMostUnsent = 256 << 10;
constexpr std::chrono::milliseconds kPause{20}; // of a shortage: short against a client's patience

struct FreeAddresses {
    void operator()(addrinfo* first) const { freeaddrinfo(first); }
};

int bound_port(int fd)
{
    sockaddr_storage address{};
    socklen_t size = sizeof address;
    if (getsockname(fd, reinterpret_cast<sockaddr*>(&address), &size) != 0) return 0;
    // The port stands at the same place in both families.
    return ntohs(reinterpret_cast<const sockaddr_in&>(address).sin_port);
}

// A socket that listens at `address`, or -1 with errno.
int listen_at(const addrinfo& address)
{
    const int fd = socket(address.ai_family, address.ai_socktype | SOCK_CLOEXEC, address.ai_protocol);
    if (fd < 0) return -1;
    // SO_REUSEADDR alone: with SO_REUSEPORT two services would share one port without a word.
    const int yes = 1, no = 0;
    setsockopt(fd, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
    if (address.ai_family == AF_INET6) setsockopt(fd, IPPROTO_IPV6, IPV6_V6ONLY, &no, sizeof no);
    if (bind(fd, address.ai_addr, address.ai_addrlen) == 0 && listen(fd, kBacklog) == 0) return fd;
    const int error = errno;
    close(fd);
    errno = error;
    return -1;
}

} // namespace

AcceptError kind_of_accept_error(int error)
{
    switch (error) {
    case EMFILE:
    case ENFILE:
    case ENOBUFS:
    case ENOMEM:
        return AcceptError::shortage;
    // Errors that wait on the new connection are told by accept(), as its manual says.
    case ECONNABORTED:
    case EINTR:
    case EPERM:
    case EPROTO:
    case ENETDOWN:
    case ENETUNREACH:
    case ENOPROTOOPT:
    case EHOSTDOWN:
    case EHOSTUNREACH:
    case ENONET:
    case ETIMEDOUT:
        return AcceptError::of_one;
    default:
        return AcceptError::broken;
    }
}

Listener::Listener(const std::string& host, int port, const Log& log) : log_(log)
{
    bind_first_of(host, port);
    port_ = bound_port(fd_);
}

Listener::~Listener()
{
    close(fd_);
}

void Listener::bind_first_of(const std::string& host, int port)
{
    const std::string what = "cannot listen on " + host + " port " + std::to_string(port);
    addrinfo wanted{};
    wanted.ai_family = AF_UNSPEC;
    wanted.ai_socktype = SOCK_STREAM;
    wanted.ai_flags = AI_PASSIVE | AI_NUMERICSERV;
    addrinfo* found = nullptr;
    if (const int failed = getaddrinfo(host.c_str(), std::to_string(port).c_str(), &wanted, &found))
        throw std::system_error(EADDRNOTAVAIL, std::generic_category(), what + ": " + gai_strerror(failed));
    const std::unique_ptr<addrinfo, FreeAddresses> addresses(found);
    for (const addrinfo* address = found; address != nullptr && fd_ < 0; address = address->ai_next)
        fd_ = listen_at(*address);
    if (fd_ < 0) throw std::system_error(errno, std::generic_category(), what);
}

int Listener::accept()
{
    while (!stopped_) {
        const int fd = accept4(fd_, nullptr, nullptr, SOCK_CLOEXEC); // the importer inherits no connections
        const int error = errno;
        if (fd >= 0) {
            const int yes = 1;
            setsockopt(fd, IPPROTO_TCP, TCP_NODELAY, &yes, sizeof yes);
            setsockopt(fd, IPPROTO_TCP, TCP_NOTSENT_LOWAT, &kMostUnsent, sizeof kMostUnsent);
            short_ = false;
            return fd;
        }
        switch (kind_of_accept_error(error)) {
        case AcceptError::of_one:
            break;
        case AcceptError::shortage:
            wait_out_shortage(error);
            break;
        case AcceptError::broken:
            if (!stopped_) broken_ = error;
            return -1;
        }
    }
    return -1;
}

void Listener::wait_out_shortage(int error)
{
    if (!short_)
        log_.write(LogLevel::warning, "accept_short", {{"what", std::generic_category().message(error)}});
    short_ = true;
    std::this_thread::sleep_for(kPause);
}

void Listener::stop()
{
    stopped_ = true;
    shutdown(fd_, SHUT_RDWR); // wakes accept(); its number stays ours until nobody can use it any more
}

} // namespace server
