// The examples of the contract as data: api/examples/{valid,invalid}, and the world that they are read in.
#pragma once

#include "api/job_request.h"
#include "tests/support/places.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

namespace test_api {

inline std::filesystem::path source_folder()
{
    return tests::source_dir();
}

inline std::string text_of_file(const std::filesystem::path& path)
{
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

// NAME of every NAME.json below api/examples/`kind`, in order.
inline std::vector<std::string> example_names(const std::string& kind)
{
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(source_folder() / "api/examples" / kind)) {
        const std::filesystem::path stem = entry.path().stem();
        if (entry.path().extension() == ".json" && stem.extension() != ".problems")
            names.push_back(stem.string());
    }
    std::sort(names.begin(), names.end());
    return names;
}

inline std::string example_text(const std::string& kind, const std::string& name)
{
    return text_of_file(source_folder() / "api/examples" / kind / (name + ".json"));
}

// As api/examples/README.md says: two parts came along, every digest is uploaded but that of 64 zeros.
inline api::ReadContext example_context()
{
    api::ReadContext context;
    context.files = {{"bunny.obj", "sha256:" + std::string(64, 'd')},
                     {"knot.glb", "sha256:" + std::string(64, 'e')}};
    context.has_asset = [](std::string_view digest) { return digest != "sha256:" + std::string(64, '0'); };
    return context;
}

inline std::string faults_as_text(const api::ProblemDetails& problem)
{
    std::string text;
    for (const api::Problem& fault : problem.errors)
        text += fault.pointer + " " + fault.code + ": " + fault.detail + "\n";
    return text;
}

} // namespace test_api
