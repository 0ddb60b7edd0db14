// Files that an importer must refuse, or read without harm: written into `folder` with manifest.tsv beside
// them.
//
// manifest.tsv one line a file: name, TAB, comma-separated fault codes of renderer::ImportFault any of which
// is right ("ok" among them: it may also import, without what it reached for), TAB, what is wrong with it.
#pragma once

#include <filesystem>

namespace tests {

void write_broken_files(const std::filesystem::path& folder);

} // namespace tests
