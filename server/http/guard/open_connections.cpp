#include "server/http/guard/open_connections.h"

#include <sys/socket.h>
#include <unistd.h>

namespace server {

void OpenConnections::add(int fd)
{
    const std::lock_guard lock(mutex_);
    open_.insert(fd);
}

void OpenConnections::close(int fd)
{
    const std::lock_guard lock(mutex_);
    open_.erase(fd);
    ::shutdown(fd, SHUT_RDWR);
    ::close(fd);
}

std::size_t OpenConnections::cut()
{
    const std::lock_guard lock(mutex_);
    for (const int fd : open_)
        ::shutdown(fd, SHUT_RDWR);
    return open_.size();
}

} // namespace server
