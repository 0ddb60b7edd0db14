#include "clients/cli/digest.h"

#include <gtest/gtest.h>

namespace {

// FIPS 180-4's example "abc".
TEST(Digest, IsSha256)
{
    EXPECT_EQ(clients::digest_of("abc"),
              "sha256:ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
    EXPECT_EQ(clients::digest_of(""),
              "sha256:e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
    EXPECT_EQ(clients::repr_digest_of("abc"), "sha-256=:ungWv48Bz+pBQUDeXa4iI7ADYaOWF3qctBD/YfIAFa0=:");
}

} // namespace
