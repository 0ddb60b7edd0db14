#include "tests/support/raw_http.h"

#include <algorithm>
#include <arpa/inet.h>
#include <cctype>
#include <netinet/in.h>
#include <poll.h>
#include <stdexcept>
#include <sys/socket.h>
#include <unistd.h>

namespace test_support {

namespace {

constexpr int kPatienceMs = 30000;

std::string lower(std::string text)
{
    std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) {
        return static_cast<char>(std::tolower(c));
    });
    return text;
}

HttpAnswer parse_head(std::string_view head)
{
    HttpAnswer answer;
    if (head.size() > 12) answer.status = std::stoi(std::string(head.substr(9, 3)));
    std::size_t at = head.find("\r\n");
    while (at != std::string_view::npos && at + 2 < head.size()) {
        const std::size_t end = head.find("\r\n", at + 2);
        const std::string_view line = head.substr(at + 2, end - at - 2);
        const std::size_t colon = line.find(": ");
        if (colon != std::string_view::npos)
            answer.headers.emplace(lower(std::string(line.substr(0, colon))), line.substr(colon + 2));
        at = end;
    }
    return answer;
}

} // namespace

std::string HttpAnswer::header(const std::string& name) const
{
    const auto found = headers.find(name);
    return found == headers.end() ? std::string() : found->second;
}

RawConnection::RawConnection() : fd_(socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {}

RawConnection::RawConnection(int port, int receive_buffer, const char* from) : RawConnection()
{
    if (receive_buffer > 0) setsockopt(fd_, SOL_SOCKET, SO_RCVBUF, &receive_buffer, sizeof receive_buffer);
    sockaddr_in own{};
    own.sin_family = AF_INET;
    const bool bound = inet_pton(AF_INET, from, &own.sin_addr) == 1 &&
                       bind(fd_, reinterpret_cast<sockaddr*>(&own), sizeof own) == 0;
    if (!bound) throw std::runtime_error(std::string("cannot connect from ") + from);
    connect(port);
}

void RawConnection::connect(int port)
{
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<std::uint16_t>(port));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    if (::connect(fd_, reinterpret_cast<sockaddr*>(&address), sizeof address) != 0)
        throw std::runtime_error("cannot connect to port " + std::to_string(port));
}

RawConnection::~RawConnection()
{
    hang_up();
}

void RawConnection::hang_up()
{
    if (fd_ >= 0) close(fd_);
    fd_ = -1;
}

bool RawConnection::send(std::string_view bytes)
{
    while (!bytes.empty()) {
        const ssize_t count = ::send(fd_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
        if (count <= 0) return false;
        bytes.remove_prefix(static_cast<std::size_t>(count));
    }
    return true;
}

bool RawConnection::receive()
{
    pollfd wanted{fd_, POLLIN, 0};
    if (poll(&wanted, 1, kPatienceMs) != 1) throw std::runtime_error("the server says nothing");
    char bytes[65536];
    const ssize_t count = recv(fd_, bytes, sizeof bytes, 0);
    if (count > 0) buffer_.append(bytes, static_cast<std::size_t>(count));
    return count > 0;
}

std::optional<HttpAnswer> RawConnection::read_head()
{
    std::size_t end = 0;
    while ((end = buffer_.find("\r\n\r\n")) == std::string::npos)
        if (!receive()) return std::nullopt;
    HttpAnswer answer = parse_head(std::string_view(buffer_).substr(0, end + 2));
    buffer_.erase(0, end + 4);
    return answer;
}

std::optional<HttpAnswer> RawConnection::read(bool head)
{
    auto answer = read_head();
    while (answer && answer->status == 100)
        answer = read_head();
    if (!answer || head || answer->status == 204 || answer->status == 304) return answer;
    const std::string length = answer->header("content-length");
    const std::size_t size = length.empty() ? std::string::npos : std::stoul(length);
    while (buffer_.size() < size && receive()) {
    }
    if (!length.empty() && buffer_.size() < size) throw std::runtime_error("the body ended early");
    answer->body = buffer_.substr(0, size);
    buffer_.erase(0, size);
    return answer;
}

std::size_t RawConnection::read_bytes(std::size_t count)
{
    std::size_t got = 0;
    do {
        const std::size_t taken = std::min(count - got, buffer_.size());
        buffer_.erase(0, taken);
        got += taken;
    } while (got < count && receive());
    return got;
}

bool RawConnection::wait_closed()
{
    try {
        while (receive())
            buffer_.clear();
        return true;
    } catch (const std::runtime_error&) {
        return false;
    }
}

HttpAnswer fetch(int port,
                 const std::string& method,
                 const std::string& target,
                 const Headers& headers,
                 const std::string& body)
{
    RawConnection connection(port);
    std::string request = method + " " + target + " HTTP/1.1\r\nHost: test\r\nConnection: close\r\n";
    for (const auto& [name, value] : headers)
        request += name + ": " + value + "\r\n";
    if (!body.empty() || method == "POST" || method == "PUT")
        request += "Content-Length: " + std::to_string(body.size()) + "\r\n";
    connection.send(request + "\r\n");
    connection.send(body);
    auto answer = connection.read(method == "HEAD");
    if (!answer) throw std::runtime_error("the server closed without an answer to " + method + " " + target);
    return *std::move(answer);
}

std::pair<std::string, std::string> form(const std::vector<std::pair<std::string, std::string>>& parts)
{
    const std::string boundary = "------------------------d74496d66958873e";
    std::string body;
    for (const auto& [name, content] : parts)
        body += "--" + boundary + "\r\nContent-Disposition: form-data; name=\"" + name + "\"; filename=\"" +
                name + "\"\r\nContent-Type: application/octet-stream\r\n\r\n" + content + "\r\n";
    return {"multipart/form-data; boundary=" + boundary, body + "--" + boundary + "--\r\n"};
}

} // namespace test_support
