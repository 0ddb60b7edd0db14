#include "server/http/guard/body_places.h"
#include "server/http/guard/socket_address.h"

#include <gtest/gtest.h>

#include <utility>

namespace {

TEST(BodyPlaces, GivesEachClientItsOwnAndTakesThemBack)
{
    server::BodyPlaces places(2);
    auto first = places.enter("a");
    auto second = places.enter("a");
    ASSERT_TRUE(first && second);
    EXPECT_FALSE(places.enter("a"));
    EXPECT_TRUE(places.enter("b"));
    const auto kept = std::move(*second);
    second.reset(); // moved from: its place is kept
    EXPECT_FALSE(places.enter("a"));
    first.reset();
    EXPECT_TRUE(places.enter("a"));
}

TEST(SocketAddress, CountsANetworkOfVersion6AsOneClient)
{
    EXPECT_EQ(server::client_of("2001:db8:1:2::1"), server::client_of("2001:db8:1:2:ffff::9"));
    EXPECT_NE(server::client_of("2001:db8:1:2::1"), server::client_of("2001:db8:1:3::1"));
    EXPECT_NE(server::client_of("192.0.2.1"), server::client_of("192.0.2.2"));
    EXPECT_NE(server::client_of("::ffff:192.0.2.1"), server::client_of("::ffff:192.0.2.2"));
}

} // namespace
