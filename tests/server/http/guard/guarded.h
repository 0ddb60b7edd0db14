// Guarded: a GuardedServer on a port of its own, for each test anew.
#pragma once

#include "server/http/guard/guarded_server.h"
#include "tests/support/raw_http.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <functional>
#include <future>
#include <memory>
#include <stdexcept>
#include <string>
#include <thread>

namespace tests {

inline constexpr std::size_t kBig = 256 << 20; // bytes that GET /big gives

// The head of a body of PUT /read that is too large to be waited for.
inline const std::string kLargeHead = "PUT /read HTTP/1.1\r\nHost: a\r\nContent-Length: 100000\r\n\r\n";
// Enough of the body for a thread, and what is left of it.
inline const std::string kLargeStart = kLargeHead + std::string(70000, 'x');
inline const std::string kLargeRest(30000, 'x');

// A server whose handlers do what a test needs, and which says when a waiting one has begun and ended.
class Guarded : public testing::Test {
protected:
    void start(const server::GuardOptions& options)
    {
        server_ = std::make_unique<server::GuardedServer>(
            options,
            log_,
            [this](const httplib::Request& request,
                   httplib::Response& response,
                   const httplib::ContentReader* content) { handle(request, response, content); });
        server_->start("127.0.0.1", 0);
        port = server_->port();
    }
    void restart(const server::GuardOptions& options)
    {
        TearDown();
        start(options);
    }
    // False: it did not come to pass, although a patient client would have gone home by now.
    bool comes_to_pass(const std::function<bool(const server::GuardedServer::Load&)>& wanted) const
    {
        const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(60);
        while (!wanted(server_->load())) { // asked once: it may pass again
            if (std::chrono::steady_clock::now() > end) return false;
            std::this_thread::sleep_for(std::chrono::milliseconds(5));
        }
        return true;
    }
    void SetUp() override { start({}); }
    void TearDown() override
    {
        if (server_) server_->stop();
    }

    void handle(const httplib::Request& request,
                httplib::Response& response,
                const httplib::ContentReader* content)
    {
        if (request.path == "/throw") throw std::runtime_error("secret path /etc/passwd");
        response.status = 200;
        if (request.path == "/read") {
            std::string body;
            const bool complete = (*content)([&](const char* data, std::size_t size) {
                reading += body.empty() ? 1u : 0u;
                body.append(data, size);
                return true;
            });
            response.status = complete ? 200 : 400;
            response.set_content(complete ? body : "incomplete", "text/plain");
        } else if (request.path == "/headers") {
            std::string text = request.remote_addr + "\n";
            for (const auto& [name, value] : request.headers)
                text += name + "=" + value + "\n";
            response.set_content(text, "text/plain");
        } else if (request.path == "/big") {
            const auto block = std::make_shared<std::string>(1 << 20, 'x');
            response.set_content_provider(kBig,
                                          "application/octet-stream",
                                          [block](std::size_t, std::size_t length, httplib::DataSink& sink) {
                                              return sink.write(block->data(),
                                                                std::min(length, block->size()));
                                          });
        } else if (request.path == "/wait") {
            began.set_value();
            while (request.progress(0, 0))
                std::this_thread::yield();
            ended.set_value();
        } else {
            response.set_content("ok", "text/plain");
        }
    }

    void expect_alive() { EXPECT_EQ(test_support::fetch(port, "GET", "/").body, "ok"); }

    server::Log log_{server::LogLevel::error};
    std::unique_ptr<server::GuardedServer> server_;
    int port = 0;
    std::promise<void> began, ended;
    std::atomic<unsigned> reading = 0; // bodies of which something has been read
};

} // namespace tests
