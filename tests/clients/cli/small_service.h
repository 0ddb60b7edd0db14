// SmallService: a service of one answer, on any free port, for tests of its clients.
#pragma once

#include "clients/cli/service_url.h"

#include <httplib.h>

#include <string>
#include <thread>

namespace tests {

class SmallService {
public:
    explicit SmallService(httplib::Server::Handler handler)
    {
        server_.Get(".*", handler);
        server_.Post(".*", handler);
        port_ = server_.bind_to_any_port("127.0.0.1");
        thread_ = std::jthread([this] { server_.listen_after_bind(); });
        while (!server_.is_running())
            std::this_thread::yield(); // stop() before that would be lost
    }
    ~SmallService() { server_.stop(); }
    clients::ServiceUrl url(const std::string& prefix = "") const
    {
        return {"http://127.0.0.1:" + std::to_string(port_), prefix};
    }

private:
    httplib::Server server_;
    int port_ = 0;
    std::jthread thread_;
};

} // namespace tests
