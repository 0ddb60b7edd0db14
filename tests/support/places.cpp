#include "tests/support/places.h"

namespace tests {

std::string source_dir()
{
    return HELIOGRAPH_SOURCE_DIR;
}
std::string asset_dir()
{
    return HELIOGRAPH_ASSET_DIR;
}
std::string bin_dir()
{
    return HELIOGRAPH_BIN_DIR;
}

} // namespace tests
