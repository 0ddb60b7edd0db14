#include "server/http/guard/answer_outbox.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <stdexcept>
#include <string>
#include <sys/socket.h>
#include <unistd.h>
#include <vector>

namespace {

using server::AnswerOutbox;
using Sent = AnswerOutbox::Sent;

constexpr std::size_t kAll = ~std::size_t{0} >> 1;

class Outbox : public testing::Test {
protected:
    void SetUp() override { ASSERT_EQ(socketpair(AF_UNIX, SOCK_STREAM, 0, ends.data()), 0); }
    void TearDown() override
    {
        close(ends[0]);
        close(ends[1]);
    }
    std::string read_what_is_there() const
    {
        std::string text;
        std::array<char, 65536> bytes{};
        ssize_t count = 0;
        while ((count = recv(ends[1], bytes.data(), bytes.size(), MSG_DONTWAIT)) > 0)
            text.append(bytes.data(), static_cast<std::size_t>(count));
        return text;
    }
    // A body of `size` bytes that tells at which offsets it was asked for.
    httplib::ContentProvider provider()
    {
        return [this](std::size_t offset, std::size_t length, httplib::DataSink& sink) {
            if (length == 0) ++let_go;
            if (length == 0) return true;
            offsets.push_back(offset);
            return sink.write(body.data() + offset, std::min<std::size_t>(length, 10000));
        };
    }

    std::array<int, 2> ends{};
    std::string body;
    std::vector<std::size_t> offsets;
    int let_go = 0;
    AnswerOutbox outbox;
};

TEST_F(Outbox, SendsWhatWasPutAndThenTheBody)
{
    body = std::string(25000, 'b');
    outbox.put("head ");
    outbox.put("and more ");
    outbox.follow_with(provider(), body.size());
    EXPECT_EQ(outbox.send(ends[0], kAll), Sent::done);
    EXPECT_EQ(read_what_is_there(), "head and more " + body);
    EXPECT_EQ(outbox.bytes_sent(), 25014u);
    EXPECT_EQ(offsets, (std::vector<std::size_t>{0, 10000, 20000}));
}

TEST_F(Outbox, GoesOnWhereTheReaderLeftOffAndHoldsNothingOfTheBody)
{
    body.resize(5 << 20);
    for (std::size_t i = 0; i < body.size(); ++i)
        body[i] = static_cast<char>(i * 31 + i / 997);
    outbox.put("head");
    outbox.follow_with(provider(), body.size());
    std::string got;
    int times_blocked = 0;
    for (Sent sent = outbox.send(ends[0], kAll); sent != Sent::done; sent = outbox.send(ends[0], kAll)) {
        ASSERT_EQ(sent, Sent::blocked);
        ++times_blocked;
        EXPECT_EQ(outbox.held_bytes(), 0u);
        got += read_what_is_there();
    }
    got += read_what_is_there();
    EXPECT_EQ(got, "head" + body);
    EXPECT_GT(times_blocked, 3);
    EXPECT_EQ(let_go, times_blocked);
}

TEST_F(Outbox, GivesOthersTheirTurnAfterSoMuch)
{
    body = std::string(25000, 'b');
    outbox.follow_with(provider(), body.size());
    EXPECT_EQ(outbox.send(ends[0], 5000), Sent::more);
    EXPECT_EQ(read_what_is_there().size(), 10000u);
    EXPECT_EQ(outbox.send(ends[0], kAll), Sent::done);
}

TEST_F(Outbox, FailsWhenTheReaderHasGoneOrTheBodyBreaksOff)
{
    AnswerOutbox broken;
    broken.follow_with([](std::size_t, std::size_t, httplib::DataSink&) { return false; }, 10);
    EXPECT_EQ(broken.send(ends[0], kAll), Sent::failed);
    AnswerOutbox silent;
    silent.follow_with([](std::size_t, std::size_t, httplib::DataSink&) { return true; }, 10);
    EXPECT_EQ(silent.send(ends[0], kAll), Sent::failed);
    AnswerOutbox throws;
    throws.follow_with(
        [](std::size_t, std::size_t, httplib::DataSink&) -> bool { throw std::runtime_error("damaged"); },
        10);
    EXPECT_THROW(throws.send(ends[0], kAll), std::runtime_error);
    shutdown(ends[1], SHUT_RDWR);
    outbox.put("hello");
    EXPECT_EQ(outbox.send(ends[0], kAll), Sent::failed);
}

} // namespace
