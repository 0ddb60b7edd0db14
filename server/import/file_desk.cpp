#include "server/import/file_desk.h"

#include <array>
#include <cerrno>
#include <cstring>
#include <sys/socket.h>
#include <sys/uio.h>
#include <system_error>

namespace server {

namespace {

union FdControl {
    cmsghdr align;
    std::array<char, CMSG_SPACE(sizeof(int))> bytes;
};

msghdr message(iovec& word, FdControl* control)
{
    msghdr header{};
    header.msg_iov = &word;
    header.msg_iovlen = 1;
    if (control) {
        header.msg_control = control->bytes.data();
        header.msg_controllen = control->bytes.size();
    }
    return header;
}

bool send_answer(int desk, const FileDescriptor& file)
{
    char word = file ? 'y' : 'n';
    iovec vector{&word, 1};
    FdControl control{};
    msghdr header = message(vector, file ? &control : nullptr);
    if (file) {
        cmsghdr* part = CMSG_FIRSTHDR(&header);
        part->cmsg_level = SOL_SOCKET;
        part->cmsg_type = SCM_RIGHTS;
        part->cmsg_len = CMSG_LEN(sizeof(int));
        const int fd = file.get();
        std::memcpy(CMSG_DATA(part), &fd, sizeof fd);
    }
    return ::sendmsg(desk, &header, MSG_NOSIGNAL | MSG_DONTWAIT) == 1;
}

} // namespace

std::pair<FileDescriptor, FileDescriptor> make_desk()
{
    std::array<int, 2> ends{};
    if (::socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, ends.data()) != 0)
        throw std::system_error(errno, std::generic_category(), "socketpair");
    return {FileDescriptor(ends[0]), FileDescriptor(ends[1])};
}

FileDescriptor ask_for_file(int desk, std::string_view name)
{
    if (name.empty() || name.size() > kLongestFileName) return {};
    if (::send(desk, name.data(), name.size(), MSG_NOSIGNAL) != static_cast<ssize_t>(name.size())) return {};
    char word = 0;
    iovec vector{&word, 1};
    FdControl control{};
    msghdr header = message(vector, &control);
    ssize_t got = 0;
    do {
        got = ::recvmsg(desk, &header, MSG_CMSG_CLOEXEC);
    } while (got < 0 && errno == EINTR);
    const cmsghdr* part = got == 1 ? CMSG_FIRSTHDR(&header) : nullptr;
    if (!part || part->cmsg_level != SOL_SOCKET || part->cmsg_type != SCM_RIGHTS) return {};
    int fd = -1;
    std::memcpy(&fd, CMSG_DATA(part), sizeof fd);
    return FileDescriptor(fd);
}

bool answer_question(int desk, const std::function<FileDescriptor(std::string_view)>& open)
{
    std::array<char, kLongestFileName + 1> name{};
    // Without room for control data, descriptors that the importer might send are discarded by the kernel.
    const ssize_t got = ::recv(desk, name.data(), name.size(), MSG_DONTWAIT);
    if (got < 0) return errno == EAGAIN || errno == EINTR;
    if (got == 0) return false;
    const bool fits = static_cast<std::size_t>(got) <= kLongestFileName;
    return send_answer(desk, fits ? open({name.data(), static_cast<std::size_t>(got)}) : FileDescriptor());
}

} // namespace server
