#include "server/import/file_desk.h"

#include <gtest/gtest.h>

#include <fcntl.h>
#include <poll.h>
#include <string>
#include <sys/mman.h>
#include <sys/socket.h>
#include <thread>
#include <unistd.h>

namespace {

using server::FileDescriptor;

FileDescriptor file_with(const std::string& text)
{
    FileDescriptor file(::memfd_create("file", MFD_CLOEXEC));
    EXPECT_EQ(::write(file.get(), text.data(), text.size()), static_cast<ssize_t>(text.size()));
    return file;
}

// Serves until the other side is gone; the last name asked for is in `asked`.
void serve(int desk, std::string& asked)
{
    const auto open = [&](std::string_view name) {
        asked = name;
        return name == "there.mtl" ? file_with("newmtl a") : FileDescriptor();
    };
    do {
        pollfd polled{desk, POLLIN, 0};
        ::poll(&polled, 1, -1);
    } while (server::answer_question(desk, open));
}

TEST(FileDesk, HandsOutTheFilesThatAreThereAndNothingElse)
{
    auto [service, importer] = server::make_desk();
    const int desk = service.get();
    std::string asked;
    std::thread server_side([desk, &asked] { serve(desk, asked); });
    const FileDescriptor file = server::ask_for_file(importer.get(), "there.mtl");
    ASSERT_TRUE(file);
    EXPECT_TRUE(::fcntl(file.get(), F_GETFD) & FD_CLOEXEC);
    char text[16]{};
    EXPECT_EQ(::pread(file.get(), text, sizeof text, 0), 8);
    EXPECT_FALSE(server::ask_for_file(importer.get(), "gone.mtl"));
    EXPECT_FALSE(server::ask_for_file(importer.get(), ""));
    EXPECT_FALSE(server::ask_for_file(importer.get(), std::string(server::kLongestFileName + 1, 'x')));
    importer.reset();
    server_side.join();
    EXPECT_EQ(asked, "gone.mtl"); // what cannot be a name is not even asked for
}

TEST(FileDesk, AnswersNonsenseLikeANameThatIsNotThere)
{
    auto [service, importer] = server::make_desk();
    const int desk = service.get();
    std::string asked;
    std::thread server_side([desk, &asked] { serve(desk, asked); });
    const std::string overlong(5000, 'x');
    ASSERT_EQ(::send(importer.get(), overlong.data(), overlong.size(), 0), 5000);
    char answer = 0;
    EXPECT_EQ(::recv(importer.get(), &answer, 1, 0), 1);
    EXPECT_EQ(answer, 'n');
    importer.reset();
    server_side.join();
    EXPECT_EQ(asked, "");
}

TEST(FileDesk, TakesAClosedDeskAsNoFile)
{
    auto [service, importer] = server::make_desk();
    service.reset();
    EXPECT_FALSE(server::ask_for_file(importer.get(), "there.mtl"));
}

} // namespace
