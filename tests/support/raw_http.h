// A client that sends any bytes whatever over a socket and reads what comes back: for tests of a server's
// manners.
//
// Errors  std::runtime_error when the server cannot be reached or says nothing for 30 s.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace test_support {

struct HttpAnswer {
    int status = 0;
    std::multimap<std::string, std::string> headers; // names in lower case
    std::string body;

    std::string header(const std::string& name) const; // in lower case; empty: none
    bool has(const std::string& name) const { return headers.contains(name); }
};

class RawConnection {
public:
    // `receive_buffer` > 0: a small window, for clients that read slowly. `from`: an address of this machine's
    // loopback, for clients that are several.
    explicit RawConnection(int port, int receive_buffer = 0, const char* from = "127.0.0.1");
    RawConnection(); // a descriptor that is not connected yet: connect(), once
    ~RawConnection();
    RawConnection(const RawConnection&) = delete;
    RawConnection& operator=(const RawConnection&) = delete;

    void connect(int port);
    // False when the server has closed.
    bool send(std::string_view bytes);
    // The next answer; 100 Continue is passed over. Nothing: closed without one. `head`: it has no body.
    std::optional<HttpAnswer> read(bool head = false);
    // The next status line and its headers alone, 100 too.
    std::optional<HttpAnswer> read_head();
    // So many bytes of a body; fewer when the server closes before.
    std::size_t read_bytes(std::size_t count);
    bool wait_closed(); // until the server closes; true if it did within 30 s
    void hang_up();

private:
    bool receive();

    int fd_ = -1;
    std::string buffer_;
};

using Headers = std::vector<std::pair<std::string, std::string>>;

// One request on a connection of its own. Host and, where there is a body, Content-Length are added.
HttpAnswer fetch(int port,
                 const std::string& method,
                 const std::string& target,
                 const Headers& headers = {},
                 const std::string& body = {});

// A form as curl -F makes it: (name, content).
std::pair<std::string, std::string>
form(const std::vector<std::pair<std::string, std::string>>& parts); // type, body

} // namespace test_support
