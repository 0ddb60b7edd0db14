// Where the tests find the source tree, the assets made for them, and the programs.
//
// Functions of one source, so that the paths are compiled into that alone: a compiler cache then serves every
// other test, whatever folder the tree lies in.
#pragma once

#include <string>

namespace tests {

std::string source_dir();
std::string asset_dir(); // what heliograph-make-assets wrote
std::string bin_dir();

} // namespace tests
