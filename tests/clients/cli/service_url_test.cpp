#include "clients/cli/service_url.h"
#include "clients/cli/user_error.h"

#include <gtest/gtest.h>

namespace {

using clients::parse_service_url;

TEST(ServiceUrl, IsOriginAndPrefix)
{
    EXPECT_EQ(parse_service_url("http://127.0.0.1:8080").origin, "http://127.0.0.1:8080");
    EXPECT_EQ(parse_service_url("http://127.0.0.1:8080").prefix, "");
    EXPECT_EQ(parse_service_url("http://127.0.0.1:8080/").prefix, "");
    EXPECT_EQ(parse_service_url("https://render.example/farm/one/").origin, "https://render.example");
    EXPECT_EQ(parse_service_url("https://render.example/farm/one/").prefix, "/farm/one");
    EXPECT_EQ(parse_service_url("localhost:9000").origin, "http://localhost:9000");
    EXPECT_EQ(parse_service_url("http://[::1]:80").origin, "http://[::1]:80");
}

TEST(ServiceUrl, RefusesWhatIsNone)
{
    for (const char* url : {"",
                            "http://",
                            "ftp://host",
                            "http://host:0",
                            "http://host:70000",
                            "http://host:80x",
                            "http://host:",
                            "http://user@host",
                            "http://host/?q",
                            "http://host/#f",
                            "http://ho st",
                            "http://[::1",
                            "http://::1"})
        EXPECT_THROW(parse_service_url(url), clients::UserError) << url;
}

TEST(PercentEncoding, LeavesOnlyUnreservedCharacters)
{
    EXPECT_EQ(clients::percent_encoded("aZ0-._~"), "aZ0-._~");
    EXPECT_EQ(clients::percent_encoded("a b/c?d=\xc3\xa9"), "a%20b%2Fc%3Fd%3D%C3%A9");
}

} // namespace
